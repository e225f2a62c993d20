// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sac/clip.h"
#include "sac/status.h"

namespace sac::bench {

// What an encoder makes of it. All that the decoder gets is `bytes`.
struct PeerStream {
  std::vector<std::uint8_t> bytes;
  // Only for measuring: the input's vertex that each decoded one stands for. Several may stand for one.
  std::vector<std::uint32_t> order;
};

// Another codec, as a program for `sac sweep --peers` (bench/sweep/sweep_codec.h says how it is called).
struct Peer {
  std::string title, version;
  std::string parameter;              // what a setting is, in a word or two; may be empty
  std::vector<std::string> settings;  // from small to near
  // A clip has at least one frame; its triangles and frames are all that is coded.
  std::function<Status(const Clip& clip, const std::string& setting, PeerStream& stream)> encode;
  std::function<Status(std::span<const std::uint8_t> bytes, Clip& clip)> decode;
  std::string missing = {};  // why it cannot be run; empty when it can
  // What was measured of the work done, as JSON for --report; most peers have none.
  std::function<std::string()> report = {};
};

// The body of main: describe, encode or decode; after the latter two words may follow `--report FILE`.
int RunPeer(int argc, char** argv, const Peer& peer);

// A setting that is a number. False, and `value` left alone, when it is none.
bool ParseNumber(const std::string& text, double& value);

}  // namespace sac::bench
