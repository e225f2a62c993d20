// SPDX-License-Identifier: Apache-2.0
#include "format/plane_layout.h"

#include <algorithm>

#include "format/logistic.h"

namespace sac {
namespace {

std::vector<std::uint8_t> RowClasses(std::span<const std::uint32_t> counts) {
  std::vector<std::uint8_t> classes;
  for (const HarmonicIndex& index : HarmonicOrder(counts)) classes.push_back(HarmonicClass(index.k));
  return classes;
}

}  // namespace

std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts) {
  std::vector<HarmonicIndex> order;
  for (std::uint32_t c = 0; c < counts.size(); ++c) {
    for (std::uint32_t k = 0; k < counts[c]; ++k) order.push_back({c, k});
  }
  std::stable_sort(order.begin(), order.end(), [&](const HarmonicIndex& a, const HarmonicIndex& b) {
    return static_cast<std::uint64_t>(a.k) * counts[b.component] <
           static_cast<std::uint64_t>(b.k) * counts[a.component];
  });
  return order;
}

std::uint8_t HarmonicClass(std::uint32_t k) {
  return static_cast<std::uint8_t>(std::min<std::uint32_t>(HalfOctave(k + 1), 23));
}

PlaneLayouts LayOutPlanes(const SequenceHeader& header, std::span<const std::uint32_t> harmonics,
                          std::span<const std::uint32_t> patches) {
  PlaneLayouts layouts;
  layouts[kMotion] = {9, RowClasses(harmonics)};
  layouts[kDisplacement] = {3, layouts[kMotion].row_classes};
  layouts[kDetail].channels = 3;
  layouts[kCorrection].channels = 3;
  if (header.detail_step > 0) layouts[kDetail].row_classes = RowClasses(patches);
  if (header.correction_step > 0) layouts[kCorrection].row_classes.assign(header.vertices, HarmonicClass(0));
  return layouts;
}

std::uint64_t FrameValues(const PlaneLayouts& layouts) {
  std::uint64_t values = 0;
  for (const PlaneLayout& layout : layouts) values += layout.size();
  return values;
}

FramePlanes EmptyPlanes(const PlaneLayouts& layouts) {
  FramePlanes planes;
  for (std::size_t p = 0; p < kPlanes; ++p) planes[p].assign(layouts[p].size(), 0);
  return planes;
}

}  // namespace sac
