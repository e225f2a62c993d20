// SPDX-License-Identifier: Apache-2.0
#include "files/axes.h"

#include <optional>
#include <string_view>
#include <utility>

namespace sac {
namespace {

constexpr std::pair<std::string_view, double> kUnits[] = {{"mm", 1e-3},   {"cm", 1e-2},   {"m", 1},      {"km", 1e3},
                                                          {"in", 0.0254}, {"ft", 0.3048}, {"yd", 0.9144}};

// A unit in metres.
std::optional<double> Metres(std::string_view name) {
  for (const auto& [unit, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return std::nullopt;
}

}  // namespace

bool AxisConversion::ParseUp(const std::string& words) {
  if (words != "y:z" && words != "z:y") return false;
  turn_ = words == "y:z" ? 1 : -1;
  return true;
}

bool AxisConversion::ParseUnits(const std::string& words) {
  const std::string_view text = words;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  const std::optional<double> from = Metres(text.substr(0, colon)), to = Metres(text.substr(colon + 1));
  if (!from || !to) return false;
  scale_ = *from / *to;
  return true;
}

template <class Number>
std::array<Number, 3> AxisConversion::Turn(const std::array<Number, 3>& vector) const {
  if (turn_ > 0) return {vector[0], -vector[2], vector[1]};
  if (turn_ < 0) return {vector[0], vector[2], -vector[1]};
  return vector;
}

std::array<double, 3> AxisConversion::Point(const std::array<double, 3>& point) const {
  std::array<double, 3> turned = Turn(point);
  for (double& x : turned) x *= scale_;
  return turned;
}

Positions AxisConversion::Points(Positions points) const {
  if (!changes()) return points;
  for (Vec3f& point : points) {
    point = Turn(point);
    for (float& x : point) x = static_cast<float>(static_cast<double>(x) * scale_);
  }
  return points;
}

Mesh AxisConversion::Convert(Mesh mesh) const {
  mesh.positions = Points(std::move(mesh.positions));
  for (Vec3f& normal : mesh.normals) normal = Turn(normal);
  return mesh;
}

}  // namespace sac
