// SPDX-License-Identifier: Apache-2.0
#include "files/clip_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sac/mesh.h"

namespace sac {
namespace {

// The box of vertices, empty boxes being a point at 0, and the largest absolute coordinate.
template <typename Point>
Box BoxOf(const std::vector<Point>& positions, double& largest) {
  Box box;
  largest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<double>(positions[i][k]);
      box.low[k] = i == 0 ? x : std::min(box.low[k], x);
      box.high[k] = i == 0 ? x : std::max(box.high[k], x);
      largest = std::max(largest, std::abs(x));
    }
  }
  return box;
}

}  // namespace

Vec3d ChooseOffset(const std::vector<Vec3d>& positions) {
  double largest = 0;
  const Box box = BoxOf(positions, largest);
  const double diagonal = box.diagonal();
  // Rounding to float32 moves a coordinate by up to 2^-24 of itself.
  if (!(diagonal > 0) || !std::isfinite(diagonal) || largest * 0x1p-24 <= diagonal * 0x1p-20) return {};
  const double unit = std::pow(10.0, std::floor(std::log10(diagonal)));
  Vec3d offset{};
  for (int k = 0; k < 3; ++k) {
    offset[k] = std::round((box.low[k] / 2 + box.high[k] / 2) / unit) * unit + 0.0;  // no negative zero
  }
  return offset;
}

std::vector<Vec3d> DoublePositions(const MeshFile& file) {
  if (!file.exact.empty()) return file.exact;
  std::vector<Vec3d> positions;
  positions.reserve(file.mesh.positions.size());
  for (const Vec3f& p : file.mesh.positions) positions.push_back({p[0], p[1], p[2]});
  return positions;
}

Positions Relative(const MeshFile& file, const Vec3d& offset) {
  Positions relative = file.mesh.positions;
  if (offset == Vec3d{}) return relative;
  if (file.exact.empty()) Subtract(offset, relative);
  for (std::size_t i = 0; i < file.exact.size(); ++i) {
    for (int k = 0; k < 3; ++k) relative[i][k] = static_cast<float>(file.exact[i][k] - offset[k]);
  }
  return relative;
}

void Subtract(const Vec3d& offset, Positions& positions) {
  if (offset == Vec3d{}) return;
  for (Vec3f& position : positions) {
    for (int k = 0; k < 3; ++k) position[k] = static_cast<float>(position[k] - offset[k]);
  }
}

double CoarseStep(const Positions& positions, double& diagonal) {
  double largest = 0;
  diagonal = std::max(diagonal, BoxOf(positions, largest).diagonal());
  const auto top = static_cast<float>(largest);
  const double step = static_cast<double>(std::nextafter(top, std::numeric_limits<float>::infinity())) - top;
  return diagonal > 0 && step > diagonal * 0x1p-16 ? step : 0;
}

}  // namespace sac
