#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/sequence_header.h"

namespace sac {

// The planes of a frame, in the order of the bitstream (spec.md 6.2).
enum Plane : std::size_t {
  kMotion,        // rotation and stretch, in harmonics
  kDisplacement,  // what motion left, smooth, in harmonics
  kDetail,        // what both left, in patch harmonics
  kCorrection,    // what is over the bound, vertex by vertex
};
inline constexpr std::size_t kPlanes = 4;
inline constexpr std::array<const char*, kPlanes> kPlaneNames = {"motion", "displacement", "detail", "correction"};

// The size of a plane, and what contexts know of its rows. A plane's coefficients are stored row by row.
struct PlaneLayout {
  std::size_t channels = 0;
  std::vector<std::uint8_t> row_classes;  // of each row, 1..23; no rows when the stream has no such plane

  std::size_t size() const { return channels * row_classes.size(); }
};
using PlaneLayouts = std::array<PlaneLayout, kPlanes>;

// From the header, the harmonics of each component and the vertices of each patch.
PlaneLayouts LayOutPlanes(const SequenceHeader& header, std::span<const std::uint32_t> harmonics,
                          std::span<const std::uint32_t> patches);

// Coefficients of one frame, all planes together.
std::uint64_t FrameValues(const PlaneLayouts& layouts);

// Coefficients of a plane, as PlaneLayout orders them.
using PlaneValues = std::vector<std::int32_t>;
using FramePlanes = std::array<PlaneValues, kPlanes>;

// All zero.
FramePlanes EmptyPlanes(const PlaneLayouts& layouts);

}  // namespace sac
