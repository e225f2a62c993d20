#include "codec/encode/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "codec/encode/quantizer.h"
#include "codec/encode/rigid_fit.h"

namespace sac {
namespace {

constexpr double kLoosestRigid = 30;  // steps

// About how many bits the residuals of a plane cost.
double EstimatedBits(std::span<const std::int32_t> residual) {
  double bits = 0;
  for (const std::int32_t v : residual) bits += 2 * std::bit_width(static_cast<std::uint32_t>(std::abs(v)));
  return bits;
}

std::int32_t Rounded(double value) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0 * kMaxCoefficient, 1.0 * kMaxCoefficient)));
}

Eigen::VectorXd ReferenceAreas(TriangleFields& fields, const PositionMatrix& positions) {
  fields.Measure(positions, positions);
  return fields.areas();
}

}  // namespace

FrameEncoder::FrameEncoder(const Shape& shape, const SequenceHeader& header)
    : shape_(shape),
      header_(header),
      fields_(shape.triangles),
      projection_(shape, ReferenceAreas(fields_, shape.positions)),
      motion_steps_(MotionSteps(shape, header)),
      displacement_steps_(DisplacementSteps(shape, header)),
      predictor_(static_cast<ReferenceShape>(header.reference_shape), shape.order.size()),
      reconstructor_(shape, header),
      last_(shape.order.size()) {}

void FrameEncoder::StartGroup() {
  predictor_.StartGroup();
  starts_group_ = true;
}

std::array<std::int32_t, 6> FrameEncoder::ChooseRigid(const PositionMatrix& positions,
                                                      const std::array<std::int32_t, 6>& prediction) {
  const RigidFit fit = FitRigid(shape_.positions, positions, shape_.centre);
  last_rotation_ = UnwrappedLog(fit.rotation, last_rotation_);
  // What the rigid motion leaves, the planes' constant harmonics correct at no extra cost if they are busy anyway: so
  // it follows loosely, except where there is nothing but rigid motion.
  const double slack =
      std::clamp(0.3 * fit.residual / static_cast<double>(header_.displacement_step), 0.5, kLoosestRigid);
  std::array<std::int32_t, 6> rigid = prediction;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    const double value = i < 3 ? last_rotation_[axis] / static_cast<double>(header_.rotation_step)
                               : fit.translation[axis] / static_cast<double>(header_.translation_step);
    if (std::abs(value - prediction[i]) > slack) rigid[i] = Rounded(value);
  }
  return rigid;
}

bool FrameEncoder::Encode(const PositionMatrix& positions, FrameSyntax& frame) {
  frame.intra = std::exchange(starts_group_, false);
  FrameCoefficients prediction = predictor_.Predict(frame.intra);
  frame.motion.assign(prediction.motion.size(), 0);
  frame.displacement.assign(prediction.displacement.size(), 0);
  if (!(frame.intra ? reconstructor_.StartIntra() : reconstructor_.StartPredicted())) return false;

  const bool stands_still = !frame.intra && positions == last_positions_;
  last_positions_ = positions;
  const std::array<std::int32_t, 6> rigid = stands_still ? last_.rigid : ChooseRigid(positions, prediction.rigid);
  const PositionMatrix aligned = reconstructor_.RemoveRigid(positions, rigid);
  if (!stands_still) {
    const Eigen::MatrixXd target = projection_.ProjectTriangles(fields_.Measure(reconstructor_.reference(), aligned));
    QuantizePlane(target, motion_steps_, prediction.motion, frame.motion);
    if (!frame.intra && BetterFromZero(target, frame.motion)) {  // a cut
      frame.intra = true;
      prediction = predictor_.Predict(true);
      QuantizePlane(target, motion_steps_, prediction.motion, frame.motion);
      if (!reconstructor_.StartIntra()) return false;
    }
  }
  for (std::size_t i = 0; i < frame.motion.size(); ++i) prediction.motion[i] += frame.motion[i];
  const PositionMatrix& moved = reconstructor_.ReconstructMotion(prediction.motion);
  if (!stands_still) {
    QuantizePlane(projection_.ProjectVertices(aligned - moved), displacement_steps_, prediction.displacement,
                  frame.displacement);
  }
  for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] = rigid[i] - prediction.rigid[i];
  if (!predictor_.Add(frame, last_)) return false;
  reconstructor_.AddDisplacement(last_.displacement);
  return true;
}

bool FrameEncoder::BetterFromZero(const Eigen::MatrixXd& target, std::span<const std::int32_t> predicted) const {
  if (header_.reference_shape != static_cast<std::uint8_t>(ReferenceShape::kKey)) return false;
  const std::vector<std::int32_t> zero(predicted.size(), 0);
  std::vector<std::int32_t> residual(predicted.size());
  QuantizePlane(target, motion_steps_, zero, residual);
  return EstimatedBits(residual) < EstimatedBits(predicted);
}

}  // namespace sac
