// SPDX-License-Identifier: Apache-2.0
#include "decomposition/given_component.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sac {

std::vector<float> GivenComponent(const Stroke& stroke, const DecompositionSettings& settings,
                                  const SurfaceDistance& distance, const RestAlignment& alignment, double scale) {
  const PositionMatrix& rest = alignment.rest();
  const double near = settings.near * alignment.extent(), far = settings.far * alignment.extent();
  std::vector<SurfaceDistance::Seed> seeds;
  for (const std::uint32_t v : stroke.vertices) seeds.push_back({v, 0});
  const std::vector<double> from = distance.From(seeds, far);
  std::vector<float> values(static_cast<std::size_t>(rest.rows()) * 3, 0);
  const auto set = [&](std::size_t v, const Vec3f& displacement, double fade) {
    for (std::size_t a = 0; a < 3; ++a) {
      values[3 * v + a] = static_cast<float>(fade * static_cast<double>(displacement[a]) / scale);
    }
  };
  for (std::size_t v = 0; v < from.size(); ++v) {
    if (!(from[v] < far)) continue;
    std::size_t nearest = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < stroke.vertices.size(); ++i) {
      const double d = (rest.row(stroke.vertices[i]) - rest.row(static_cast<Eigen::Index>(v))).squaredNorm();
      if (d < least) {
        least = d;
        nearest = i;
      }
    }
    set(v, stroke.displacements[nearest], std::min(1.0, (far - from[v]) / (far - near)));
  }
  for (std::size_t i = 0; i < stroke.vertices.size(); ++i) set(stroke.vertices[i], stroke.displacements[i], 1);
  for (const std::uint32_t v : settings.still) set(v, {0, 0, 0}, 0);
  return values;
}

}  // namespace sac
