#include "codec/reconstruct.h"

#include <algorithm>
#include <utility>

#include "codec/deformation.h"

namespace sac {
namespace {

// The vertices of the mesh over those of the component, for each harmonic.
Eigen::ArrayXd ComponentShare(const Shape& shape) {
  Eigen::ArrayXd share(static_cast<Eigen::Index>(shape.order.size()));
  for (std::size_t i = 0; i < shape.order.size(); ++i) {
    share[static_cast<Eigen::Index>(i)] =
        static_cast<double>(shape.vertices()) / shape.components[shape.order[i].component].count;
  }
  return share;
}

}  // namespace

Eigen::VectorXd MotionSteps(const Shape& shape, const SequenceHeader& header) {
  return static_cast<double>(header.motion_step) / kCoefficientsPerStep * ComponentShare(shape).sqrt().sqrt();
}

Eigen::VectorXd DisplacementSteps(const Shape& shape, const SequenceHeader& header) {
  return static_cast<double>(header.displacement_step) / kCoefficientsPerStep * ComponentShare(shape).sqrt();
}

PlaneField::PlaneField(const Shape& shape, int channels, Eigen::VectorXd steps)
    : shape_(shape),
      steps_(std::move(steps)),
      held_(shape.order.size() * static_cast<std::size_t>(channels)),
      values_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(shape.vertices()), channels)) {}

void PlaneField::Reset() {
  std::fill(held_.begin(), held_.end(), 0);
  values_.setZero();
}

const Eigen::MatrixXd& PlaneField::Update(std::span<const std::int32_t> coefficients) {
  const Eigen::Index channels = values_.cols();
  std::size_t i = 0;
  Eigen::Index row = 0;
  for (const HarmonicIndex& index : shape_.order) {
    const double step = steps_[row++];
    const ComponentHarmonics& c = shape_.basis.components[index.component];
    for (Eigen::Index channel = 0; channel < channels; ++channel, ++i) {
      const std::int32_t change = coefficients[i] - held_[i];
      if (change == 0) continue;
      held_[i] = coefficients[i];
      values_.col(channel).segment(c.component.first, c.component.count) += (change * step) * c.vectors.col(index.k);
    }
  }
  return values_;
}

Reconstructor::Reconstructor(const Shape& shape, const SequenceHeader& header)
    : shape_(shape),
      header_(header),
      motion_(shape, kMotionChannels, MotionSteps(shape, header)),
      displacement_(shape, kDisplacementChannels, DisplacementSteps(shape, header)),
      poisson_(shape),
      gradients_(shape.vertices()) {}

bool Reconstructor::StartGroup() {
  motion_.Reset();
  displacement_.Reset();
  return UseKeyReference();
}

bool Reconstructor::StartFrame(bool intra) {
  if (intra || header_.reference_shape == static_cast<std::uint8_t>(ReferenceShape::kKey)) return UseKeyReference();
  reference_is_key_ = false;
  return poisson_.SetReference(aligned_, CotangentWeights(aligned_, shape_.triangles, shape_.edges));
}

bool Reconstructor::UseKeyReference() {
  if (std::exchange(reference_is_key_, true)) return true;
  return poisson_.SetReference(shape_.positions, shape_.weights);
}

const PositionMatrix& Reconstructor::ReconstructMotion(std::span<const std::int32_t> motion) {
  const Eigen::MatrixXd& fields = motion_.Update(motion);
  if (std::all_of(motion.begin(), motion.end(), [](std::int32_t c) { return c == 0; })) {
    moved_ = reference();  // exactly, so that what stands still does
    return moved_;
  }
  for (Eigen::Index v = 0; v < fields.rows(); ++v) {
    double channels[kMotionChannels];
    for (int c = 0; c < kMotionChannels; ++c) channels[c] = fields(v, c);
    gradients_[static_cast<std::size_t>(v)] = DeformationGradient(channels);
  }
  moved_ = poisson_.Solve(gradients_);
  return moved_;
}

const PositionMatrix& Reconstructor::AddDisplacement(std::span<const std::int32_t> displacement) {
  aligned_ = moved_ + displacement_.Update(displacement);
  return aligned_;
}

Eigen::Matrix3d Reconstructor::Rotation(const std::array<std::int32_t, 6>& rigid) const {
  return RotationOf(Eigen::Vector3d(rigid[0], rigid[1], rigid[2]) * static_cast<double>(header_.rotation_step));
}

Eigen::RowVector3d Reconstructor::Translation(const std::array<std::int32_t, 6>& rigid) const {
  return shape_.centre +
         Eigen::RowVector3d(rigid[3], rigid[4], rigid[5]) * static_cast<double>(header_.translation_step);
}

PositionMatrix Reconstructor::ApplyRigid(const PositionMatrix& aligned,
                                         const std::array<std::int32_t, 6>& rigid) const {
  const Eigen::Matrix3d transposed = Rotation(rigid).transpose();  // positions are rows
  PositionMatrix moved = (aligned.rowwise() - shape_.centre) * transposed;
  moved.rowwise() += Translation(rigid);
  return moved;
}

PositionMatrix Reconstructor::RemoveRigid(const PositionMatrix& positions,
                                          const std::array<std::int32_t, 6>& rigid) const {
  PositionMatrix aligned = (positions.rowwise() - Translation(rigid)) * Rotation(rigid);
  aligned.rowwise() += shape_.centre;
  return aligned;
}

PositionMatrix Reconstructor::Reconstruct(const FrameCoefficients& frame) {
  ReconstructMotion(frame.motion);
  return ApplyRigid(AddDisplacement(frame.displacement), frame.rigid);
}

}  // namespace sac
