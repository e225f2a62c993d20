#include "format/plane_layout.h"

#include "format/harmonic_order.h"

namespace sac {
namespace {

std::vector<std::uint8_t> Bands(std::span<const std::uint32_t> counts, int octaves_per_band) {
  std::vector<std::uint8_t> bands;
  for (const HarmonicIndex& index : HarmonicOrder(counts)) bands.push_back(HarmonicBand(index.k, octaves_per_band));
  return bands;
}

}  // namespace

PlaneLayouts LayOutPlanes(const SequenceHeader& header, std::span<const std::uint32_t> harmonics,
                          std::span<const std::uint32_t> patches) {
  PlaneLayouts layouts;
  layouts[kMotion] = {9, Bands(harmonics, 2)};
  layouts[kDisplacement] = {3, layouts[kMotion].bands};
  layouts[kDetail].channels = 3;
  layouts[kCorrection].channels = 3;
  if (header.detail_step > 0) layouts[kDetail].bands = Bands(patches, 1);
  if (header.correction_step > 0) layouts[kCorrection].bands.assign(header.vertices, 0);
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
