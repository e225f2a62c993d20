// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac::synth {

struct Icosphere {
  std::vector<Eigen::Vector3d> points;  // unit vectors
  std::vector<Triangle> triangles;      // counterclockwise seen from outside
};

// The icosahedron with every edge cut into `frequency` >= 1 parts and all points projected to the unit sphere. It has
// 10 frequency^2 + 2 points.
Icosphere MakeIcosphere(std::uint32_t frequency);

}  // namespace sac::synth
