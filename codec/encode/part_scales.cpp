// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/part_scales.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "codec/encode/error_bound.h"
#include "geometry/components.h"

namespace sac {
namespace {

// A component is as fine as the mesh if its RMS radius is no less than this share of the mesh's. Parts of most figures
// (fingers, eyes, buttons) are above it, and are seen with the whole.
constexpr double kSmall = 1.0 / 256;
// What is smaller becomes finer until its radius is this share of the mesh's, against steps.
constexpr double kShare = 1.0 / 4;
// Triangles that are folded to a point count as of this share: they may be a part that is put away.
constexpr double kLeast = 1.0 / (1 << 18);

// Sums over the vertices of a component.
struct Moments {
  double count = 0, square = 0;
  std::array<double, 3> sum{};

  void Add(const Vec3f& p, const Vec3f& near) {
    ++count;
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = static_cast<double>(p[a]) - static_cast<double>(near[a]);
      sum[a] += x;
      square += x * x;
    }
  }
  double rms() const {
    double mean = 0;
    for (const double x : sum) mean += x / count * (x / count);
    return std::sqrt(std::max(0.0, square / count - mean));
  }
};

}  // namespace

double RmsRadius(const Positions& positions) {
  std::array<double, 3> sum{};
  double squares = 0;
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<double>(p[a]);
  }
  const auto n = static_cast<double>(positions.size());
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = static_cast<double>(p[a]) - sum[a] / n;
      squares += d * d;
    }
  }
  // A single point has no size; its distance from the origin stands in for the scale of its motion.
  const double radius = std::sqrt(squares / n), largest = LargestCoordinate(positions);
  if (radius > 1e-7 * largest) return radius;
  return largest > 0 ? largest : 1;
}

MeshParts FindParts(const Mesh& mesh, double rms, double displacement_step, std::span<const float> reach) {
  constexpr double kSteps = 1 << 19;
  constexpr double kLoose = 30;  // steps that the rigid motion of a frame may miss; displacements make up for it
  MeshParts parts;
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  std::uint32_t count = 0;
  parts.of_vertex = LabelComponents(vertices, mesh.triangles, count);
  std::vector<Moments> moments(count);
  std::array<double, 3> mean{};
  std::vector<const Vec3f*> first(count);  // differences to it are exact where coordinates are large
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t c = parts.of_vertex[v];
    if (first[c] == nullptr) first[c] = &mesh.positions[v];
    moments[c].Add(mesh.positions[v], *first[c]);
    for (std::size_t a = 0; a < 3; ++a) mean[a] += static_cast<double>(mesh.positions[v][a]) / vertices;
  }
  std::vector<double> farthest(count);
  for (std::uint32_t v = 0; v < vertices && !reach.empty(); ++v) {
    const Vec3f& p = mesh.positions[v];
    const double away = std::hypot(p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]);
    double& far = farthest[parts.of_vertex[v]];
    far = std::max(far, static_cast<double>(reach[v]) + kLoose * displacement_step * (1 + away / rms));
  }
  bool any = false;
  for (std::uint32_t c = 0; c < count; ++c) {
    const Moments& m = moments[c];
    PartScale& scale = parts.scales.emplace_back();
    const double size = std::max(m.rms(), m.count > 1 ? kLeast * rms : rms);
    if (!(size < kSmall * rms)) continue;  // also of coordinates that are no numbers
    double finer = kShare * rms / size;
    if (!reach.empty())
      finer = std::min(finer, kSteps * displacement_step * std::sqrt(vertices / m.count) / farthest[c]);
    scale.exponent = static_cast<std::uint32_t>(std::clamp(std::floor(std::log2(finer)), 0.0, 1.0 * kMaxPartExponent));
    any = any || scale.exponent > 0;
  }
  if (!any) parts.scales.clear();
  return parts;
}

std::vector<PartScale> ScalesOf(const MeshParts& parts, const JoinedMesh& input, const DecodedMesh& decoded,
                                const std::vector<std::uint32_t>& order) {
  std::vector<PartScale> scales;
  if (parts.scales.empty()) return scales;
  const std::vector<std::uint32_t>& copies = decoded.vertex_of_copy;
  for (const Component& c : decoded.components) {
    const auto copy =
        copies.empty()
            ? c.first
            : static_cast<std::size_t>(std::lower_bound(copies.begin(), copies.end(), c.first) - copies.begin());
    scales.push_back(parts.scales[parts.of_vertex[input.vertex_of_author[order[copy]]]]);
  }
  return scales;
}

}  // namespace sac
