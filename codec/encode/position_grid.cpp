// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/position_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "codec/encode/edge_length.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// The grid has this many bits more than `bits`, so that steps, a whole number of cells, follow the edges' lengths
// closely.
constexpr int kGridBits = 5;
// The share of a step that grows with the edges; the rest is the same everywhere.
constexpr double kStepByEdges = 0.8;
constexpr double kLongestStep = 0.5;  // largest growing share of a step, in edge lengths

// Chooses where the grid of each part begins, on a grid whose cells the positions `cells` are in and whose last place
// is `last`, and brings the positions onto the grids of their parts.
void PlaceParts(double last, MeshParts& parts, std::vector<std::array<double, 3>>& cells) {
  if (parts.scales.empty()) return;
  constexpr double kFar = std::numeric_limits<double>::max();
  std::vector<std::array<double, 3>> low(parts.scales.size(), {kFar, kFar, kFar}), high(parts.scales.size());
  for (std::size_t v = 0; v < cells.size(); ++v) {
    const std::uint32_t c = parts.of_vertex[v];
    for (std::size_t a = 0; a < 3; ++a) {
      low[c][a] = std::min(low[c][a], cells[v][a]);
      high[c][a] = std::max(high[c][a], cells[v][a]);
    }
  }
  for (std::size_t c = 0; c < parts.scales.size(); ++c) {
    PartScale& scale = parts.scales[c];
    double needed = 0;
    for (std::size_t a = 0; a < 3; ++a) needed = std::max(needed, high[c][a] - std::floor(low[c][a]));
    while (scale.exponent > 0 && std::ldexp(needed, static_cast<int>(scale.exponent)) > last) --scale.exponent;
    for (std::size_t a = 0; scale.exponent > 0 && a < 3; ++a) {
      scale.origin[a] = static_cast<std::uint32_t>(std::floor(low[c][a]));
    }
  }
  for (std::size_t v = 0; v < cells.size(); ++v) {
    const PartScale& scale = parts.scales[parts.of_vertex[v]];
    for (std::size_t a = 0; a < 3; ++a) cells[v][a] = (cells[v][a] - scale.origin[a]) / scale.factor();
  }
}

}  // namespace

Status ChooseGrid(const Mesh& mesh, double bits, bool by_edges, SequenceHeader& header, MeshParts& parts,
                  PositionTargets& targets) {
  const Box box = BoundingBox(mesh.positions);
  const std::array<double, 3>&low = box.low, size = box.size();
  const double extent = std::max({size[0], size[1], size[2]});
  if (extent > 1e37) return Status::InvalidArgument("the coordinates span more than 1e37");
  header.position_bits = static_cast<std::uint8_t>(std::min(std::ceil(bits) + kGridBits, 24.0));
  const double last = std::ldexp(1.0, header.position_bits) - 1;
  header.cell = std::max(static_cast<float>(extent / last), 1e-35f);
  header.origin_x = static_cast<float>(low[0]);
  header.origin_y = static_cast<float>(low[1]);
  header.origin_z = static_cast<float>(low[2]);
  for (const Vec3f& p : mesh.positions) {
    std::array<double, 3>& cells = targets.cells.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      cells[a] = std::clamp((static_cast<double>(p[a]) - low[a]) / static_cast<double>(header.cell), 0.0, last);
    }
  }
  PlaceParts(last, parts, targets.cells);
  const double step = std::exp2(header.position_bits - bits);
  const double edge = by_edges ? MedianEdge<double>(targets.cells, mesh.triangles) : 0;
  // Steps that are about as long as the edges do not follow them.
  const bool follows = edge > 0 && kStepByEdges * step / edge < kLongestStep;
  const double share = follows ? kStepByEdges : 0;
  targets.steps.base = static_cast<std::uint32_t>(std::lround(std::max(16 * (1 - share) * step, 1.0)));
  targets.steps.slope = follows ? static_cast<std::uint32_t>(std::lround(4096 * share * step / edge)) : 0;
  return Status::Ok();
}

}  // namespace sac
