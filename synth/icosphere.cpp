// SPDX-License-Identifier: Apache-2.0
#include "synth/icosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace sac::synth {
namespace {

const std::array<Eigen::Vector3d, 12>& Corners() {
  static const std::array<Eigen::Vector3d, 12> corners = [] {
    const double g = (1 + std::sqrt(5.0)) / 2;
    return std::array<Eigen::Vector3d, 12>{{{-1, g, 0},
                                            {1, g, 0},
                                            {-1, -g, 0},
                                            {1, -g, 0},
                                            {0, -1, g},
                                            {0, 1, g},
                                            {0, -1, -g},
                                            {0, 1, -g},
                                            {g, 0, -1},
                                            {g, 0, 1},
                                            {-g, 0, -1},
                                            {-g, 0, 1}}};
  }();
  return corners;
}

constexpr std::array<Triangle, 20> kFaces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                           {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                           {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                           {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};

// Subdivides the faces. The corners are numbered first, the inner points of an edge when a face first needs them, and
// the inner points of a face as its rows are made.
class Subdivision {
 public:
  explicit Subdivision(std::uint32_t frequency) : f_(frequency) {
    sphere_.points.reserve(10 * std::size_t{f_} * f_ + 2);
    for (const Eigen::Vector3d& c : Corners()) sphere_.points.push_back(c.normalized());
    for (const Triangle& face : kFaces) AddFace(face);
  }

  Icosphere Take() { return std::move(sphere_); }

 private:
  void AddFace(const Triangle& face) {
    const auto [a, b, c] = face;
    // Row i runs from the edge ab to the edge ac, i steps away from a.
    std::vector<std::uint32_t> row{a}, next;
    for (std::uint32_t i = 1; i <= f_; ++i, row.swap(next)) {
      next.clear();
      for (std::uint32_t j = 0; j <= i; ++j) {
        if (j == 0) {
          next.push_back(OnEdge(a, b, i));
        } else if (j == i) {
          next.push_back(OnEdge(a, c, i));
        } else if (i == f_) {
          next.push_back(OnEdge(b, c, j));
        } else {
          next.push_back(Add((f_ - i) * Corners()[a] + (i - j) * Corners()[b] + j * Corners()[c]));
        }
      }
      for (std::uint32_t j = 0; j < i; ++j) {
        sphere_.triangles.push_back({row[j], next[j], next[j + 1]});
        if (j + 1 < i) sphere_.triangles.push_back({row[j], next[j + 1], row[j + 1]});
      }
    }
  }

  // The point `step` steps from corner `from` towards corner `to`.
  std::uint32_t OnEdge(std::uint32_t from, std::uint32_t to, std::uint32_t step) {
    if (from > to) {
      std::swap(from, to);
      step = f_ - step;
    }
    if (step == 0) return from;
    if (step == f_) return to;
    const auto [it, is_new] = edges_.try_emplace({from, to}, static_cast<std::uint32_t>(sphere_.points.size()));
    if (is_new) {
      for (std::uint32_t s = 1; s < f_; ++s) Add((f_ - s) * Corners()[from] + s * Corners()[to]);
    }
    return it->second + step - 1;
  }

  std::uint32_t Add(const Eigen::Vector3d& p) {
    sphere_.points.push_back(p.normalized());
    return static_cast<std::uint32_t>(sphere_.points.size() - 1);
  }

  std::uint32_t f_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;  // first inner point of each edge
  Icosphere sphere_;
};

}  // namespace

Icosphere MakeIcosphere(std::uint32_t frequency) { return Subdivision(frequency).Take(); }

}  // namespace sac::synth
