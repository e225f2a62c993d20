// SPDX-License-Identifier: Apache-2.0
#include "files/match_side.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sac {
namespace {

// Rounds of refinement: what is so many edges away tells vertices apart.
constexpr int kRounds = 10;

// Spreads the bits of a number (the finalizer of SplitMix64, Steele et al. 2014).
std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27) * 0x94D049BB133111EBU;
  return x ^ x >> 31;
}

std::uint64_t Hash(std::uint64_t a, std::uint64_t b) { return Mix(Mix(a + 0x9E3779B97F4A7C15U) ^ b); }

}  // namespace

MatchSide::MatchSide(const Mesh& mesh, std::size_t axis) : mesh_(mesh), axis_(axis) {
  FindCorners();
  FindTwins();
  Refine();
  SortKinds();
}

void MatchSide::FindCorners() {
  begins_.assign(mesh_.positions.size() + 1, 0);
  for (const Triangle& t : mesh_.triangles) {
    for (const std::uint32_t v : t) ++begins_[v + 1];
  }
  for (std::size_t v = 0; v + 1 < begins_.size(); ++v) begins_[v + 1] += begins_[v];
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  corners_.resize(3 * mesh_.triangles.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) corners_[next[mesh_.triangles[t][k]]++] = 3 * t + k;
  }
}

void MatchSide::FindTwins() {
  twins_.assign(corners_.size(), kNone);
  const auto from = [this](std::uint32_t corner) { return mesh_.triangles[corner / 3][corner % 3]; };
  const auto to = [this](std::uint32_t corner) { return mesh_.triangles[corner / 3][(corner % 3 + 1) % 3]; };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;
  edges.reserve(corners_.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
      edges.emplace_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), 3 * t + k);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].first == edges[i].first) ++end;
    const std::uint32_t a = edges[i].second, b = edges[end - 1].second;
    if (end == i + 2 && from(a) == to(b) && from(a) != to(a)) {
      twins_[a] = b;
      twins_[b] = a;
    }
    i = end;
  }
}

void MatchSide::Refine() {
  colors_.assign(mesh_.positions.size(), 1);
  std::vector<std::uint64_t> next(colors_.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t v = 0; v < next.size(); ++v) next[v] = Mix(colors_[v]);
    for (const auto& [a, b, c] : mesh_.triangles) {
      // Sums do not depend on the order of triangles.
      next[a] += Hash(colors_[b], colors_[c]);
      next[b] += Hash(colors_[c], colors_[a]);
      next[c] += Hash(colors_[a], colors_[b]);
    }
    colors_.swap(next);
  }
}

void MatchSide::SortKinds() {
  centers_.reserve(mesh_.triangles.size());
  for (const auto& [a, b, c] : mesh_.triangles) {
    Vec3f& center = centers_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      center[k] = (mesh_.positions[a][k] + mesh_.positions[b][k] + mesh_.positions[c][k]) / 3;
    }
  }
  kinds_.reserve(mesh_.triangles.size());
  for (const auto& [a, b, c] : mesh_.triangles) {
    const std::uint64_t x = colors_[a], y = colors_[b], z = colors_[c];
    kinds_.push_back(std::min({Hash(Hash(x, y), z), Hash(Hash(y, z), x), Hash(Hash(z, x), y)}));
  }
  std::vector<std::tuple<std::uint64_t, double, std::uint32_t>> sorted;
  sorted.reserve(kinds_.size());
  for (std::uint32_t t = 0; t < kinds_.size(); ++t) sorted.emplace_back(kinds_[t], middle(t), t);
  std::sort(sorted.begin(), sorted.end());
  by_kind_.reserve(sorted.size());
  for (const auto& entry : sorted) by_kind_.push_back(std::get<2>(entry));
}

std::span<const std::uint32_t> MatchSide::TrianglesLike(std::uint64_t kind) const {
  const auto begin = std::lower_bound(by_kind_.begin(), by_kind_.end(), kind,
                                      [this](std::uint32_t t, std::uint64_t k) { return kinds_[t] < k; });
  const auto end =
      std::upper_bound(begin, by_kind_.end(), kind, [this](std::uint64_t k, std::uint32_t t) { return k < kinds_[t]; });
  return {begin, end};
}

std::vector<std::uint32_t> MatchSide::RarestFirst() const {
  std::vector<std::pair<std::size_t, std::uint32_t>> sorted;  // the size of its kind, and where it is in by_kind_
  sorted.reserve(by_kind_.size());
  for (std::size_t i = 0; i < by_kind_.size();) {
    std::size_t end = i + 1;
    while (end < by_kind_.size() && kinds_[by_kind_[end]] == kinds_[by_kind_[i]]) ++end;
    for (std::size_t j = i; j < end; ++j) sorted.emplace_back(end - i, static_cast<std::uint32_t>(j));
    i = end;
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> order;
  order.reserve(sorted.size());
  for (const auto& entry : sorted) order.push_back(by_kind_[entry.second]);
  return order;
}

}  // namespace sac
