// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac::synth {

struct Icosphere {
  std::vector<Eigen::Vector3d> points;  // unit vectors
  std::vector<Triangle> triangles;      // outward
};

// The icosahedron with every edge cut into `frequency` >= 1 parts, pushed out to the unit sphere: 10 frequency^2 + 2
// points.
Icosphere MakeIcosphere(std::uint32_t frequency);

}  // namespace sac::synth
