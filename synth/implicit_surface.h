// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sac/mesh.h"

namespace sac::synth {

struct FieldSample {
  double value;
  Eigen::Vector3d gradient;
};

// A scalar field in space that is negative inside a solid and positive outside. It grows by at most 1 per unit of
// length.
struct Field {
  std::function<double(const Eigen::Vector3d&)> value;
  std::function<FieldSample(const Eigen::Vector3d&)> sample;  // the same value with its gradient
  Eigen::Vector3d low, high;                                  // a box around the solid
};

struct Surface {
  std::vector<Eigen::Vector3d> points;
  std::vector<Triangle> triangles;  // counterclockwise seen from outside
};

// The zero set of the field by marching tetrahedra: a closed surface in which every edge has two triangles. The
// tetrahedra are those of the body-centred cubic lattice, which are all alike and nearly regular (Labelle and Shewchuk,
// "Isosurface stuffing", SIGGRAPH 2007, section 3). The points are then evened out on the surface.
//
// `spacing` is the side of the lattice's cubes. Parts of the solid that are thinner than about that may be lost or torn
// off.
Surface Polygonize(const Field& field, double spacing);

}  // namespace sac::synth
