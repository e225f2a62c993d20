// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "codec/encode/frame_encoder.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/frame_syntax.h"
#include "format/prediction.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A group while it is coded. With a chain of P-frames its frames come one after the other; else all are there before
// the first is coded.
struct GroupInProgress {
  std::vector<Positions> frames;     // by time, in decoded vertex order, model units
  std::vector<RigidMotion> rigid;    // by time
  std::vector<FrameSlot> structure;  // in coding order
  Predictor predictor;               // has the frames coded so far, in coding order
  // The first of the frames by time that are coded as if a group began with them (GroupEncoder::Encode).
  std::uint32_t hold = 0xffffffffu;

  // How many frames are coded.
  std::uint32_t coded() const { return static_cast<std::uint32_t>(predictor.frames().size()); }
};

// Chooses the syntax of one group after another.
class GroupEncoder {
 public:
  // `shape` and `projection` must outlive it. `max_error`, `projection`: as of FrameEncoder.
  GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error, const Projection& projection);

  // Codes a closed group, whose syntax depends on the arguments alone and not on groups before. `frames`: by time, in
  // decoded vertex order, model units. `structure`: of the same number of frames. Appends the frames in coding order.
  // kInvalidArgument when a value leaves the range of the format, a reference shape cannot be factorized or the bound
  // cannot be held.
  //
  // Another group may go on from the last frame when `goes_on`. Frames that stand still to the end of such a group are
  // then coded as a key frame is, so that they stand still across the border as well, whoever codes the next group.
  //
  // `frame_done` gets the number of frames of the group that are coded; its failure ends the encoding.
  Status Encode(std::vector<Positions> frames, const std::vector<FrameSlot>& structure, bool goes_on,
                const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded);

  // The same for a chain of P-frames whose next is not known yet. Index 0 begins a group; it repeats the last frame of
  // the chain before exactly where the input does. After an error the group cannot go on.
  Status EncodeNext(Positions positions, std::uint32_t index, FrameSyntax& frame);

  // After a failure of a frame: which of the group it is, by time, and the decoded vertex at fault.
  std::uint32_t failed_frame() const { return failed_frame_; }
  std::uint32_t failed_vertex() const { return failed_vertex_; }

 private:
  // A rigid motion before quantization: rotation vector and translation in the header's steps, and how far a choice may
  // stay from it.
  struct RigidTarget {
    std::array<double, 6> value;
    double slack;
  };
  // Forgets all frames before, and begins a group.
  GroupInProgress NewGroup();
  RigidTarget FitTarget(const PositionMatrix& positions);
  // Chooses the rigid motion of a frame, given those that come before it in coding order: near enough to the target and
  // easy to predict.
  static RigidMotion ChooseRigid(const RigidTarget& target, const FrameSlot& slot, const GroupInProgress& group);
  // Chooses the rigid motions of a closed group.
  void ChooseRigidMotions(GroupInProgress& group);
  // Chooses the syntax of the next frame in coding order and adds it to the predictor. `motion`: what MeasureMotion()
  // gives for it against M'0, where that is the reference shape.
  Status EncodeFrame(GroupInProgress& group, Eigen::MatrixXd motion, FrameSyntax& frame);
  // Makes the next frame repeat an earlier one exactly if its input does; false if it does not.
  bool RepeatFrame(const GroupInProgress& group, FrameSyntax& frame) const;
  // Makes the first frame of a chain repeat the last of the chain before, coded from zero; false likewise.
  bool RepeatLastChain(const Positions& positions, FrameSyntax& frame) const;
  // Keeps what failed_frame() and failed_vertex() tell.
  Status Fail(Status status, std::uint32_t frame, std::uint32_t vertex);

  const Shape& shape_;
  SequenceHeader header_;
  FrameEncoder frame_encoder_;
  std::optional<GroupInProgress> chain_;  // the group that EncodeNext() is in
  Eigen::Vector3d last_rotation_ = Eigen::Vector3d::Zero();
  Positions last_positions_;  // of the last frame of a chain
  FrameCoefficients last_;
  std::uint32_t failed_frame_ = 0, failed_vertex_ = 0;
};

}  // namespace sac
