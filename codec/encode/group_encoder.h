// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "codec/encode/projection.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/frame_syntax.h"
#include "format/prediction.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"
#include "geometry/triangle_fields.h"
#include "sac/status.h"

namespace sac {

// Chooses the syntax of one group after another, asking the decoder's own Reconstructor what it gives.
class GroupEncoder {
 public:
  // `shape` must outlive it.
  // `max_error`: how far any vertex may be from where it should be once positions are floats, model units; of no
  // meaning without a correction plane.
  GroupEncoder(const Shape& shape, const SequenceHeader& header, double max_error);

  // `frames`: by time, in decoded vertex order, model units. `structure`: of the same number of frames. Appends the
  // frames in coding order. kInvalidArgument when a value leaves the range of the format, a reference shape cannot be
  // factorized or the bound cannot be held.
  // `frame_done` gets the number of frames of the group that are coded; its failure ends the encoding.
  Status Encode(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                const std::function<Status(std::uint32_t)>& frame_done, std::vector<FrameSyntax>& coded);

  // The same for a chain of P-frames whose next is not known yet. Index 0 begins a group. After an error the group
  // cannot go on.
  Status EncodeNext(PositionMatrix positions, std::uint32_t index, FrameSyntax& frame);

 private:
  // A rigid motion before quantization: rotation vector and translation in the header's steps, and how far a choice may
  // stay from it.
  struct RigidTarget {
    std::array<double, 6> value;
    double slack;
  };
  RigidTarget FitTarget(const PositionMatrix& positions);
  // The rigid motion of each frame, by time, near enough to the best and easy to predict.
  std::vector<RigidMotion> ChooseRigid(const std::vector<PositionMatrix>& frames,
                                       const std::vector<FrameSlot>& structure);
  // The motion plane's coefficients of `aligned` against the present reference shape, in real numbers.
  Eigen::MatrixXd MeasureMotion(const PositionMatrix& aligned);
  // The rigid motion of one frame, given those by time that come before it in coding order.
  static RigidMotion ChooseRigid(const RigidTarget& target, const FrameSlot& slot,
                                 const std::vector<FrameSlot>& structure, const std::vector<RigidMotion>& rigid);
  // Chooses the syntax of the frame at the end of `predictor` and adds it there. `motion_target` is measured here
  // unless there is one reference shape.
  Status EncodeSlot(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                    const RigidMotion& rigid, Eigen::MatrixXd motion_target, Predictor& predictor, FrameSyntax& frame);
  // Makes `frame` repeat an earlier one exactly if its input does; false if it does not.
  bool RepeatFrame(const std::vector<PositionMatrix>& frames, const std::vector<FrameSlot>& structure,
                   const Predictor& predictor, FrameSyntax& frame) const;
  // Quantizes what `target` is beyond the prediction in `coefficients`, and adds it there.
  void Quantize(Plane plane, const Eigen::MatrixXd& target, FrameCoefficients& coefficients, FrameSyntax& frame) const;
  // From the references of `frame`: its motion plane, and about how many bits it costs with the rigid motion.
  // `coefficients`: the prediction, with the motion plane that results.
  double ChooseMotion(const RigidMotion& rigid, const Eigen::MatrixXd& motion_target, const Predictor& predictor,
                      FrameSyntax& frame, FrameCoefficients& coefficients) const;
  // Chooses references other than the structure's where they are cheaper, then motion and displacement. What these
  // leave of `aligned`.
  PositionMatrix ChooseReferences(const PositionMatrix& aligned, const RigidMotion& rigid,
                                  const Eigen::MatrixXd& motion_target, const Predictor& predictor, FrameSyntax& frame,
                                  FrameCoefficients& coefficients);
  // Chooses references and the planes' residuals.
  Status ChoosePlanes(const PositionMatrix& positions, const RigidMotion& rigid, const Eigen::MatrixXd& motion_target,
                      const Predictor& predictor, FrameSyntax& frame);
  // Whether exact + error, rounded to floats, is within the bound.
  Status CheckBound(const PositionMatrix& exact, const PositionMatrix& error) const;
  bool UsesKeyReference() const { return !header_.references_previous(); }

  const Shape& shape_;
  SequenceHeader header_;
  TriangleFields fields_;
  Projection projection_;
  std::array<Eigen::VectorXd, 3> units_;  // of the planes in harmonics
  double max_error_;
  Reconstructor reconstructor_;
  // The group that EncodeNext is in.
  struct Chain {
    std::vector<PositionMatrix> frames;
    std::vector<FrameSlot> structure;
    std::vector<RigidMotion> rigid;
    Predictor predictor;
  };
  std::optional<Chain> chain_;
  Eigen::Vector3d last_rotation_ = Eigen::Vector3d::Zero();
  // The last frame of the group before, to stand still across the border.
  PositionMatrix last_positions_;
  FrameCoefficients last_;
};

}  // namespace sac
