// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sac/metadata.h"
#include "sac/status.h"

namespace sac {

// Returns the payload of a metadata packet (spec.md 3.3): the entries that `metadata` has.
std::vector<std::uint8_t> WriteMetadata(const Metadata& metadata);

// Parses the payload of a metadata packet and replaces those parts of `metadata` that it has. Entries of other kinds
// are passed over. Returns kCorrupt, and `metadata` stays as it was, when the payload is malformed: readers then do
// without it, because nothing in it influences decoding.
Status ParseMetadata(std::span<const std::uint8_t> payload, Metadata& metadata);

// The box `box` in 1/255 of `bounds`, rounded outwards: low, then high.
std::array<std::uint8_t, 6> InBounds(const Box& box, const Box& bounds);

}  // namespace sac
