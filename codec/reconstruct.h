// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/shape.h"
#include "format/prediction.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"
#include "geometry/poisson_system.h"
#include "sac/mesh.h"

namespace sac {

// Rounds `matrix` to floats: the only place where positions are rounded.
void ToPositions(const PositionMatrix& matrix, Positions& positions);

// A rotation about the centre of the first frame, after which the centre is at `translation`, model units.
struct RigidTransform {
  Eigen::Matrix3d rotation;
  Eigen::RowVector3d translation;
};

// The values of one plane at the vertices, harmonics times coefficients (spec.md 6.5.1). Only harmonics whose
// coefficients changed are touched.
class PlaneField {
 public:
  // `basis` must outlive it. `units`: of each row's coefficients.
  PlaneField(const HarmonicBasis& basis, const PlaneLayout& layout, Eigen::VectorXd units);

  // vertices x channels.
  const Eigen::MatrixXd& Update(const PlaneValues& coefficients);
  // Forgets what was summed up, so that values do not depend on what was decoded before a group.
  void Reset();

 private:
  const HarmonicBasis& basis_;
  Eigen::VectorXd units_;
  std::vector<std::int32_t> held_;
  Eigen::MatrixXd values_;
  double largest_ = 0;  // sum of magnitudes since values_ were zero
};

// The unit of each row of a plane in harmonics (spec.md 6.5.1): a sixteenth of the header's step. It is larger in small
// components, whose vertices are few; and patches share the error of a vertex among their harmonics.
Eigen::VectorXd PlaneUnits(const Shape& shape, const SequenceHeader& header, Plane plane);

// Turns coefficients into positions: the one body that encoder and decoder call.
class Reconstructor {
 public:
  // `shape` must outlive it. Call StartGroup() first, then for each frame StartFrame() and
  // Reconstruct() or its parts.
  Reconstructor(const Shape& shape, const SequenceHeader& header);

  // Forgets the frames before, so that a group decodes alike wherever decoding begins. False when the reference shape
  // cannot be factorized.
  bool StartGroup();
  // Sets the reference shape of the next frame: M'0, but of `previous` the last frame reconstructed, unless `intra`.
  bool StartFrame(bool intra);

  // What the motion plane alone gives, before the rigid motion.
  const PositionMatrix& ReconstructMotion(const PlaneValues& motion);
  // Adds another plane, in their order, to what there is of the frame.
  const PositionMatrix& Add(Plane plane, const PlaneValues& values);
  // The transform of a rigid motion (spec.md 6.5.4).
  RigidTransform TransformOf(const RigidMotion& rigid) const;
  // The transform at `t` between two rigid motions, 0: `from`, 1: `to`. The rotation takes the shorter way, whatever
  // turns the rotation vectors have in them: each group unwraps rotations from its own begin. Non-normative.
  RigidTransform TransformBetween(const RigidMotion& from, const RigidMotion& to, double t) const;

  // The positions `aligned` after a rigid motion, model units.
  PositionMatrix ApplyRigid(const PositionMatrix& aligned, const RigidMotion& rigid) const;
  // The inverse of ApplyRigid(), for encoders.
  PositionMatrix RemoveRigid(const PositionMatrix& positions, const RigidMotion& rigid) const;

  // All of the above: the positions, model units, of a frame with these planes and transform. The matrix is overwritten
  // by the next call.
  const PositionMatrix& Reconstruct(const FramePlanes& planes, const RigidTransform& transform);
  const PositionMatrix& Reconstruct(const FrameCoefficients& frame) {
    return Reconstruct(frame.planes, TransformOf(frame.rigid));
  }

  // The shape that the next frame's motion is measured against.
  const PositionMatrix& reference() const { return reference_is_key_ ? shape_.positions : aligned_; }

 private:
  bool UseKeyReference();
  void Transform(const PositionMatrix& aligned, const RigidTransform& transform, PositionMatrix& moved) const;

  const Shape& shape_;
  SequenceHeader header_;
  std::vector<PlaneField> fields_;  // of the planes in harmonics
  double correction_unit_;
  PoissonSystem poisson_;
  bool reference_is_key_ = false;
  DeformationGradients gradients_;
  PositionMatrix aligned_;  // the frame before its rigid motion
  PositionMatrix moved_;    // and after it
};

}  // namespace sac
