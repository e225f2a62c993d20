// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "sac/mesh.h"

namespace sac {

// A change of the vertical axis and of the unit of length, for tools that have others than the one a clip comes from. A
// stream says nothing of either, so the user does.
class AxisConversion {
 public:
  // Takes the words `y:z` and `z:y`: from the one axis up to the other, a quarter turn about x. False for any other.
  bool ParseUp(const std::string& words);
  // Takes two units, as `cm:m`: mm, cm, m, km, in, ft or yd. False for any other words.
  bool ParseUnits(const std::string& words);

  bool changes() const { return turn_ != 0 || scale_ != 1; }
  // Whether what is converted has z up.
  bool z_up() const { return turn_ > 0; }
  double scale() const { return scale_; }

  // Converts a point. Exact but for the scale.
  std::array<double, 3> Point(const std::array<double, 3>& point) const;
  Positions Points(Positions points) const;
  // Converts positions and normals.
  Mesh Convert(Mesh mesh) const;

 private:
  template <class Number>
  std::array<Number, 3> Turn(const std::array<Number, 3>& vector) const;

  int turn_ = 0;  // quarter turns about x
  double scale_ = 1;
};

}  // namespace sac
