// SPDX-License-Identifier: Apache-2.0
#include "codec/reconstruct.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>

#include "geometry/deformation.h"

namespace sac {
namespace {

// When the magnitudes fall below this share of the largest ones since the last reset, the running sum holds mostly
// rounding errors and is computed anew.
constexpr double kRoundingShare = 1.0 / (1 << 16);

const HarmonicBasis& BasisOf(const Shape& shape, Plane plane) {
  return plane == kDetail ? shape.patch_basis : shape.basis;
}

using Parts = std::vector<PlaneField::Part>;

Parts AtHandles(const Shape& shape) {
  Parts parts;
  const Handles& handles = shape.blend.handles();
  for (std::size_t c = 0; c < shape.components.size(); ++c) {
    parts.push_back({static_cast<Eigen::Index>(handles.components[c].first), shape.AtHandles(c)});
  }
  return parts;
}

Parts InFunctions(const HarmonicBasis& basis) {
  Parts parts;
  for (const ComponentHarmonics& c : basis.components)
    parts.push_back({static_cast<Eigen::Index>(c.functions.first), c.vectors});
  return parts;
}

// The factor of the steps in the component that holds `vertex`.
double FactorAt(const Shape& shape, std::uint32_t vertex) {
  if (shape.factors.empty()) return 1;
  const auto after = std::upper_bound(shape.components.begin(), shape.components.end(), vertex,
                                      [](std::uint32_t v, const Component& c) { return v < c.first; });
  return shape.factors[static_cast<std::size_t>(after - shape.components.begin()) - 1];
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
  const auto rows = static_cast<Eigen::Index>(basis.order.size());
  Eigen::ArrayXd counts(rows), factors(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Component& part = basis.components[basis.order[static_cast<std::size_t>(i)].component].component;
    counts[i] = part.count;
    factors[i] = FactorAt(shape, part.first);
  }
  const Eigen::ArrayXd share = static_cast<double>(shape.vertices()) / counts;
  if (plane == kMotion) return static_cast<double>(header.motion_step) / kCoefficientsPerStep * share.sqrt().sqrt();
  if (plane == kDisplacement)
    return static_cast<double>(header.displacement_step) / kCoefficientsPerStep * share.sqrt() * factors;
  return static_cast<double>(header.detail_step) / kCoefficientsPerStep / counts.sqrt() * factors;
}

PlaneField::PlaneField(std::vector<Part> parts, std::span<const HarmonicIndex> order, std::size_t channels,
                       Eigen::VectorXd units)
    : parts_(std::move(parts)), order_(order), units_(std::move(units)), held_(order.size() * channels) {
  Eigen::Index rows = 0;
  for (const Part& part : parts_) rows += part.vectors.rows();
  values_.setZero(rows, static_cast<Eigen::Index>(channels));
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
  for (const HarmonicIndex& index : order_) {
    const Part& part = parts_[index.component];
    const double unit = units_[row++];
    for (Eigen::Index channel = 0; channel < values_.cols(); ++channel, ++i) {
      const std::int32_t change = coefficients[i] - held_[i];
      if (change == 0) continue;
      held_[i] = coefficients[i];
      values_.col(channel).segment(part.first, part.vectors.rows()) += (change * unit) * part.vectors.col(index.k);
    }
  }
  return values_;
}

Reconstructor::Reconstructor(const Shape& shape, const SequenceHeader& header)
    : shape_(shape),
      header_(header),
      motion_(AtHandles(shape), shape.basis.order, shape.layouts[kMotion].channels, PlaneUnits(shape, header, kMotion)),
      displacement_(InFunctions(shape.basis), shape.basis.order, shape.layouts[kDisplacement].channels,
                    PlaneUnits(shape, header, kDisplacement)),
      detail_(InFunctions(shape.patch_basis), shape.patch_basis.order, shape.layouts[kDetail].channels,
              PlaneUnits(shape, header, kDetail)),
      correction_unit_(static_cast<double>(header.correction_step) / kCoefficientsPerStep),
      gradients_(shape.blend.handles().vertices.size()) {}

void Reconstructor::StartGroup() {
  for (PlaneField* field : {&motion_, &displacement_, &detail_}) field->Reset();
  previous_ = false;
}

bool Reconstructor::StartFrame(bool intra) {
  previous_ = header_.references_previous() && !intra;
  if (!previous_) return true;
  const std::vector<double> weights = CotangentWeights(aligned_, shape_.triangles, shape_.edges);
  const auto set_reference = [&](BlendSystem& system) {
    system.SetReference(shape_.blend, shape_.graph, Product(weights, shape_.unevenness), shape_.masses, aligned_);
  };
  if (of_previous_) {
    set_reference(*of_previous_);
  } else {
    auto system = std::make_unique<BlendSystem>();
    set_reference(*system);
    if (!system->Analyze()) return false;
    of_previous_ = std::move(system);  // only now, so that nothing is kept of what memory was too short for
  }
  return of_previous_->Factorize();
}

void Reconstructor::BlendMotion(const PlaneValues& motion) {
  const BlendSystem& system = previous_ ? *of_previous_ : *shape_.system;
  const Eigen::MatrixXd& fields = motion_.Update(motion);
  if (std::all_of(motion.begin(), motion.end(), [](std::int32_t c) { return c == 0; })) {
    system.Rest(blend_);  // exact, so that a shape without motion does not drift
    return;
  }
  for (Eigen::Index h = 0; h < fields.rows(); ++h) {
    double channels[9];
    for (int c = 0; c < 9; ++c) channels[c] = fields(h, c);
    gradients_[static_cast<std::size_t>(h)] = DeformationGradient(channels);
  }
  system.Solve(gradients_, scratch_, blend_);
}

void Reconstructor::BlendDisplacement(const PlaneValues& displacement) { blend_ += displacement_.Update(displacement); }

void Reconstructor::PlaceBlend(const RigidTransform* transform) {
  about_origin_ = blend_;
  shape_.blend.MoveToOrigin(about_origin_);
  if (transform) {
    const Eigen::RowVector3d shift = transform->translation - shape_.centre * transform->rotation.transpose();
    for (Eigen::Index i = 0; i < about_origin_.rows(); ++i) {
      const Eigen::RowVector3d row = about_origin_.row(i);
      about_origin_.row(i) = row * transform->rotation.transpose();
    }
    shape_.blend.Translate(shift, about_origin_);
  }
}

void Reconstructor::ApplyBlend(const RigidTransform* transform, PositionMatrix& positions) {
  PlaceBlend(transform);
  shape_.blend.Apply(about_origin_, positions);
}

const RowMatrix& Reconstructor::ReconstructBlend(const FramePlanes& planes, const RigidTransform& transform) {
  BlendMotion(planes[kMotion]);
  BlendDisplacement(planes[kDisplacement]);
  PlaceBlend(&transform);
  return about_origin_;
}

void Reconstructor::AddDetail(const PlaneValues& detail) {
  if (!detail.empty()) aligned_ += detail_.Update(detail);
}

void Reconstructor::AddCorrection(const PlaneValues& correction) {
  for (std::size_t i = 0; i < correction.size(); ++i) {
    if (correction[i] != 0) {
      aligned_(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) += correction[i] * correction_unit_;
    }
  }
}

const PositionMatrix& Reconstructor::ReconstructMotion(const PlaneValues& motion) {
  BlendMotion(motion);
  ApplyBlend(nullptr, aligned_);
  return aligned_;
}

const PositionMatrix& Reconstructor::Add(Plane plane, const PlaneValues& values) {
  if (plane == kDisplacement) {
    BlendDisplacement(values);
    ApplyBlend(nullptr, aligned_);
  } else if (plane == kDetail) {
    AddDetail(values);
  } else {
    AddCorrection(values);
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
  BlendMotion(planes[kMotion]);
  BlendDisplacement(planes[kDisplacement]);
  if (planes[kDetail].empty() && planes[kCorrection].empty() && !header_.references_previous()) {
    ApplyBlend(&transform, moved_);  // the rigid motion of the handles is that of all vertices
    return moved_;
  }
  ApplyBlend(nullptr, aligned_);
  AddDetail(planes[kDetail]);
  AddCorrection(planes[kCorrection]);
  Transform(aligned_, transform, moved_);
  return moved_;
}

}  // namespace sac
