#include "codec/encode/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cmath>

#include "codec/encode/quantizer.h"
#include "codec/encode/rigid_fit.h"

namespace sac {
namespace {

double kSlack = getenv("SLACK") ? atof(getenv("SLACK")) : 0.5;

// About how many bits the residuals of a plane cost.
double EstimatedBits(std::span<const std::int32_t> residual) {
  double bits = 0;
  for (const std::int32_t v : residual) bits += 2 * std::bit_width(static_cast<std::uint32_t>(std::abs(v)));
  return bits;
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
      predictor_(static_cast<ReferenceShape>(header.reference_shape), shape.order.size()),
      reconstructor_(shape, header),
      last_(shape.order.size()) {}

void FrameEncoder::StartGroup() {
  predictor_.StartGroup();
  starts_group_ = true;
}

void FrameEncoder::ChooseRigid(const PositionMatrix& positions, const FrameCoefficients& prediction,
                               FrameSyntax& frame) {
  const RigidFit fit = FitRigid(shape_.positions, positions, shape_.centre);
  last_rotation_ = UnwrappedLog(fit.rotation, last_rotation_);
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = i < 3 ? last_rotation_[static_cast<Eigen::Index>(i)] / static_cast<double>(header_.rotation_step)
                               : fit.translation[static_cast<Eigen::Index>(i - 3)] /
                                     static_cast<double>(header_.translation_step);
    const double residual = value - prediction.rigid[i];
    frame.rigid[i] = std::abs(residual) <= kSlack ? 0 : static_cast<std::int32_t>(std::lround(residual));
  }
}

void FrameEncoder::ChooseMotion(const PositionMatrix& aligned, FrameSyntax& frame) {
  const Eigen::MatrixXd target = projection_.ProjectTriangles(fields_.Measure(reconstructor_.reference(), aligned));
  QuantizePlane(target, header_.motion_step, predictor_.Predict(frame.intra).motion, frame.motion);
}

bool FrameEncoder::Encode(const PositionMatrix& positions, FrameSyntax& frame) {
  const std::size_t harmonics = shape_.order.size();
  frame.intra = starts_group_;
  frame.motion.assign(harmonics * kMotionChannels, 0);
  frame.displacement.assign(harmonics * kDisplacementChannels, 0);
  const FrameCoefficients prediction = predictor_.Predict(frame.intra);
  const bool stands_still = !frame.intra && positions == last_positions_;
  if (!(frame.intra ? reconstructor_.StartIntra() : reconstructor_.StartPredicted())) return false;

  if (stands_still) {  // repeats the last frame exactly
    for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] = last_.rigid[i] - prediction.rigid[i];
  } else {
    ChooseRigid(positions, prediction, frame);
  }
  FrameCoefficients coefficients = prediction;
  for (std::size_t i = 0; i < 6; ++i) coefficients.rigid[i] += frame.rigid[i];
  const PositionMatrix aligned = reconstructor_.RemoveRigid(positions, coefficients.rigid);
  if (!stands_still) {
    ChooseMotion(aligned, frame);
    for (std::size_t i = 0; i < frame.motion.size(); ++i) coefficients.motion[i] += frame.motion[i];
  }
  const PositionMatrix& after_motion = reconstructor_.ReconstructMotion(coefficients.motion);
  if (!stands_still) {
    const Eigen::MatrixXd target = projection_.ProjectVertices(aligned - after_motion);
    QuantizePlane(target, header_.displacement_step, prediction.displacement, frame.displacement);
  }
  last_positions_ = positions;
  starts_group_ = false;
  if (!predictor_.Add(frame, last_)) return false;
  reconstructor_.AddDisplacement(last_.displacement);
  return true;
}

}  // namespace sac
