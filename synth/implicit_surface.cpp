// SPDX-License-Identifier: Apache-2.0
#include "synth/implicit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace sac::synth {
namespace {

constexpr int kSmoothingRounds = 8;

// A lattice point in half cube sides from the lattice's corner: cube corners have even coordinates, cube centres odd
// ones.
using LatticePoint = std::array<std::int32_t, 3>;

LatticePoint operator+(const LatticePoint& a, const LatticePoint& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

struct Sample {
  LatticePoint at;
  double value;
};

// Hashes the keys of lattice edges, which are packed coordinates and would collide without it.
struct EdgeHash {
  std::size_t operator()(std::uint64_t key) const { return key * 0x9e3779b97f4a7c15 >> 7; }
};

class Polygonizer {
 public:
  Polygonizer(const Field& field, double spacing) : field_(field), half_(spacing / 2), spacing_(spacing) {
    // The irrational margins keep the solid's planes of symmetry off the lattice, since the field could be zero on a
    // whole lattice face there.
    const Eigen::Vector3d margin(1.6180 * spacing, 1.4142 * spacing, 1.7321 * spacing);
    corner_ = field.low - margin;
    const double extent = (field.high - field.low + 2 * margin).maxCoeff();
    while (cubes_ * spacing < extent) cubes_ *= 2;
  }

  Surface Run() {
    March({1, 1, 1}, cubes_);
    return std::move(surface_);
  }

 private:
  Eigen::Vector3d Position(const LatticePoint& p) const { return corner_ + half_ * Eigen::Vector3d(p[0], p[1], p[2]); }
  Sample At(const LatticePoint& p) const { return {p, field_.value(Position(p))}; }

  // Goes through a block of size^3 cubes, the centre of the first of which is `first`. Blocks far from the surface are
  // skipped as a whole, because the field grows by at most 1 per unit of length.
  void March(const LatticePoint& first, std::int32_t size) {
    const Eigen::Vector3d middle = Position(first) + Eigen::Vector3d::Constant((size - 1) * half_);
    const double reach = (size - 1) * half_ * std::sqrt(3.0) + 1.01 * spacing_;
    if (std::abs(field_.value(middle)) > reach) return;
    if (size == 1) return MarchCube(first);
    for (std::int32_t i = 0; i < 8; ++i) {
      March(first + LatticePoint{(i & 1) * size, (i >> 1 & 1) * size, (i >> 2) * size}, size / 2);
    }
  }

  // The tetrahedra between a cube's centre and the centres of the next cubes along the axes: four share the line
  // between two centres, and each has one edge of the face in between.
  void MarchCube(const LatticePoint& centre) {
    const Sample c = At(centre);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      LatticePoint along{}, u{}, v{};
      along[axis] = 1;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = 1;
      const LatticePoint face = centre + along;
      const auto minus = [](const LatticePoint& p) { return LatticePoint{-p[0], -p[1], -p[2]}; };
      const Sample next = At(face + along);
      const std::array<Sample, 4> ring{At(face + minus(u) + minus(v)), At(face + u + minus(v)), At(face + u + v),
                                       At(face + minus(u) + v)};
      for (std::size_t i = 0; i < 4; ++i) MarchTetrahedron({c, next, ring[i], ring[(i + 1) % 4]});
    }
  }

  // The corners are in positive orientation: seen from the first one, the others turn clockwise around the outward
  // view.
  void MarchTetrahedron(const std::array<Sample, 4>& t) {
    std::array<std::size_t, 4> order{};  // the corners inside the solid first
    std::size_t inside = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (t[i].value < 0) order[inside++] = i;
    }
    if (inside == 0 || inside == 4) return;
    std::size_t next = inside;
    for (std::size_t i = 0; i < 4; ++i) {
      if (t[i].value >= 0) order[next++] = i;
    }
    const auto cut = [&](std::size_t i, std::size_t o) { return Cut(t[order[i]], t[order[o]]); };
    const bool even = IsEven(order);
    if (inside == 1) {
      Emit(cut(0, 1), cut(0, 2), cut(0, 3), even);
    } else if (inside == 3) {
      Emit(cut(0, 3), cut(1, 3), cut(2, 3), even);
    } else {
      const std::uint32_t a = cut(0, 2), b = cut(0, 3), c = cut(1, 3), d = cut(1, 2);
      Emit(a, b, c, even);
      Emit(a, c, d, even);
    }
  }

  static bool IsEven(const std::array<std::size_t, 4>& order) {
    int inversions = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
    }
    return inversions % 2 == 0;
  }

  void Emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool even) {
    if (!even) std::swap(b, c);
    surface_.triangles.push_back({a, b, c});
  }

  // The number of the surface point on a lattice edge, which all tetrahedra around the edge share.
  std::uint32_t Cut(const Sample& inside, const Sample& outside) {
    const bool flip = inside.at > outside.at;
    const LatticePoint &low = flip ? outside.at : inside.at, &high = flip ? inside.at : outside.at;
    std::uint64_t key = 0, direction = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      key = key << 19 | static_cast<std::uint64_t>(low[c]);
      direction = direction * 5 + static_cast<std::uint64_t>(high[c] - low[c] + 2);
    }
    key = key << 7 | direction;
    const auto [it, is_new] = cuts_.try_emplace(key, static_cast<std::uint32_t>(surface_.points.size()));
    if (is_new) {
      const double x = std::clamp(inside.value / (inside.value - outside.value), 0.02, 0.98);
      surface_.points.push_back((1 - x) * Position(inside.at) + x * Position(outside.at));
    }
    return it->second;
  }

  const Field& field_;
  double half_, spacing_;
  Eigen::Vector3d corner_;
  std::int32_t cubes_ = 1;
  Surface surface_;
  std::unordered_map<std::uint64_t, std::uint32_t, EdgeHash> cuts_;
};

// Moves every point towards the mean of its neighbours, then back to the surface by a step of Newton's method.
void EvenOut(const Field& field, Surface& surface) {
  std::vector<Eigen::Vector3d> sum(surface.points.size());
  std::vector<std::uint32_t> count(surface.points.size());
  for (int round = 0; round < kSmoothingRounds; ++round) {
    std::fill(sum.begin(), sum.end(), Eigen::Vector3d::Zero());
    std::fill(count.begin(), count.end(), 0);
    for (const Triangle& t : surface.triangles) {
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += surface.points[t[(k + 1) % 3]];
        ++count[t[k]];
      }
    }
    for (std::size_t v = 0; v < surface.points.size(); ++v) {
      Eigen::Vector3d& p = surface.points[v];
      p += 0.6 * (sum[v] / count[v] - p);
      const auto [value, gradient] = field.sample(p);
      p -= value * gradient / std::max(gradient.squaredNorm(), 0.1);
    }
  }
}

}  // namespace

Surface Polygonize(const Field& field, double spacing) {
  Surface surface = Polygonizer(field, spacing).Run();
  EvenOut(field, surface);
  return surface;
}

}  // namespace sac::synth
