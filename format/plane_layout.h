// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/sequence_header.h"

namespace sac {

// One row of a plane: harmonic number `k`, by ascending eigenvalue, of the component or patch `component`.
struct HarmonicIndex {
  std::uint32_t component;
  std::uint32_t k;
};

// The order of a plane's rows: by k / counts[component], then by component (spec.md 6.3). `counts` holds the number of
// harmonics of each component. Only integers decide, so that the meaning of a bit never depends on a float.
std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts);

// The class of harmonic number `k` for the contexts, 1..23, in half octaves of k + 1 (spec.md 7.4).
std::uint8_t HarmonicClass(std::uint32_t k);

// The planes of a frame, in the order of the bitstream (spec.md 6.2).
enum Plane : std::size_t {
  kMotion,        // rotation and stretch, in harmonics
  kDisplacement,  // what motion left, smooth, in harmonics
  kDetail,        // what both left, in patch harmonics
  kCorrection,    // what is over the bound, vertex by vertex
};
inline constexpr std::size_t kPlanes = 4;
inline constexpr std::array<const char*, kPlanes> kPlaneNames = {"motion", "displacement", "detail", "correction"};

// The shape of a plane, rows x channels, and the class of each row for the contexts. A plane's coefficients are stored
// row by row.
struct PlaneLayout {
  std::size_t channels = 0;
  std::vector<std::uint8_t> row_classes;  // of each row, 1..23; no rows when the stream has no such plane

  std::size_t size() const { return channels * row_classes.size(); }
};
using PlaneLayouts = std::array<PlaneLayout, kPlanes>;

// Lays out the planes of a stream. `harmonics` holds the number of harmonics of each component, `patches` the number of
// vertices of each patch.
PlaneLayouts LayOutPlanes(const SequenceHeader& header, std::span<const std::uint32_t> harmonics,
                          std::span<const std::uint32_t> patches);

// The number of coefficients of one frame, over all planes.
std::uint64_t FrameValues(const PlaneLayouts& layouts);

// The coefficients of a plane in the order of its PlaneLayout.
using PlaneValues = std::vector<std::int32_t>;
using FramePlanes = std::array<PlaneValues, kPlanes>;

// Planes whose coefficients are all zero.
FramePlanes EmptyPlanes(const PlaneLayouts& layouts);

}  // namespace sac
