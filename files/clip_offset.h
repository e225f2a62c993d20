// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/faces.h"
#include "files/mesh_file.h"

namespace sac {

// A point near the vertices, in model units, that their positions are to be relative to before they become float32.
// Zero where float32 holds the positions themselves to 2^-20 of the diagonal of their box; else the middle of the box,
// rounded to a power of ten not above the diagonal, so that it has few digits. Zero for positions that are not finite
// or all the same.
Vec3d ChooseOffset(const std::vector<Vec3d>& positions);

// The positions of a file in double, whichever it holds them in.
std::vector<Vec3d> DoublePositions(const MeshFile& file);

// The positions of a file relative to `offset`, in float32.
Positions Relative(const MeshFile& file, const Vec3d& offset);

// offset + position, in double.
inline Vec3d Absolute(const Vec3d& offset, const Vec3f& position) {
  return {offset[0] + static_cast<double>(position[0]), offset[1] + static_cast<double>(position[1]),
          offset[2] + static_cast<double>(position[2])};
}

// Makes positions relative to `offset`.
void Subtract(const Vec3d& offset, Positions& positions);

// The distance of neighbouring float32 numbers at the largest of the coordinates, if it is so large against `diagonal`
// (above 2^-16 of it) that a shape kept in float32 is likely to have lost some of itself; else 0. `diagonal` is that of
// the largest box so far, and grows to that of the positions' box: a frame may be shrunk to a point.
double CoarseStep(const Positions& positions, double& diagonal);

}  // namespace sac
