// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The normals of any frame of a clip, from its positions and the normals of one frame, the reference. A stream has the
// first frame's normals only: a player that shows hard edges or the author's own normals computes those of the others.
//
// Corners of a vertex that share a normal in the reference share one in every frame, so hard edges stay hard and smooth
// ones smooth. A normal turns with the surface around it: with the mean of the normals of the triangles that share it,
// weighted by area, and about that mean as their edges do on average. So the reference keeps exactly its own normals,
// whatever they were made of, what moves rigidly takes its normals with it, and nothing jumps. A normal without area
// around it, in the reference or the frame, stays what it is in the reference.
class FrameNormals {
 public:
  // `reference` has the positions, triangles and normals of one frame, such as Decoder::mesh(). Without normals there
  // are none in any frame.
  explicit FrameNormals(const Mesh& reference);

  // What Mesh::normal_triangles are for the normals of Compute(): per corner the index of its normal; empty when the
  // normals are those of vertices.
  const std::vector<Triangle>& normal_triangles() const { return normal_triangles_; }

  // The normals of a frame with `positions` in the vertex order of the reference, valid until the next call. There are
  // as many in every frame; none without any in the reference.
  const std::vector<Vec3f>& Compute(std::span<const Vec3f> positions);

 private:
  using Vec3d = std::array<double, 3>;
  // Three perpendicular directions of length 1 at a normal; zeros where there is no area.
  struct Axes {
    Vec3d along = {}, across = {}, mean = {};  // `mean` of the triangles' normals
  };

  const std::vector<Triangle>& targets() const { return normal_triangles_.empty() ? triangles_ : normal_triangles_; }
  void ComputeAxes(std::span<const Vec3f> positions);
  void ComputeTurns(std::span<const Vec3f> positions);

  Positions reference_;
  std::vector<Triangle> triangles_;
  std::vector<Triangle> normal_triangles_;
  std::vector<Vec3f> own_;  // normals of the reference
  std::vector<Axes> reference_axes_;
  // Of the frame: the axes, and the turn of the edges about the mean, from axes to axes; of any length.
  std::vector<Vec3d> sums_;
  std::vector<Axes> axes_;
  std::vector<std::complex<double>> turns_;
  std::vector<Vec3f> normals_;
};

}  // namespace sac
