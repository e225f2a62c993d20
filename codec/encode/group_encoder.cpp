// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/group_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>
#include <utility>

#include "codec/encode/error_bound.h"
#include "codec/encode/quantizer.h"
#include "codec/encode/reference_search.h"
#include "geometry/rigid_fit.h"

namespace sac {
namespace {

// How far a rigid motion may stay from the best fit, in steps. What it leaves costs every component a constant
// harmonic.
constexpr double kLoosestRigid = 120, kLoosestRigidOfParts = 30;

// References are tried when their motion costs at most so much of what it costs from the structure's.
constexpr double kWorthTrying = 1.3;
constexpr double kExplicitBits = 30;

// About how many bits a residual costs, and those of a plane.
double EstimatedBits(std::int32_t residual) {
  return residual == 0 ? 0 : 4 + 2 * std::bit_width(static_cast<std::uint32_t>(std::abs(residual)));
}
double EstimatedBits(const PlaneValues& residual) {
  double bits = 0;
  for (const std::int32_t v : residual) bits += EstimatedBits(v);
  return bits;
}

std::int32_t Rounded(double value) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0 * kMaxCoefficient, 1.0 * kMaxCoefficient)));
}

Eigen::VectorXd ReferenceAreas(TriangleFields& fields, const PositionMatrix& positions) {
  fields.Measure(positions, positions);
  return fields.areas();
}

// Whether a residual is as large as the format allows: then it says less than it should.
bool IsSaturated(const PlaneValues& values) {
  return std::any_of(values.begin(), values.end(), [](std::int32_t v) { return std::abs(v) >= kMaxResidual; });
}

Status TooFar() { return Status::InvalidArgument("the motion is too far from the first frame for these steps"); }

// The residual that makes `wanted` from zero at level 0, when there is one.
bool ExactResidual(const PlaneValues& wanted, PlaneValues& residual) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] % kCoefficientsPerStep != 0) return false;
    residual[i] = wanted[i] / kCoefficientsPerStep;
    if (std::abs(residual[i]) > kMaxResidual) return false;
  }
  return true;
}

// Corrects each vertex of which the decoded float is farther off than `max_error`, to within half a step along each
// axis. `left`: what the other planes leave, before the rigid motion; `error`: the same after it.
void CorrectOverBound(const PositionMatrix& left, const PositionMatrix& exact, const PositionMatrix& error, double step,
                      double max_error, PlaneValues& correction) {
  for (Eigen::Index v = 0; v < left.rows(); ++v) {
    if (DistanceAfterRounding(exact.row(v), error.row(v)) <= max_error) continue;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double steps = std::clamp(std::round(left(v, a) / step), -1.0 * kMaxResidual, 1.0 * kMaxResidual);
      correction[static_cast<std::size_t>(3 * v + a)] = static_cast<std::int32_t>(steps);
    }
  }
}

}  // namespace

GroupEncoder::GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error)
    : shape_(shape),
      header_(header),
      fields_(shape.triangles),
      projection_(shape, ReferenceAreas(fields_, shape.positions)),
      units_{PlaneUnits(shape, header, kMotion), PlaneUnits(shape, header, kDisplacement),
             PlaneUnits(shape, header, kDetail)},
      max_error_(max_error),
      reconstructor_(shape, header) {}

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
  const double residual = fit.residual / static_cast<double>(header_.displacement_step);
  target.slack = shape_.components.size() == 1 ? std::clamp(residual, 0.5, kLoosestRigid)
                                               : std::clamp(0.3 * residual, 0.5, kLoosestRigidOfParts);
  return target;
}

Eigen::MatrixXd GroupEncoder::MeasureMotion(const PositionMatrix& aligned) {
  return projection_.ProjectTriangles(fields_.Measure(reconstructor_.reference(), aligned));
}

std::vector<RigidMotion> GroupEncoder::ChooseRigid(const std::vector<PositionMatrix>& frames,
                                                   const std::vector<FrameSlot>& structure) {
  std::vector<RigidTarget> targets;
  for (const PositionMatrix& positions : frames) targets.push_back(FitTarget(positions));
  std::vector<RigidMotion> rigid(frames.size());
  for (const FrameSlot& slot : structure) {
    rigid[slot.display] = ChooseRigid(targets[slot.display], slot, structure, rigid);
  }
  return rigid;
}

RigidMotion GroupEncoder::ChooseRigid(const RigidTarget& target, const FrameSlot& slot,
                                      const std::vector<FrameSlot>& structure, const std::vector<RigidMotion>& rigid) {
  RigidMotion chosen;
  for (std::size_t i = 0; i < 6; ++i) {
    std::int64_t sum = 0;
    for (const std::uint32_t r : slot.references) sum += rigid[structure[r].display][i];
    const std::int64_t prediction = slot.references.size() == 2 ? (sum + 1) >> 1 : sum;
    const bool near = std::abs(target.value[i] - static_cast<double>(prediction)) <= target.slack;
    chosen[i] = near ? static_cast<std::int32_t>(prediction) : Rounded(target.value[i]);
  }
  return chosen;
}

Status GroupEncoder::Encode(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                            const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded) {
  // 1. By time, because rotations are unwrapped in time: rigid motions, then, against the one reference shape, fields.
  const std::vector<RigidMotion> rigid = ChooseRigid(frames, structure);
  std::vector<Eigen::MatrixXd> motion_targets(frames.size());
  if (!reconstructor_.StartGroup()) return TooFar();
  if (UsesKeyReference()) {
    for (std::size_t t = 0; t < frames.size(); ++t) {
      motion_targets[t] = MeasureMotion(reconstructor_.RemoveRigid(frames[t], rigid[t]));
    }
  }

  // 2. In coding order.
  Predictor predictor(header_, shape_.layouts);
  for (const FrameSlot& slot : structure) {
    SAC_RETURN_IF_ERROR(EncodeSlot(frames, structure, rigid[slot.display], std::move(motion_targets[slot.display]),
                                   predictor, coded.emplace_back()));
    SAC_RETURN_IF_ERROR(frame_done(static_cast<std::uint32_t>(coded.size())));
  }
  last_positions_ = frames.back();
  for (std::size_t i = 0; i < structure.size(); ++i) {
    if (structure[i].display + 1 == frames.size()) last_ = predictor.frames()[i];
  }
  return Status::Ok();
}

Status GroupEncoder::EncodeNext(PositionMatrix positions, std::uint32_t index, FrameSyntax& frame) {
  if (index == 0) {
    chain_.emplace(Chain{{}, {}, {}, Predictor(header_, shape_.layouts)});
    if (!reconstructor_.StartGroup()) return TooFar();
  }
  Chain& chain = *chain_;
  const FrameSlot& slot = chain.structure.emplace_back(ChainSlot(index));
  const RigidMotion rigid = ChooseRigid(FitTarget(positions), slot, chain.structure, chain.rigid);
  chain.rigid.push_back(rigid);
  chain.frames.push_back(std::move(positions));
  Eigen::MatrixXd motion_target;
  if (UsesKeyReference()) motion_target = MeasureMotion(reconstructor_.RemoveRigid(chain.frames.back(), rigid));
  SAC_RETURN_IF_ERROR(
      EncodeSlot(chain.frames, chain.structure, rigid, std::move(motion_target), chain.predictor, frame));
  last_positions_ = chain.frames.back();
  last_ = chain.predictor.frames().back();
  return Status::Ok();
}

Status GroupEncoder::EncodeSlot(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                                const RigidMotion& rigid, Eigen::MatrixXd motion_target, Predictor& predictor,
                                FrameSyntax& frame) {
  // Predict, quantize, and ask the decoder's reconstruction what is left for the next plane.
  const FrameSlot& slot = structure[predictor.frames().size()];
  const PositionMatrix& positions = frames[slot.display];
  frame.slot = slot;
  frame.planes = EmptyPlanes(shape_.layouts);
  if (!reconstructor_.StartFrame(slot.references.empty())) return TooFar();
  const bool repeats = RepeatFrame(frames, structure, predictor, frame);
  if (!repeats) {
    if (!UsesKeyReference()) motion_target = MeasureMotion(reconstructor_.RemoveRigid(positions, rigid));
    SAC_RETURN_IF_ERROR(ChoosePlanes(positions, rigid, motion_target, predictor, frame));
    const FrameCoefficients prediction = predictor.Predict(frame.slot);
    for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] = rigid[i] - prediction.rigid[i];
  }
  if (!predictor.Add(frame)) return TooFar();
  // The next frame may be measured against this one.
  if (repeats && !UsesKeyReference()) reconstructor_.Reconstruct(predictor.frames().back());
  return Status::Ok();
}

bool GroupEncoder::RepeatFrame(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                               const Predictor& predictor, FrameSyntax& frame) const {
  const auto index = static_cast<std::uint32_t>(predictor.frames().size());
  const PositionMatrix& positions = frames[frame.slot.display];
  if (index == 0) {  // what the last group ended with, coded from zero
    if (!UsesKeyReference() || last_positions_.rows() == 0 || positions != last_positions_) return false;
    frame.rigid = last_.rigid;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      if (!ExactResidual(last_.planes[p], frame.planes[p])) return false;
    }
    return true;
  }
  if (!UsesKeyReference()) return positions == frames[frame.slot.display - 1];
  for (std::uint32_t i = 0; i < index; ++i) {
    if (positions != frames[structure[i].display]) continue;
    const FrameCoefficients& wanted = predictor.frames()[i];
    if (!ExactResidual(wanted.planes[kCorrection], frame.planes[kCorrection])) return false;
    // The structure's own references will do if they predict the same.
    FrameCoefficients prediction = predictor.Predict(frame.slot);
    prediction.planes[kCorrection] = wanted.planes[kCorrection];
    if (prediction.rigid != wanted.rigid || prediction.planes != wanted.planes) frame.slot.references = {i};
    return true;
  }
  return false;
}

void GroupEncoder::Quantize(Plane plane, const Eigen::MatrixXd& target, FrameCoefficients& coefficients,
                            FrameSyntax& frame) const {
  const std::int32_t step = LevelStep(header_, plane, frame.slot.level);
  QuantizePlane(target, units_[plane], step, plane == kMotion ? kMotionDeadZone : kDisplacementDeadZone,
                coefficients.planes[plane], frame.planes[plane]);
  for (std::size_t i = 0; i < frame.planes[plane].size(); ++i) {
    coefficients.planes[plane][i] += frame.planes[plane][i] * step;
  }
}

double GroupEncoder::ChooseMotion(const RigidMotion& rigid, const Eigen::MatrixXd& motion_target,
                                  const Predictor& predictor, FrameSyntax& frame,
                                  FrameCoefficients& coefficients) const {
  coefficients = predictor.Predict(frame.slot);
  double bits = 0;
  for (std::size_t i = 0; i < 6; ++i) bits += EstimatedBits(rigid[i] - coefficients.rigid[i]);
  Quantize(kMotion, motion_target, coefficients, frame);
  return bits + EstimatedBits(frame.planes[kMotion]);
}

PositionMatrix GroupEncoder::ChooseReferences(const PositionMatrix& aligned, const RigidMotion& rigid,
                                              const Eigen::MatrixXd& motion_target, const Predictor& predictor,
                                              FrameSyntax& frame, FrameCoefficients& coefficients) {
  PositionMatrix left;
  const auto displace = [&] {
    left = aligned - reconstructor_.ReconstructMotion(coefficients.planes[kMotion]);
    Quantize(kDisplacement, projection_.ProjectVertices(left), coefficients, frame);
    left = aligned - reconstructor_.Add(kDisplacement, coefficients.planes[kDisplacement]);
    return EstimatedBits(frame.planes[kDisplacement]);
  };
  const auto motion_bits = [&](const References& references) {
    frame.slot.references = references;
    return ChooseMotion(rigid, motion_target, predictor, frame, coefficients);
  };
  const auto whole_bits = [&](const References& references) {
    const double bits = motion_bits(references);
    return bits + displace();
  };
  const References own = frame.slot.references;
  if (!UsesKeyReference() || own.empty()) {
    whole_bits(own);
    return left;
  }
  const double most = kWorthTrying * motion_bits(own);
  const std::vector<References> likely =
      LikelyReferences(static_cast<std::uint32_t>(predictor.frames().size()), motion_bits, most);
  References best = own;
  double least = whole_bits(own);
  for (const References& references : likely) {
    const double bits = whole_bits(references) + kExplicitBits;
    if (bits >= least) continue;
    least = bits;
    best = references;
  }
  if (frame.slot.references != best) whole_bits(best);
  return left;
}

Status GroupEncoder::ChoosePlanes(const PositionMatrix& positions, const RigidMotion& rigid,
                                  const Eigen::MatrixXd& motion_target, const Predictor& predictor,
                                  FrameSyntax& frame) {
  const PositionMatrix aligned = reconstructor_.RemoveRigid(positions, rigid);
  FrameCoefficients coefficients;
  PositionMatrix left = ChooseReferences(aligned, rigid, motion_target, predictor, frame, coefficients);
  if (header_.detail_step > 0) {
    Quantize(kDetail, projection_.ProjectPatches(left), coefficients, frame);
    left = aligned - reconstructor_.Add(kDetail, coefficients.planes[kDetail]);
  }
  if (header_.correction_step == 0) {
    return std::any_of(frame.planes.begin(), frame.planes.end(), IsSaturated) ? TooFar() : Status::Ok();
  }
  // Planes before it may be saturated: the correction alone has to hold the bound.
  const auto error = [&]() -> PositionMatrix { return reconstructor_.ApplyRigid(aligned - left, rigid) - positions; };
  CorrectOverBound(left, positions, error(), header_.correction_step, max_error_, frame.planes[kCorrection]);
  for (std::size_t i = 0; i < frame.planes[kCorrection].size(); ++i) {
    coefficients.planes[kCorrection][i] = frame.planes[kCorrection][i] * kCoefficientsPerStep;
  }
  left = aligned - reconstructor_.Add(kCorrection, coefficients.planes[kCorrection]);
  return CheckBound(positions, error());
}

Status GroupEncoder::CheckBound(const PositionMatrix& exact, const PositionMatrix& error) const {
  double most = 0;
  for (Eigen::Index v = 0; v < exact.rows(); ++v) {
    most = std::max(most, DistanceAfterRounding(exact.row(v), error.row(v)));
  }
  if (most <= max_error_) return Status::Ok();
  std::ostringstream message;
  message << "a vertex stays " << most << " from where it should be, more than the largest error allowed, "
          << max_error_ << "; the smallest possible here is " << std::setprecision(3) << 1.05 * most;
  return Status::InvalidArgument(message.str());
}

}  // namespace sac
