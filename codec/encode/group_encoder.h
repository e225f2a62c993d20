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
#include "sac/status.h"

namespace sac {

// A group while it is coded. With a chain of P-frames its frames come one after the other; else all are there before
// the first is coded.
struct GroupInProgress {
  std::vector<PositionMatrix> frames;  // by time, in decoded vertex order, model units
  std::vector<RigidMotion> rigid;      // by time
  std::vector<FrameSlot> structure;    // in coding order
  Predictor predictor;                 // has the frames coded so far, in coding order

  // How many frames are coded.
  std::uint32_t coded() const { return static_cast<std::uint32_t>(predictor.frames().size()); }
};

// Chooses the syntax of one group after another.
class GroupEncoder {
 public:
  // `shape` must outlive it. `max_error`: as of FrameEncoder.
  GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error);

  // `frames`: by time, in decoded vertex order, model units. `structure`: of the same number of frames. Appends the
  // frames in coding order. kInvalidArgument when a value leaves the range of the format, a reference shape cannot be
  // factorized or the bound cannot be held.
  // `frame_done` gets the number of frames of the group that are coded; its failure ends the encoding.
  Status Encode(std::vector<PositionMatrix> frames, const std::vector<FrameSlot>& structure,
                const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded);

  // The same for a chain of P-frames whose next is not known yet. Index 0 begins a group. After an error the group
  // cannot go on.
  Status EncodeNext(PositionMatrix positions, std::uint32_t index, FrameSyntax& frame);

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
  GroupInProgress NewGroup() const { return {{}, {}, {}, Predictor(header_, shape_.layouts)}; }
  RigidTarget FitTarget(const PositionMatrix& positions);
  // Chooses the rigid motion of a frame, given those that come before it in coding order: near enough to the target and
  // easy to predict.
  static RigidMotion ChooseRigid(const RigidTarget& target, const FrameSlot& slot, const GroupInProgress& group);
  // Chooses the syntax of the next frame in coding order and adds it to the predictor. `motion`: what MeasureMotion()
  // gives for it against M'0, where that is the reference shape.
  Status EncodeFrame(GroupInProgress& group, Eigen::MatrixXd motion, FrameSyntax& frame);
  // Makes the next frame repeat an earlier one exactly if its input does; false if it does not.
  bool RepeatFrame(const GroupInProgress& group, FrameSyntax& frame) const;
  // Makes the first frame of a group repeat the last of the group before, coded from zero; false likewise.
  bool RepeatLastGroup(const PositionMatrix& positions, FrameSyntax& frame) const;
  // Keeps what failed_frame() and failed_vertex() tell.
  Status Fail(Status status, std::uint32_t frame, std::uint32_t vertex);
  // Keeps the last frame of a group, which the next may begin with.
  void KeepLast(const GroupInProgress& group);

  const Shape& shape_;
  SequenceHeader header_;
  FrameEncoder frame_encoder_;
  std::optional<GroupInProgress> chain_;  // the group that EncodeNext() is in
  Eigen::Vector3d last_rotation_ = Eigen::Vector3d::Zero();
  PositionMatrix last_positions_;  // of the last frame of the group before
  FrameCoefficients last_;
  std::uint32_t failed_frame_ = 0, failed_vertex_ = 0;
};

}  // namespace sac
