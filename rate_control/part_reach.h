// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/laplacian.h"
#include "sac/mesh.h"

namespace sac {

// Measures how far the components move that are much smaller than the mesh (EncoderSettings::reach).
class PartReach {
 public:
  // `lowest` has for each vertex of the first frame the lowest that it coincides with (CoincidentVertices).
  PartReach(const Mesh& mesh, std::span<const std::uint32_t> lowest);

  // Whether there are such components.
  bool any() const { return !small_.empty(); }
  // Takes a frame, with as many vertices as the mesh.
  void Add(std::span<const Vec3f> positions);
  // How far each vertex of theirs was from its place at most, the rigid motion of all vertices taken away; model units;
  // 0 of other vertices. Empty without such components.
  std::vector<float> Value() const { return reach_; }

 private:
  PositionMatrix mesh_;
  Eigen::RowVector3d centre_;
  std::vector<std::uint32_t> small_;  // vertices of small components
  std::vector<float> reach_;
};

}  // namespace sac
