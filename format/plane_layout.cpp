// SPDX-License-Identifier: Apache-2.0
#include "format/plane_layout.h"

#include "format/harmonic_order.h"

namespace sac {
namespace {

std::vector<std::uint8_t> RowClasses(std::span<const std::uint32_t> counts) {
  std::vector<std::uint8_t> classes;
  for (const HarmonicIndex& index : HarmonicOrder(counts)) classes.push_back(HarmonicClass(index.k));
  return classes;
}

}  // namespace

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
