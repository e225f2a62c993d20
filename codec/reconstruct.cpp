// SPDX-License-Identifier: Apache-2.0
#include "codec/reconstruct.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "geometry/deformation.h"

namespace sac {
namespace {

// When the magnitudes fall below this share of the largest ones since the last reset, the running sum holds mostly
// rounding errors and is computed anew.
constexpr double kRoundingShare = 1.0 / (1 << 16);

constexpr std::array kHarmonicPlanes = {kMotion, kDisplacement, kDetail};

const HarmonicBasis& BasisOf(const Shape& shape, Plane plane) {
  return plane == kDetail ? shape.patch_basis : shape.basis;
}

}  // namespace

void ToPositions(const PositionMatrix& matrix, Positions& positions) {
  positions.resize(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      positions[v][a] = static_cast<float>(matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)));
    }
  }
}

Eigen::VectorXd PlaneUnits(const Shape& shape, const SequenceHeader& header, Plane plane) {
  const HarmonicBasis& basis = BasisOf(shape, plane);
  Eigen::ArrayXd counts(static_cast<Eigen::Index>(basis.order.size()));
  for (std::size_t i = 0; i < basis.order.size(); ++i) {
    counts[static_cast<Eigen::Index>(i)] = basis.components[basis.order[i].component].component.count;
  }
  const Eigen::ArrayXd share = static_cast<double>(shape.vertices()) / counts;
  if (plane == kMotion) return static_cast<double>(header.motion_step) / kCoefficientsPerStep * share.sqrt().sqrt();
  if (plane == kDisplacement)
    return static_cast<double>(header.displacement_step) / kCoefficientsPerStep * share.sqrt();
  return static_cast<double>(header.detail_step) / kCoefficientsPerStep / counts.sqrt();
}

PlaneField::PlaneField(const HarmonicBasis& basis, const PlaneLayout& layout, Eigen::VectorXd units)
    : basis_(basis), units_(std::move(units)), held_(layout.size()) {
  Eigen::Index vertices = 0;
  for (const ComponentHarmonics& c : basis.components) vertices += c.vectors.rows();
  values_.setZero(vertices, static_cast<Eigen::Index>(layout.channels));
}

void PlaneField::Reset() {
  std::fill(held_.begin(), held_.end(), 0);
  values_.setZero();
  largest_ = 0;
}

const Eigen::MatrixXd& PlaneField::Update(const PlaneValues& coefficients) {
  const Eigen::Map<const Eigen::Matrix<std::int32_t, -1, -1, Eigen::RowMajor>> rows(coefficients.data(), units_.size(),
                                                                                    values_.cols());
  const double size = units_.dot(rows.cast<double>().cwiseAbs().rowwise().sum());
  if (size < kRoundingShare * largest_) Reset();
  largest_ = std::max(largest_, size);
  std::size_t i = 0;
  Eigen::Index row = 0;
  for (const HarmonicIndex& index : basis_.order) {
    const ComponentHarmonics& c = basis_.components[index.component];
    const double unit = units_[row++];
    for (Eigen::Index channel = 0; channel < values_.cols(); ++channel, ++i) {
      const std::int32_t change = coefficients[i] - held_[i];
      if (change == 0) continue;
      held_[i] = coefficients[i];
      values_.col(channel).segment(c.component.first, c.component.count) += (change * unit) * c.vectors.col(index.k);
    }
  }
  return values_;
}

Reconstructor::Reconstructor(const Shape& shape, const SequenceHeader& header)
    : shape_(shape),
      header_(header),
      correction_unit_(static_cast<double>(header.correction_step) / kCoefficientsPerStep),
      poisson_(shape.edges, shape.components, shape.masses),
      gradients_(shape.vertices()) {
  for (const Plane p : kHarmonicPlanes) {
    fields_.emplace_back(BasisOf(shape, p), shape.layouts[p], PlaneUnits(shape, header, p));
  }
}

bool Reconstructor::StartGroup() {
  for (PlaneField& field : fields_) field.Reset();
  return UseKeyReference();
}

bool Reconstructor::StartFrame(bool intra) {
  if (intra || !header_.references_previous()) return UseKeyReference();
  reference_is_key_ = false;
  return poisson_.SetReference(aligned_, CotangentWeights(aligned_, shape_.triangles, shape_.edges));
}

bool Reconstructor::UseKeyReference() {
  if (!reference_is_key_) reference_is_key_ = poisson_.SetReference(shape_.positions, shape_.weights);
  return reference_is_key_;
}

const PositionMatrix& Reconstructor::ReconstructMotion(const PlaneValues& motion) {
  const Eigen::MatrixXd& fields = fields_[kMotion].Update(motion);
  if (std::all_of(motion.begin(), motion.end(), [](std::int32_t c) { return c == 0; })) {
    aligned_ = reference();  // exact, so that a shape without motion does not drift
    return aligned_;
  }
  for (Eigen::Index v = 0; v < fields.rows(); ++v) {
    double channels[9];
    for (int c = 0; c < 9; ++c) channels[c] = fields(v, c);
    gradients_[static_cast<std::size_t>(v)] = DeformationGradient(channels);
  }
  aligned_ = poisson_.Solve(gradients_);
  return aligned_;
}

const PositionMatrix& Reconstructor::Add(Plane plane, const PlaneValues& values) {
  if (values.empty()) return aligned_;
  if (plane != kCorrection) {
    aligned_ += fields_[plane].Update(values);
    return aligned_;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != 0) {
      aligned_(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) += values[i] * correction_unit_;
    }
  }
  return aligned_;
}

RigidTransform Reconstructor::TransformOf(const RigidMotion& rigid) const {
  const auto rotation = rigid.rotation(), translation = rigid.translation();
  return {
      RotationOf(Eigen::Vector3d(rotation[0], rotation[1], rotation[2]) * static_cast<double>(header_.rotation_step)),
      shape_.centre + Eigen::RowVector3d(translation[0], translation[1], translation[2]) *
                          static_cast<double>(header_.translation_step)};
}

RigidTransform Reconstructor::TransformBetween(const RigidMotion& from, const RigidMotion& to, double t) const {
  const RigidTransform a = TransformOf(from), b = TransformOf(to);
  return {Eigen::Quaterniond(a.rotation).slerp(t, Eigen::Quaterniond(b.rotation)).toRotationMatrix(),
          (1 - t) * a.translation + t * b.translation};
}

void Reconstructor::Transform(const PositionMatrix& aligned, const RigidTransform& transform,
                              PositionMatrix& moved) const {
  moved.resize(aligned.rows(), 3);
  const auto x = aligned.col(0).array() - shape_.centre[0];
  const auto y = aligned.col(1).array() - shape_.centre[1];
  const auto z = aligned.col(2).array() - shape_.centre[2];
  // The product is written out, because Eigen's product of matrices allocates.
  for (Eigen::Index a = 0; a < 3; ++a) {
    const auto row = transform.rotation.row(a);
    moved.col(a).array() = (x * row[0] + y * row[1] + z * row[2]) + transform.translation[a];
  }
}

PositionMatrix Reconstructor::ApplyRigid(const PositionMatrix& aligned, const RigidMotion& rigid) const {
  PositionMatrix moved;
  Transform(aligned, TransformOf(rigid), moved);
  return moved;
}

PositionMatrix Reconstructor::RemoveRigid(const PositionMatrix& positions, const RigidMotion& rigid) const {
  const RigidTransform transform = TransformOf(rigid);
  PositionMatrix aligned = (positions.rowwise() - transform.translation) * transform.rotation;
  aligned.rowwise() += shape_.centre;
  return aligned;
}

const PositionMatrix& Reconstructor::Reconstruct(const FramePlanes& planes, const RigidTransform& transform) {
  ReconstructMotion(planes[kMotion]);
  for (const Plane p : {kDisplacement, kDetail, kCorrection}) Add(p, planes[p]);
  Transform(aligned_, transform, moved_);
  return moved_;
}

}  // namespace sac
