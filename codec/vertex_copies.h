// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "format/integer_coder.h"
#include "format/range_coder.h"
#include "format/recorded_bins.h"
#include "sac/mesh.h"

namespace sac {

// Corners that look alike: `triangles` has a number for each corner, and two corners of one vertex have the same if
// they have the same values of all attributes. Numbers of different vertices differ.
struct CornerKinds {
  std::vector<Triangle> triangles;
  std::uint32_t count = 0;
};

// The kinds of the corners of `triangles`. Each of `attributes` has the index of the value at each corner of the first
// of them, or is empty. Corners of the others are like the first that their vertex has among those.
CornerKinds KindsOfCorners(const std::vector<Triangle>& triangles, std::size_t first,
                           std::initializer_list<const std::vector<Triangle>*> attributes, std::uint32_t vertices);

// Writes or reads which copy of its vertex each corner has (spec.md 5.6). Encoder and decoder instantiate the same
// body.
template <class Coder>
class CopyCoder {
 public:
  // `triangles`: of `vertices` vertices, which have `kinds`. Both must outlive the object.
  CopyCoder(std::uint32_t vertices, const std::vector<Triangle>& triangles, const CornerKinds& kinds);

  // Codes the copies of all corners: writes `copies`, whose numbers count from 0 for each vertex in the order of first
  // corners, or reads it. Returns false when the code is malformed or there are more than `most` copies beside the
  // first of each vertex.
  bool Code(Coder& coder, std::uint64_t most, std::vector<Triangle>& copies);

  // The number of copies of each vertex; one of a vertex without corners.
  const std::vector<std::uint32_t>& counts() const { return counts_; }

 private:
  // A copy that a corner may have. `level` says how much there is to say for it, 0 to 4.
  struct Candidate {
    std::uint32_t level, copy;
  };
  static constexpr std::uint32_t kNone = 0xffffffffu, kLevels = 6;

  // The triangle that had an edge last.
  struct Edge {
    std::uint32_t triangle = kNone;
    std::uint8_t first, second;  // its corners there; the first is the edge's lower vertex
  };

  // Finds the candidates for corner `k` of triangle `j`, the likeliest first. Corners before it have their copies.
  void Find(std::size_t j, std::size_t k, const std::vector<Triangle>& copies);
  // Adds the copy that the last triangle across the edge from corner `k` to corner `other` has.
  void AddAcross(std::size_t j, std::size_t k, std::size_t other, const std::vector<Triangle>& copies);
  void AddCandidate(std::uint32_t level, std::uint32_t vertex, std::uint32_t kind, std::uint32_t copy);
  // Codes the copy of a corner that is not the first of its vertex.
  bool CodeCorner(Coder& coder, std::size_t j, std::size_t k, std::uint32_t& copy);
  // Codes which of `count` copies it is beside the first `tried` candidates.
  bool CodeOther(Coder& coder, std::uint32_t count, std::uint32_t tried, std::uint32_t& copy);
  // Notes that triangle `j` has its edges.
  void Remember(std::size_t j);

  const std::vector<Triangle>& triangles_;
  const CornerKinds& kinds_;
  std::vector<Triangle> edge_of_;  // of each triangle; edge k is between corners k and k + 1
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> counts_, last_;         // of each vertex: its copies, and that of its last corner
  std::vector<std::uint32_t> last_of_kind_;          // likewise of each kind
  std::vector<std::vector<std::uint32_t>> kind_of_;  // of each copy of each vertex: the kind of its last corner
  std::array<Candidate, 4> candidates_;
  std::size_t found_ = 0;
  std::uint32_t across_ = 0;  // edges of the corner that an earlier triangle has

  // By the levels of the two best candidates, whether there are several copies, how many of the triangle's other
  // corners have vertices of several, and across_.
  std::array<BitModel, kLevels * kLevels * 2 * 3 * 3> first_;
  std::array<BitModel, kLevels> second_;  // by the level of the second
  BitModel is_new_;
  UnsignedModels which_;
};

extern template class CopyCoder<RecordedBins>;
extern template class CopyCoder<RangeDecoder>;

}  // namespace sac
