// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/peers/peer.h"
#include "format/bytes.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac::bench {

// A peer that codes nothing but positions, as an array of frames by vertices. Triangles go before them
// (connectivity.h).
struct ArrayPeer {
  std::string title, version;
  std::string parameter;              // what a setting, a number, is
  std::vector<std::string> settings;  // from small to near
  Status (*encode)(const std::vector<Positions>& frames, double setting, ByteWriter& out);
  // Fills `frames`, which have their number and sizes.
  Status (*decode)(ByteReader& in, std::vector<Positions>& frames);
};

// The body of main.
int RunArrayPeer(int argc, char** argv, const ArrayPeer& peer);

}  // namespace sac::bench
