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

PositionMatrix ToMatrix(const Positions& positions) {
  PositionMatrix matrix(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)) = static_cast<double>(positions[v][a]);
    }
  }
  return matrix;
}

// The index of the first of the equal frames that `frames` end with; their number when the last one is alone.
std::uint32_t FirstOfLast(const std::vector<Positions>& frames) {
  std::size_t first = frames.size() - 1;
  while (first > 0 && frames[first - 1] == frames.back()) --first;
  return static_cast<std::uint32_t>(first + 1 == frames.size() ? frames.size() : first);
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

GroupEncoder::GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error,
                           const Projection& projection)
    : shape_(shape), header_(header), frame_encoder_(shape, header, max_error, projection) {}

GroupInProgress GroupEncoder::NewGroup() {
  last_rotation_.setZero();
  frame_encoder_.StartGroup();
  return {{}, {}, {}, Predictor(header_, shape_.layouts)};
}

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

void GroupEncoder::ChooseRigidMotions(GroupInProgress& group) {
  // By time, because rotations are unwrapped in time.
  std::vector<RigidTarget> targets;
  for (const Positions& frame : group.frames) targets.push_back(FitTarget(ToMatrix(frame)));
  group.rigid.resize(group.frames.size());
  RigidMotion of_hold;
  if (group.hold < group.frames.size()) {
    last_rotation_.setZero();
    of_hold = ChooseRigid(FitTarget(ToMatrix(group.frames[group.hold])), {group.hold, 0, {}}, group);
  }
  for (const FrameSlot& slot : group.structure) {
    group.rigid[slot.display] = slot.display < group.hold ? ChooseRigid(targets[slot.display], slot, group) : of_hold;
  }
}

Status GroupEncoder::Encode(std::vector<Positions> frames, const std::vector<FrameSlot>& structure, bool goes_on,
                            const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded) {
  failed_frame_ = failed_vertex_ = 0;
  last_positions_.clear();
  GroupInProgress group = NewGroup();
  group.frames = std::move(frames);
  group.structure = structure;
  const bool key = frame_encoder_.UsesKeyReference();
  // Where all frames stand still, they do as the key frame does.
  if (const std::uint32_t hold = FirstOfLast(group.frames); key && goes_on && hold > 0) group.hold = hold;
  ChooseRigidMotions(group);
  // Motion against the one reference shape, by time as well.
  std::vector<Eigen::MatrixXd> motion(group.frames.size());
  for (std::size_t t = 0; key && t < std::min<std::size_t>(group.hold, motion.size()); ++t) {
    motion[t] = frame_encoder_.MeasureMotion(ToMatrix(group.frames[t]), group.rigid[t]);
  }
  for (const FrameSlot& slot : structure) {
    SAC_RETURN_IF_ERROR(EncodeFrame(group, std::move(motion[slot.display]), coded.emplace_back()));
    SAC_RETURN_IF_ERROR(frame_done(group.coded()));
  }
  return Status::Ok();
}

Status GroupEncoder::EncodeNext(Positions positions, std::uint32_t index, FrameSyntax& frame) {
  failed_frame_ = index;
  failed_vertex_ = 0;
  if (index == 0) chain_ = NewGroup();
  GroupInProgress& group = *chain_;
  group.structure.push_back(ChainSlot(index));
  const PositionMatrix matrix = ToMatrix(positions);
  group.rigid.push_back(ChooseRigid(FitTarget(matrix), group.structure.back(), group));
  group.frames.push_back(std::move(positions));
  Eigen::MatrixXd motion;
  if (frame_encoder_.UsesKeyReference()) motion = frame_encoder_.MeasureMotion(matrix, group.rigid.back());
  SAC_RETURN_IF_ERROR(EncodeFrame(group, std::move(motion), frame));
  last_positions_ = group.frames.back();
  last_ = group.predictor.frames().back();
  return Status::Ok();
}

Status GroupEncoder::EncodeFrame(GroupInProgress& group, Eigen::MatrixXd motion, FrameSyntax& frame) {
  const FrameSlot& slot = group.structure[group.coded()];
  const PositionMatrix positions = ToMatrix(group.frames[slot.display]);
  frame = {slot, {}, EmptyPlanes(shape_.layouts)};
  const RigidMotion& rigid = group.rigid[slot.display];
  const auto fail = [&](Status status) {
    return Fail(std::move(status), slot.display, frame_encoder_.FarthestVertex(positions, rigid));
  };
  if (Status status = frame_encoder_.StartFrame(slot.references.empty()); !status.ok()) return fail(std::move(status));
  const bool repeats = RepeatFrame(group, frame);
  if (!repeats) {
    const bool begins_hold = slot.display >= group.hold;
    if (begins_hold) {  // what the key frame of the next group will be
      frame_encoder_.StartGroup();
      frame.slot.references = {};
    }
    if (begins_hold || !frame_encoder_.UsesKeyReference()) motion = frame_encoder_.MeasureMotion(positions, rigid);
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

bool GroupEncoder::RepeatLastChain(const Positions& positions, FrameSyntax& frame) const {
  if (!frame_encoder_.UsesKeyReference() || last_positions_.empty() || positions != last_positions_) return false;
  frame.rigid = last_.rigid;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    if (!ExactResidual(last_.planes[p], frame.planes[p])) return false;
  }
  return true;
}

bool GroupEncoder::RepeatFrame(const GroupInProgress& group, FrameSyntax& frame) const {
  const Positions& positions = group.frames[frame.slot.display];
  if (group.coded() == 0) return RepeatLastChain(positions, frame);
  if (!frame_encoder_.UsesKeyReference()) return positions == group.frames[frame.slot.display - 1];
  for (std::uint32_t i = 0; i < group.coded(); ++i) {
    const std::uint32_t shown = group.structure[i].display;
    // A hold is as a key frame: it repeats itself or the group's own key frame, nothing else.
    if (frame.slot.display >= group.hold && shown > 0 && shown < group.hold) continue;
    if (positions != group.frames[shown]) continue;
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
