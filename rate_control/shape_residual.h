// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// Finds what the frames of a clip say of the shape that they are decoded from: the mean over frames of the error that
// each vertex is decoded with, turned back by the rotation R_v of the decoded surface there,
//   c_v = mean over t of R_v(t)^T (x_v(t) - y_v(t)),
// with x the original and y the decoded positions. Noise of one frame that went into the shape comes back in every
// decoded frame, and so it is in the mean; what moves differently in each frame is not.
//
// R_v is the rotation nearest to the deformation gradients from the shape to y, which are summed by area over the
// triangles around the vertex. Where these have no area, the sum over the connected component takes their place, and
// then that over the mesh. A mesh without area keeps its directions.
class ShapeResidual {
 public:
  // Adds one of every `stride` frames that it is given, the first of them included. Indices of `triangles` must be
  // below `vertices`.
  ShapeResidual(std::vector<Triangle> triangles, std::size_t vertices, std::uint32_t stride);

  // Begins with the shape that a decoder has, in the vertex order of the frames. Sums that were there are dropped.
  void Begin(Positions shape);

  // Takes the next frame.
  void Add(const Positions& original, const Positions& decoded);

  // The number of frames that were added.
  std::uint32_t frames() const { return frames_; }

  // The shape with `gain` times the mean error added, model units. Vertices that coincide in `first` get the mean of
  // their positions, so that no seam opens. There must be a frame.
  Positions Corrected(double gain, const Positions& first) const;

 private:
  // Sums the deformation gradients of the frame around vertices, over components and over the mesh.
  void SumGradients(const Positions& decoded);

  const std::vector<Triangle> triangles_;
  const std::uint32_t stride_;
  std::vector<std::uint32_t> component_of_;  // one a vertex
  Positions shape_;
  std::vector<Eigen::Vector3d> sums_;  // of the errors
  std::uint32_t given_ = 0, frames_ = 0;
  std::vector<Eigen::Matrix3d> at_vertex_,
      in_component_;  // area times gradient; of the component's and the mesh's last
};

}  // namespace sac
