// SPDX-License-Identifier: Apache-2.0
#include "codec/patches.h"

#include <algorithm>
#include <tuple>

namespace sac {
namespace {

class Cutter {
 public:
  Cutter(std::span<const GridPosition> grid, const VertexGraph& graph, std::uint32_t size)
      : grid_(grid), graph_(graph), size_(size) {}

  void Cut(std::span<std::uint32_t> part) {
    if (part.size() <= size_) {
      AddPieces(part);
      return;
    }
    GridPosition low = grid_[part[0]], high = low;
    for (const std::uint32_t v : part) {
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], grid_[v][a]);
        high[a] = std::max(high[a], grid_[v][a]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
    }
    const std::size_t half = part.size() / 2;
    std::nth_element(
        part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
        [&](std::uint32_t a, std::uint32_t b) { return std::tie(grid_[a][axis], a) < std::tie(grid_[b][axis], b); });
    Cut(part.first(half));
    Cut(part.subspan(half));
  }

  PatchOrder order;

 private:
  // Adds each connected piece of `part` as a patch. Pieces are ordered by their smallest vertex, and the vertices of a
  // piece ascend.
  void AddPieces(std::span<std::uint32_t> part) {
    std::sort(part.begin(), part.end());
    std::vector<bool> done(part.size(), false);
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (done[i]) continue;
      done[i] = true;
      std::vector<std::uint32_t> piece = {part[i]};
      for (std::size_t next = 0; next < piece.size(); ++next) {
        for (std::uint32_t e = graph_.offsets[piece[next]]; e < graph_.offsets[piece[next] + 1]; ++e) {
          const auto at = std::lower_bound(part.begin(), part.end(), graph_.neighbours[e]);
          if (at == part.end() || *at != graph_.neighbours[e]) continue;
          const auto j = static_cast<std::size_t>(at - part.begin());
          if (done[j]) continue;
          done[j] = true;
          piece.push_back(*at);
        }
      }
      std::sort(piece.begin(), piece.end());
      order.vertices.insert(order.vertices.end(), piece.begin(), piece.end());
      order.sizes.push_back(static_cast<std::uint32_t>(piece.size()));
    }
  }

  std::span<const GridPosition> grid_;
  const VertexGraph& graph_;
  std::uint32_t size_;
};

}  // namespace

PatchOrder CutIntoPatches(std::span<const GridPosition> grid, const VertexGraph& graph,
                          std::vector<std::uint32_t> component, std::uint32_t size) {
  Cutter cutter(grid, graph, size);
  cutter.Cut(component);
  return std::move(cutter.order);
}

}  // namespace sac
