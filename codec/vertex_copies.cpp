// SPDX-License-Identifier: Apache-2.0
#include "codec/vertex_copies.h"

#include <algorithm>
#include <numeric>

#include "geometry/corner_groups.h"

namespace sac {
namespace {

// A number for each edge of each triangle, the same for those of the same two vertices; `none` for one of a vertex with
// itself. `count` becomes how many there are.
std::vector<Triangle> NumberEdges(const std::vector<Triangle>& triangles, std::uint32_t none, std::size_t& count) {
  struct Side {
    std::uint32_t low, high, triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  std::vector<Triangle> edge_of(triangles.size(), {none, none, none});
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[j][k], b = triangles[j][(k + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), j, k});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  count = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].low != sides[i - 1].low || sides[i].high != sides[i - 1].high) ++count;
    edge_of[sides[i].triangle][sides[i].corner] = static_cast<std::uint32_t>(count - 1);
  }
  return edge_of;
}

}  // namespace

CornerKinds KindsOfCorners(const std::vector<Triangle>& triangles, std::size_t first,
                           std::initializer_list<const std::vector<Triangle>*> attributes, std::uint32_t vertices) {
  CornerKinds kinds;
  kinds.triangles.assign(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(first));
  for (const std::vector<Triangle>* attribute : attributes) {
    if (!attribute->empty()) kinds.triangles = GroupCorners(kinds.triangles, *attribute).triangles;
  }
  std::uint32_t next = 0;
  for (const Triangle& t : kinds.triangles) next = std::max(next, *std::max_element(t.begin(), t.end()) + 1);
  std::vector<std::uint32_t> of_vertex(vertices);
  std::iota(of_vertex.begin(), of_vertex.end(), next);
  for (std::size_t j = first; j-- > 0;) {
    for (std::size_t k = 3; k-- > 0;) of_vertex[triangles[j][k]] = kinds.triangles[j][k];
  }
  for (std::size_t j = first; j < triangles.size(); ++j) {
    const Triangle& t = triangles[j];
    kinds.triangles.push_back({of_vertex[t[0]], of_vertex[t[1]], of_vertex[t[2]]});
  }
  kinds.count = next + vertices;
  return kinds;
}

template <class Coder>
CopyCoder<Coder>::CopyCoder(std::uint32_t vertices, const std::vector<Triangle>& triangles, const CornerKinds& kinds)
    : triangles_(triangles),
      kinds_(kinds),
      counts_(vertices),
      last_(vertices),
      last_of_kind_(kinds.count, kNone),
      kind_of_(vertices) {
  std::size_t edges = 0;
  edge_of_ = NumberEdges(triangles, kNone, edges);
  edges_.resize(edges);
}

template <class Coder>
void CopyCoder<Coder>::AddCandidate(std::uint32_t level, std::uint32_t vertex, std::uint32_t kind, std::uint32_t copy) {
  if (kind_of_[vertex][copy] != kind) level = 0;
  // Higher levels come first, those found first come first among equal ones, and each copy counts once.
  std::size_t at = found_;
  while (at > 0 && candidates_[at - 1].level < level) --at;
  for (std::size_t i = 0; i < at; ++i) {
    if (candidates_[i].copy == copy) return;
  }
  std::size_t end = at;
  while (end < found_ && candidates_[end].copy != copy) ++end;
  for (std::size_t i = end; i > at; --i) candidates_[i] = candidates_[i - 1];
  candidates_[at] = {level, copy};
  if (end == found_) ++found_;
}

template <class Coder>
void CopyCoder<Coder>::AddAcross(std::size_t j, std::size_t k, std::size_t other, const std::vector<Triangle>& copies) {
  const std::uint32_t number = edge_of_[j][other == (k + 1) % 3 ? k : other];
  if (number == kNone || edges_[number].triangle == kNone) return;
  ++across_;
  const Edge& edge = edges_[number];
  const std::uint32_t v = triangles_[j][k];
  const bool is_first = v < triangles_[j][other];
  const Triangle& there = copies[edge.triangle];
  const std::uint32_t at_other = there[is_first ? edge.second : edge.first];
  const std::uint32_t level = other > k ? 3 : copies[j][other] == at_other ? 4 : 1;
  AddCandidate(level, v, kinds_.triangles[j][k], there[is_first ? edge.first : edge.second]);
}

template <class Coder>
void CopyCoder<Coder>::Find(std::size_t j, std::size_t k, const std::vector<Triangle>& copies) {
  const std::uint32_t v = triangles_[j][k], kind = kinds_.triangles[j][k];
  found_ = across_ = 0;
  AddAcross(j, k, (k + 1) % 3, copies);
  AddAcross(j, k, (k + 2) % 3, copies);
  if (last_of_kind_[kind] != kNone) AddCandidate(2, v, kind, last_of_kind_[kind]);
  AddCandidate(2, v, kind, last_[v]);
}

template <class Coder>
bool CopyCoder<Coder>::CodeCorner(Coder& coder, std::size_t j, std::size_t k, std::uint32_t& copy) {
  const std::uint32_t count = counts_[triangles_[j][k]];
  const auto is_split = [&](std::size_t other) { return counts_[triangles_[j][other % 3]] > 1 ? 1u : 0u; };
  const std::uint32_t second = found_ > 1 ? candidates_[1].level : kLevels - 1;
  const std::uint32_t split = is_split(k + 1) + is_split(k + 2), several = count > 1 ? 1 : 0;
  bool hit = copy == candidates_[0].copy;
  coder.Bit(first_[(((candidates_[0].level * kLevels + second) * 2 + several) * 3 + split) * 3 + across_], hit);
  if (hit) {
    copy = candidates_[0].copy;
    return true;
  }
  if (found_ > 1) {
    hit = copy == candidates_[1].copy;
    coder.Bit(second_[second], hit);
    if (hit) {
      copy = candidates_[1].copy;
      return true;
    }
  }
  const auto tried = static_cast<std::uint32_t>(std::min<std::size_t>(found_, 2));
  bool is_new = copy == count;
  if (count > tried) {
    coder.Bit(is_new_, is_new);
  } else {
    is_new = true;
  }
  if (is_new) {
    copy = count;
    return true;
  }
  return CodeOther(coder, count, tried, copy);
}

template <class Coder>
bool CopyCoder<Coder>::CodeOther(Coder& coder, std::uint32_t count, std::uint32_t tried, std::uint32_t& copy) {
  // The copies that were tried, the higher number first; one twice where there was one.
  const std::uint32_t a = candidates_[0].copy, b = candidates_[tried - 1].copy;
  const std::uint32_t high = std::max(a, b), low = std::min(a, b);
  std::uint32_t which = 0;
  if constexpr (!Coder::kDecodes) which = count - 1 - copy - (high > copy ? 1 : 0) - (tried > 1 && low > copy ? 1 : 0);
  if (count - tried > 1) CodeUnsigned(coder, which_, which);
  if (which >= count - tried) return false;
  copy = count - 1 - which;
  if (high >= copy) --copy;
  if (tried > 1 && low >= copy) --copy;
  return true;
}

template <class Coder>
void CopyCoder<Coder>::Remember(std::size_t j) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (edge_of_[j][k] == kNone) continue;
    const std::uint32_t next = (k + 1) % 3;
    const bool ascends = triangles_[j][k] < triangles_[j][next];
    edges_[edge_of_[j][k]] = {static_cast<std::uint32_t>(j), static_cast<std::uint8_t>(ascends ? k : next),
                              static_cast<std::uint8_t>(ascends ? next : k)};
  }
}

template <class Coder>
bool CopyCoder<Coder>::Code(Coder& coder, std::uint64_t most, std::vector<Triangle>& copies) {
  copies.resize(triangles_.size());
  std::uint64_t more = 0;
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangles_[j][k], kind = kinds_.triangles[j][k];
      std::uint32_t& copy = copies[j][k];
      if (counts_[v] == 0) {
        copy = 0;
      } else {
        Find(j, k, copies);
        if (!CodeCorner(coder, j, k, copy) || !coder.ok()) return false;
      }
      if (copy == counts_[v]) {
        if (counts_[v]++ > 0 && ++more > most) return false;
        kind_of_[v].push_back(kind);
      }
      kind_of_[v][copy] = kind;
      last_[v] = last_of_kind_[kind] = copy;
    }
    Remember(j);
  }
  for (std::uint32_t& count : counts_) count = std::max(count, 1u);
  return true;
}

template class CopyCoder<RecordedBins>;
template class CopyCoder<RangeDecoder>;

}  // namespace sac
