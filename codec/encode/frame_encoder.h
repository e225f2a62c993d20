// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

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

// A frame while its syntax is chosen.
struct FrameDraft {
  const PositionMatrix& positions;      // what it should be, in decoded vertex order, model units
  const RigidMotion rigid;              // its rigid motion, which is chosen already
  Eigen::MatrixXd motion;               // the motion plane's coefficients that would describe it, real numbers
  FrameSyntax syntax = {};              // its slot, and the residuals chosen so far
  FrameCoefficients coefficients = {};  // its prediction plus those residuals
  PositionMatrix aligned = {};          // `positions` before the rigid motion
  PositionMatrix remainder = {};        // `aligned` minus what the planes chosen so far give
  std::uint32_t failed_vertex = 0;      // after a failure: the decoded vertex that is at fault
};

// Chooses the residuals of one frame after another: each plane codes what a decoder's Reconstructor shows to be missing
// after the planes before it.
class FrameEncoder {
 public:
  // `shape` and `projection`, which is ProjectionOf() it, must outlive it. `max_error`: how far any vertex may be from
  // where it should be once positions are floats, model units; it has no meaning without a correction plane.
  FrameEncoder(const Shape& shape, const SequenceHeader& header, double max_error, const Projection& projection);

  // Forgets all frames before, also the last bits of their sums, so that what follows depends on nothing else.
  void StartGroup();
  // Begins a frame, which sets the shape that its motion is measured against. kInvalidArgument when its linear system
  // cannot be factorized.
  Status StartFrame(bool intra);
  // Tells the reconstruction of a frame that was not chosen by Choose().
  void Show(const FrameCoefficients& frame);

  // The motion plane's coefficients, real numbers, of a frame against the present reference shape. Where that is M'0,
  // frames are measured by time from StartGroup() on, since their rotations go on from each other.
  Eigen::MatrixXd MeasureMotion(const PositionMatrix& positions, const RigidMotion& rigid);

  // Chooses references and residuals. `draft.syntax` has a slot and planes of zeros; `predictor` has the frames coded
  // before. kInvalidArgument when a value leaves the range of the format or the bound cannot be held.
  Status Choose(const Predictor& predictor, FrameDraft& draft);

  // The vertex of a frame that is farthest from its place in the first frame, the rigid motion aside.
  std::uint32_t FarthestVertex(const PositionMatrix& positions, const RigidMotion& rigid) const;

  bool UsesKeyReference() const { return !header_.references_previous(); }

 private:
  // Quantizes what `target` has beyond the prediction, and adds it to the coefficients.
  void Quantize(Plane plane, const Eigen::MatrixXd& target, FrameDraft& draft) const;
  // Chooses the motion plane for the references of the draft. Returns about how many bits it takes with the rigid
  // motion.
  double ChooseMotion(const Predictor& predictor, FrameDraft& draft) const;
  // Chooses the displacement plane likewise.
  double ChooseDisplacement(FrameDraft& draft);
  // Chooses motion and displacement, and other references than the structure's where they take fewer bits.
  void ChooseReferences(const Predictor& predictor, FrameDraft& draft);
  void ChooseDetail(FrameDraft& draft);
  Status ChooseCorrection(FrameDraft& draft);
  // By how far each vertex of the draft would be shown from where it should be.
  PositionMatrix ErrorOf(const FrameDraft& draft) const;
  // Whether the draft, rounded to floats, is within the bound.
  Status CheckBound(FrameDraft& draft) const;

  const Shape& shape_;
  SequenceHeader header_;
  double max_error_;
  TriangleFields fields_;
  const Projection& projection_;
  std::array<Eigen::VectorXd, 3> units_;  // of the planes in harmonics
  Reconstructor reconstructor_;
};

// The status of a frame whose residuals leave the range of the format. It names no frame and no vertex: its caller
// does.
Status MotionTooFar();

}  // namespace sac
