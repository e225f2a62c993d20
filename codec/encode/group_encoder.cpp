#include "codec/encode/group_encoder.h"

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
double EstimatedBits(const std::vector<std::int32_t>& residual) {
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

// The residual that makes `wanted` from zero at level 0, when there is one.
bool ExactResidual(const std::vector<std::int32_t>& wanted, std::vector<std::int32_t>& residual) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] % kCoefficientsPerStep != 0) return false;
    residual[i] = wanted[i] / kCoefficientsPerStep;
  }
  return true;
}

}  // namespace

GroupEncoder::GroupEncoder(const Shape& shape, const SequenceHeader& header)
    : shape_(shape),
      header_(header),
      fields_(shape.triangles),
      projection_(shape, ReferenceAreas(fields_, shape.positions)),
      motion_units_(MotionSteps(shape, header)),
      displacement_units_(DisplacementSteps(shape, header)),
      reconstructor_(shape, header),
      last_(shape.order.size()) {}

GroupEncoder::RigidTarget GroupEncoder::FitTarget(const PositionMatrix& positions) {
  const RigidFit fit = FitRigid(shape_.positions, positions, shape_.centre);
  last_rotation_ = UnwrappedLog(fit.rotation, last_rotation_);
  RigidTarget target;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    target.value[i] = last_rotation_[axis] / static_cast<double>(header_.rotation_step);
    target.value[i + 3] = fit.translation[axis] / static_cast<double>(header_.translation_step);
  }
  // What the rigid motion leaves, the planes' constant harmonics correct at no extra cost if they are busy anyway: so
  // it follows loosely, except where there is nothing but rigid motion.
  target.slack = std::clamp(0.3 * fit.residual / static_cast<double>(header_.displacement_step), 0.5, kLoosestRigid);
  return target;
}

Eigen::MatrixXd GroupEncoder::MeasureMotion(const PositionMatrix& aligned) {
  return projection_.ProjectTriangles(fields_.Measure(reconstructor_.reference(), aligned));
}

bool GroupEncoder::Encode(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                          std::vector<FrameSyntax>& coded) {
  // 1. By time, because rotations are unwrapped in time: rigid motions, then, against the one reference shape, fields.
  std::vector<RigidTarget> rigid_targets;
  for (const PositionMatrix& positions : frames) rigid_targets.push_back(FitTarget(positions));
  std::vector<std::array<std::int32_t, 6>> rigid(frames.size());
  for (const FrameSlot& slot : structure) {
    for (std::size_t i = 0; i < 6; ++i) {
      std::int64_t sum = 0;
      for (const std::uint32_t r : slot.references) sum += rigid[structure[r].display][i];
      const auto prediction = slot.references.size() == 2 ? (sum + 1) >> 1 : sum;
      const RigidTarget& target = rigid_targets[slot.display];
      const bool near = std::abs(target.value[i] - static_cast<double>(prediction)) <= target.slack;
      rigid[slot.display][i] = near ? static_cast<std::int32_t>(prediction) : Rounded(target.value[i]);
    }
  }
  std::vector<Eigen::MatrixXd> motion_targets(frames.size());
  if (!reconstructor_.StartGroup()) return false;
  if (UsesKeyReference()) {
    for (std::size_t t = 0; t < frames.size(); ++t) {
      motion_targets[t] = MeasureMotion(reconstructor_.RemoveRigid(frames[t], rigid[t]));
    }
  }

  // 2. In coding order: predict, quantize, and ask the decoder's reconstruction what is left for the next plane.
  Predictor predictor(header_, shape_.order.size());
  for (const FrameSlot& slot : structure) {
    const PositionMatrix& positions = frames[slot.display];
    FrameSyntax& frame = coded.emplace_back();
    frame.slot = slot;
    if (!RepeatFrame(frames, structure, predictor, frame)) {
      if (!reconstructor_.StartFrame(slot.references.empty())) return false;
      const PositionMatrix aligned = reconstructor_.RemoveRigid(positions, rigid[slot.display]);
      if (!UsesKeyReference()) motion_targets[slot.display] = MeasureMotion(aligned);
      ChoosePlanes(aligned, motion_targets[slot.display], predictor, frame);
      const FrameCoefficients prediction = predictor.Predict(frame.slot.references);
      for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] = rigid[slot.display][i] - prediction.rigid[i];
    }
    if (!predictor.Add(frame)) return false;
    if (!UsesKeyReference()) {  // the next frame is measured against this one
      if (!reconstructor_.StartFrame(frame.intra())) return false;
      reconstructor_.Reconstruct(predictor.frames().back());
    }
  }
  last_positions_ = frames.back();
  for (std::size_t i = 0; i < structure.size(); ++i) {
    if (structure[i].display + 1 == frames.size()) last_ = predictor.frames()[i];
  }
  return true;
}

bool GroupEncoder::RepeatFrame(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                               const Predictor& predictor, FrameSyntax& frame) const {
  const auto index = static_cast<std::uint32_t>(predictor.frames().size());
  const PositionMatrix& positions = frames[frame.slot.display];
  frame.motion.assign(last_.motion.size(), 0);
  frame.displacement.assign(last_.displacement.size(), 0);
  if (index == 0) {  // what the last group ended with, coded from zero
    if (!UsesKeyReference() || positions != last_positions_) return false;
    frame.rigid = last_.rigid;
    return ExactResidual(last_.motion, frame.motion) && ExactResidual(last_.displacement, frame.displacement);
  }
  for (std::uint32_t i = UsesKeyReference() ? 0 : index - 1; i < index; ++i) {
    if (positions != frames[structure[i].display]) continue;
    // The structure's own references will do if they predict the same.
    const FrameCoefficients prediction = predictor.Predict(frame.slot.references);
    const FrameCoefficients& wanted = predictor.frames()[i];
    if (prediction.rigid != wanted.rigid || prediction.motion != wanted.motion ||
        prediction.displacement != wanted.displacement) {
      frame.slot.references = {i};
    }
    return true;
  }
  return false;
}

void GroupEncoder::ChoosePlanes(const PositionMatrix& aligned, const Eigen::MatrixXd& motion_target,
                                const Predictor& predictor, FrameSyntax& frame) {
  const std::int32_t step = LevelStep(header_, frame.slot.level);
  FrameCoefficients coefficients = predictor.Predict(frame.slot.references);
  QuantizePlane(motion_target, motion_units_, step, coefficients.motion, frame.motion);
  if (UsesKeyReference() && !frame.intra()) {  // a cut costs less from zero
    const FrameCoefficients zero(shape_.order.size());
    std::vector<std::int32_t> residual(frame.motion.size());
    QuantizePlane(motion_target, motion_units_, step, zero.motion, residual);
    if (EstimatedBits(residual) < EstimatedBits(frame.motion)) {
      frame.slot.references.clear();
      frame.motion = residual;
      coefficients = zero;
    }
  }
  for (std::size_t i = 0; i < frame.motion.size(); ++i) coefficients.motion[i] += frame.motion[i] * step;
  const PositionMatrix& moved = reconstructor_.ReconstructMotion(coefficients.motion);
  QuantizePlane(projection_.ProjectVertices(aligned - moved), displacement_units_, step, coefficients.displacement,
                frame.displacement);
}

}  // namespace sac
