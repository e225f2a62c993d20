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

// The triangles of a clip, coded by Draco's edgebreaker for peers that code only positions. They take one to two bits
// per vertex, as in sac's own streams. The decoded vertices come in Draco's order, followed by the vertices that no
// triangle uses, which Draco does not code.
struct Connectivity {
  std::vector<Triangle> triangles;
  std::size_t vertices = 0;          // number of decoded vertices
  std::vector<std::uint32_t> order;  // the input's vertex for each decoded one; empty in a decoder
};

Status WriteConnectivity(const Clip& clip, ByteWriter& out, Connectivity& connectivity);
Status ReadConnectivity(ByteReader& in, Connectivity& connectivity);

// Codes a mesh with Draco. The positions are quantized to `bits` bits of their extent, or coded as int32 when `bits` is
// 0.
Status EncodeWithDraco(std::span<const Triangle> triangles, const Positions& positions, int bits,
                       std::vector<std::uint8_t>& bytes);
Status DecodeWithDraco(std::span<const std::uint8_t> bytes, std::vector<Triangle>& triangles, Positions& positions);

// Gives the input's vertices in the order in which Draco decodes a mesh of these triangles. Draco codes a non-manifold
// vertex several times and leaves out vertices that no triangle uses.
Status OrderOfDraco(std::span<const Triangle> triangles, std::size_t vertices, std::vector<std::uint32_t>& order);

}  // namespace sac::bench
