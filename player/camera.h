// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "sac/mesh.h"

namespace sac {

// A 4 x 4 matrix, column by column, as OpenGL takes it.
using Matrix4 = std::array<float, 16>;

// A camera that goes around a point.
struct Camera {
  double turn = 0.6, rise = 0.25;  // radians, around the axis up and above the plane across
  double distance = 1;             // from the point to the eye, model units
  std::array<double, 3> point = {};
  bool z_up = false;

  // Looks at all of `box`.
  void Fit(const Box& box);
  void Orbit(double across, double up);     // radians
  void Pan(double right, double up);        // fractions of the height of the picture
  void Zoom(double factor);                 // of the distance
  std::array<double, 3> right() const;      // of length 1
  std::array<double, 3> up() const;         // of length 1
  std::array<double, 3> backward() const;   // from the point to the eye, of length 1
  Matrix4 View() const;                     // from model units to the eye's axes
  Matrix4 Projection(double aspect) const;  // perspective; `aspect` is width by height of the picture
};

}  // namespace sac
