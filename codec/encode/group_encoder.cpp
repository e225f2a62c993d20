// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/group_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "geometry/rigid_fit.h"

namespace sac {
namespace {

// How far a rigid motion may stay from the best fit, in steps. What it leaves takes a constant harmonic of every
// component.
constexpr double kLoosestRigid = 120, kLoosestRigidOfParts = 30;

std::int32_t Rounded(double value) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0 * kMaxCoefficient, 1.0 * kMaxCoefficient)));
}

// The residual that makes `wanted` from zero at level 0, when there is one.
bool ExactResidual(const PlaneValues& wanted, PlaneValues& residual) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] % kCoefficientsPerStep != 0) return false;
    residual[i] = wanted[i] / kCoefficientsPerStep;
    if (std::abs(residual[i]) > kMaxResidual) return false;
  }
  return true;
}

}  // namespace

GroupEncoder::GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error)
    : shape_(shape), header_(header), frame_encoder_(shape, header, max_error) {}

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

RigidMotion GroupEncoder::ChooseRigid(const RigidTarget& target, const FrameSlot& slot, const GroupInProgress& group) {
  RigidMotion chosen;
  for (std::size_t i = 0; i < 6; ++i) {
    std::int64_t sum = 0;
    for (const std::uint32_t r : slot.references) sum += group.rigid[group.structure[r].display][i];
    const std::int64_t prediction = slot.references.size() == 2 ? (sum + 1) >> 1 : sum;
    const bool near = std::abs(target.value[i] - static_cast<double>(prediction)) <= target.slack;
    chosen[i] = near ? static_cast<std::int32_t>(prediction) : Rounded(target.value[i]);
  }
  return chosen;
}

Status GroupEncoder::Encode(std::vector<PositionMatrix> frames, const std::vector<FrameSlot>& structure,
                            const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded) {
  GroupInProgress group = NewGroup();
  group.frames = std::move(frames);
  group.structure = structure;
  // 1. By time, because rotations are unwrapped in time: rigid motions, then, against the one reference shape, motion.
  std::vector<RigidTarget> targets;
  for (const PositionMatrix& positions : group.frames) targets.push_back(FitTarget(positions));
  group.rigid.resize(group.frames.size());
  for (const FrameSlot& slot : structure) group.rigid[slot.display] = ChooseRigid(targets[slot.display], slot, group);
  std::vector<Eigen::MatrixXd> motion(group.frames.size());
  failed_frame_ = failed_vertex_ = 0;
  frame_encoder_.StartGroup();
  if (frame_encoder_.UsesKeyReference()) {
    for (std::size_t t = 0; t < motion.size(); ++t) {
      motion[t] = frame_encoder_.MeasureMotion(group.frames[t], group.rigid[t]);
    }
  }

  // 2. In coding order.
  for (const FrameSlot& slot : structure) {
    SAC_RETURN_IF_ERROR(EncodeFrame(group, std::move(motion[slot.display]), coded.emplace_back()));
    SAC_RETURN_IF_ERROR(frame_done(group.coded()));
  }
  KeepLast(group);
  return Status::Ok();
}

Status GroupEncoder::EncodeNext(PositionMatrix positions, std::uint32_t index, FrameSyntax& frame) {
  failed_frame_ = index;
  failed_vertex_ = 0;
  if (index == 0) {
    chain_ = NewGroup();
    frame_encoder_.StartGroup();
  }
  GroupInProgress& group = *chain_;
  group.structure.push_back(ChainSlot(index));
  group.rigid.push_back(ChooseRigid(FitTarget(positions), group.structure.back(), group));
  group.frames.push_back(std::move(positions));
  Eigen::MatrixXd motion;
  if (frame_encoder_.UsesKeyReference()) {
    motion = frame_encoder_.MeasureMotion(group.frames.back(), group.rigid.back());
  }
  SAC_RETURN_IF_ERROR(EncodeFrame(group, std::move(motion), frame));
  KeepLast(group);
  return Status::Ok();
}

void GroupEncoder::KeepLast(const GroupInProgress& group) {
  last_positions_ = group.frames.back();
  // From behind: in a chain it is the last one coded.
  std::size_t i = group.structure.size() - 1;
  while (group.structure[i].display + 1 != group.frames.size()) --i;
  last_ = group.predictor.frames()[i];
}

Status GroupEncoder::EncodeFrame(GroupInProgress& group, Eigen::MatrixXd motion, FrameSyntax& frame) {
  const FrameSlot& slot = group.structure[group.coded()];
  const PositionMatrix& positions = group.frames[slot.display];
  frame = {slot, {}, EmptyPlanes(shape_.layouts)};
  const RigidMotion& rigid = group.rigid[slot.display];
  const auto fail = [&](Status status) {
    return Fail(std::move(status), slot.display, frame_encoder_.FarthestVertex(positions, rigid));
  };
  if (Status status = frame_encoder_.StartFrame(slot.references.empty()); !status.ok()) return fail(std::move(status));
  const bool repeats = RepeatFrame(group, frame);
  if (!repeats) {
    if (!frame_encoder_.UsesKeyReference()) motion = frame_encoder_.MeasureMotion(positions, rigid);
    FrameDraft draft{positions, rigid, std::move(motion), std::move(frame)};
    Status status = frame_encoder_.Choose(group.predictor, draft);
    if (!status.ok()) return Fail(std::move(status), slot.display, draft.failed_vertex);
    frame = std::move(draft.syntax);
  }
  if (!group.predictor.Add(frame)) return fail(MotionTooFar());
  // The next frame may be measured against this one.
  if (repeats && !frame_encoder_.UsesKeyReference()) frame_encoder_.Show(group.predictor.frames().back());
  return Status::Ok();
}

Status GroupEncoder::Fail(Status status, std::uint32_t frame, std::uint32_t vertex) {
  failed_frame_ = frame;
  failed_vertex_ = vertex;
  return status;
}

bool GroupEncoder::RepeatLastGroup(const PositionMatrix& positions, FrameSyntax& frame) const {
  if (!frame_encoder_.UsesKeyReference() || last_positions_.rows() == 0 || positions != last_positions_) return false;
  frame.rigid = last_.rigid;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    if (!ExactResidual(last_.planes[p], frame.planes[p])) return false;
  }
  return true;
}

bool GroupEncoder::RepeatFrame(const GroupInProgress& group, FrameSyntax& frame) const {
  const PositionMatrix& positions = group.frames[frame.slot.display];
  if (group.coded() == 0) return RepeatLastGroup(positions, frame);
  if (!frame_encoder_.UsesKeyReference()) return positions == group.frames[frame.slot.display - 1];
  for (std::uint32_t i = 0; i < group.coded(); ++i) {
    if (positions != group.frames[group.structure[i].display]) continue;
    const FrameCoefficients& wanted = group.predictor.frames()[i];
    if (!ExactResidual(wanted.planes[kCorrection], frame.planes[kCorrection])) return false;
    // The structure's own references will do if they predict the same.
    FrameCoefficients prediction = group.predictor.Predict(frame.slot);
    prediction.planes[kCorrection] = wanted.planes[kCorrection];
    if (prediction.rigid != wanted.rigid || prediction.planes != wanted.planes) frame.slot.references = {i};
    return true;
  }
  return false;
}

}  // namespace sac
