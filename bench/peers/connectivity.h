// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/peers/peer.h"
#include "format/bytes.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac::bench {

// The triangles of a clip by Draco's edgebreaker, for peers that code nothing but positions: one to two bits a vertex,
// as sac's own. Vertices come in Draco's order; those that no triangle uses, which Draco has none of, follow.
struct Connectivity {
  std::vector<Triangle> triangles;
  std::size_t vertices = 0;          // decoded
  std::vector<std::uint32_t> order;  // of the input; empty in a decoder
};

Status WriteConnectivity(const Clip& clip, ByteWriter& out, Connectivity& connectivity);
Status ReadConnectivity(ByteReader& in, Connectivity& connectivity);

// A mesh by Draco with the positions as float32, quantized to `bits` of their own extent, or as int32 when `bits` is 0.
Status EncodeWithDraco(std::span<const Triangle> triangles, const Positions& positions, int bits,
                       std::vector<std::uint8_t>& bytes);
Status DecodeWithDraco(std::span<const std::uint8_t> bytes, std::vector<Triangle>& triangles, Positions& positions);

// The input's vertices in the order in which Draco decodes a mesh of these triangles. Draco codes a non-manifold vertex
// several times, and leaves out what no triangle uses.
Status OrderOfDraco(std::span<const Triangle> triangles, std::size_t vertices, std::vector<std::uint32_t>& order);

}  // namespace sac::bench
