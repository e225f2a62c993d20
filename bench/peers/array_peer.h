// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/peers/peer.h"
#include "format/bytes.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac::bench {

// A peer that codes only positions, as an array of frames by vertices. The triangles are coded before them by Draco
// (connectivity.h).
struct ArrayPeer {
  std::string title, version;
  std::string parameter;              // the meaning of a setting, which is a number
  std::vector<std::string> settings;  // from the smallest streams to the most exact
  Status (*encode)(const std::vector<Positions>& frames, double setting, ByteWriter& out);
  // Fills `frames`, which already have the right number and sizes.
  Status (*decode)(ByteReader& in, std::vector<Positions>& frames);
};

// Runs `peer` as a program: the whole of main().
int RunArrayPeer(int argc, char** argv, const ArrayPeer& peer);

}  // namespace sac::bench
