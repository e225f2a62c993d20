// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "geometry/laplacian.h"
#include "sac/clip.h"
#include "sac/sparse_components.h"

namespace sac {

PositionMatrix MatrixOf(const Positions& positions);
Positions PositionsOf(const PositionMatrix& matrix);

// Brings frames onto a rest shape by the best rigid motion, weighted by the area around the vertices.
class RestAlignment {
 public:
  // Every index of `triangles` is below the rows of `rest`.
  RestAlignment(const PositionMatrix& rest, std::span<const Triangle> triangles);

  // Returns `frame` moved onto the rest shape; `pose` becomes the motion that takes it back.
  PositionMatrix Align(const PositionMatrix& frame, RigidPose& pose) const { return AlignOnto(rest_, frame, pose); }
  // The same onto another shape, with the masses of the rest shape.
  PositionMatrix AlignOnto(const PositionMatrix& shape, const PositionMatrix& frame, RigidPose& pose) const;

  const PositionMatrix& rest() const { return rest_; }
  // One a vertex, of sum 1; never 0.
  const Eigen::VectorXd& mass() const { return mass_; }
  // The square root of the area; for shapes without area the diagonal of their box; for a single point 1. Model units.
  double extent() const { return extent_; }

 private:
  PositionMatrix rest_;
  Eigen::VectorXd mass_;
  double extent_;
};

// `positions` moved by `pose`.
PositionMatrix Moved(const PositionMatrix& positions, const RigidPose& pose);

// Calls `take` with each frame of `clip` from the first on, which is `vertices` positions and finite; kInvalidArgument
// with the frame's name otherwise.
Status ForEachFrame(ClipReader& clip, std::size_t vertices,
                    const std::function<Status(std::uint32_t frame, const PositionMatrix& positions)>& take);

// `message` with the name of the clip before it.
std::string AtClip(const ClipReader& clip, const std::string& message);

}  // namespace sac
