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

// A clip as an encoder coded it. The decoder gets `bytes` and nothing else.
struct PeerStream {
  std::vector<std::uint8_t> bytes;
  // The input's vertex that each decoded vertex stands for, only for measuring. Several may stand for the same one.
  std::vector<std::uint32_t> order;
};

// Another codec, as a program for `sac sweep --peers` (bench/sweep/sweep_codec.h says how it is called).
struct Peer {
  std::string title, version;
  std::string parameter;              // the meaning of a setting, in a word or two; may be empty
  std::vector<std::string> settings;  // from the smallest streams to the most exact
  // Encodes the triangles and the frames of a clip, which has at least one frame.
  std::function<Status(const Clip& clip, const std::string& setting, PeerStream& stream)> encode;
  std::function<Status(std::span<const std::uint8_t> bytes, Clip& clip)> decode;
  std::string missing = {};  // why the codec cannot be run; empty when it can
  // The measurements of the last encoding or decoding, as JSON for --report. Most peers have none.
  std::function<std::string()> report = {};
};

// Runs `peer` as a program, the whole of main(). The first argument is `describe`, `encode` or `decode`; `--report
// FILE` may follow the arguments of the latter two.
int RunPeer(int argc, char** argv, const Peer& peer);

// Parses a setting that is a number. Returns false, and leaves `value` as it is, when `text` is none.
bool ParseNumber(const std::string& text, double& value);

}  // namespace sac::bench
