// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "codec/blend_system.h"
#include "codec/shape.h"
#include "format/prediction.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"
#include "geometry/sparse_cholesky.h"
#include "sac/mesh.h"

namespace sac {

// Rounds `matrix` to floats. Positions are rounded nowhere else.
void ToPositions(const PositionMatrix& matrix, Positions& positions);

// A rotation about the centre of the first frame that then moves the centre to `translation` (model units).
struct RigidTransform {
  Eigen::Matrix3d rotation;
  Eigen::RowVector3d translation;
};

// The values of one plane where it is asked for (spec.md 6.5.1): harmonics times coefficients, at handles, in functions
// of the blend or at vertices. An update adds only the harmonics whose coefficients changed.
class PlaneField {
 public:
  // The harmonics of one component or patch.
  struct Part {
    Eigen::Index first;              // the first of the rows of all values that are its own
    const Eigen::MatrixXd& vectors;  // those rows x harmonics
  };
  // `parts` and `order`, which has the harmonic of each row of the plane, must outlive the object. `units` has the unit
  // of the coefficients in each row.
  PlaneField(std::vector<Part> parts, std::span<const HarmonicIndex> order, std::size_t channels,
             Eigen::VectorXd units);

  // The values for `coefficients`, rows of all parts x channels, valid until the next call.
  const Eigen::MatrixXd& Update(const PlaneValues& coefficients);
  // Sets all values to zero, so that rounding errors do not depend on what was decoded before a group.
  void Reset();

 private:
  std::vector<Part> parts_;
  std::span<const HarmonicIndex> order_;
  Eigen::VectorXd units_;
  std::vector<std::int32_t> held_;
  Eigen::MatrixXd values_;
  double largest_ = 0;  // largest sum of coefficient magnitudes since values_ were zero
};

// The unit of the coefficients in each row of `plane` (spec.md 6.5.1): a sixteenth of the header's step, scaled by the
// size of the row's component, and but for motion by its factor. The units of motion and displacement are larger in
// components with few vertices. The unit of detail is divided by the square root of the patch's number of vertices, so
// that the error of a vertex does not depend on the number of harmonics.
Eigen::VectorXd PlaneUnits(const Shape& shape, const SequenceHeader& header, Plane plane);

// Turns coefficients into positions. Encoder and decoder both call it.
class Reconstructor {
 public:
  // `shape` must outlive the object. Call StartGroup() first, then for each frame StartFrame() and Reconstruct() or its
  // parts.
  Reconstructor(const Shape& shape, const SequenceHeader& header);

  // Forgets all frames before, so that a group decodes to the same positions wherever decoding begins.
  void StartGroup();
  // Sets the reference shape of the next frame. It is M'0, but in a stream that references the previous frame it is the
  // frame reconstructed last, unless `intra`. Returns false when its linear system cannot be factorized.
  bool StartFrame(bool intra);

  // The positions that the motion plane alone gives, before the rigid motion, model units.
  const PositionMatrix& ReconstructMotion(const PlaneValues& motion);
  // Adds the values of another plane to the positions of the frame, in the order of planes, and returns the positions.
  const PositionMatrix& Add(Plane plane, const PlaneValues& values);
  // The transform of a rigid motion (spec.md 6.5.4).
  RigidTransform TransformOf(const RigidMotion& rigid) const;
  // The transform at `t` between two rigid motions: `from` at 0, `to` at 1. The rotation takes the shorter way, because
  // the rotation vectors of two groups may differ by full turns: each group unwraps rotations from its own beginning.
  // Non-normative.
  RigidTransform TransformBetween(const RigidMotion& from, const RigidMotion& to, double t) const;

  // Applies a rigid motion to the positions `aligned`, model units.
  PositionMatrix ApplyRigid(const PositionMatrix& aligned, const RigidMotion& rigid) const;
  // The inverse of ApplyRigid(), for encoders.
  PositionMatrix RemoveRigid(const PositionMatrix& positions, const RigidMotion& rigid) const;

  // The positions, model units, of a frame with these planes and transform. The next call overwrites the matrix, and
  // only in streams that reference the previous frame it remembers the shape for the next StartFrame().
  const PositionMatrix& Reconstruct(const FramePlanes& planes, const RigidTransform& transform);
  const PositionMatrix& Reconstruct(const FrameCoefficients& frame) {
    return Reconstruct(frame.planes, TransformOf(frame.rigid));
  }

  // The coefficients of the blend, about the origin (Blend::MoveToOrigin), of a frame with these planes and transform,
  // without detail and correction. The next call overwrites the matrix. Not in streams that reference the previous
  // frame.
  const RowMatrix& ReconstructBlend(const FramePlanes& planes, const RigidTransform& transform);

  // The shape that the next frame's motion is measured against.
  const PositionMatrix& reference() const { return previous_ ? aligned_ : shape_.positions; }

 private:
  // Sets blend_ to what the motion plane gives, and adds the displacement plane.
  void BlendMotion(const PlaneValues& motion);
  void BlendDisplacement(const PlaneValues& displacement);
  // Sets about_origin_ to blend_ with `transform` applied, if it is not null.
  void PlaceBlend(const RigidTransform* transform);
  // Sets `positions` to those that blend_ gives, `transform` applied.
  void ApplyBlend(const RigidTransform* transform, PositionMatrix& positions);
  void AddDetail(const PlaneValues& detail);
  void AddCorrection(const PlaneValues& correction);
  void Transform(const PositionMatrix& aligned, const RigidTransform& transform, PositionMatrix& moved) const;

  const Shape& shape_;
  SequenceHeader header_;
  PlaneField motion_, displacement_, detail_;  // at handles, in functions of the blend, at vertices
  double correction_unit_;
  // The system of the frame before, in streams that reference it.
  std::unique_ptr<BlendSystem> of_previous_;
  bool previous_ = false;  // the reference shape is the frame before
  DeformationGradients gradients_;
  BlendSystem::Scratch scratch_;
  RowMatrix blend_;         // coefficients of the blend's functions
  RowMatrix about_origin_;  // the same about the origin, after the rigid motion where there is one
  PositionMatrix aligned_;  // the frame before its rigid motion
  PositionMatrix moved_;    // the frame after its rigid motion
};

}  // namespace sac
