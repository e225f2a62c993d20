// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/stream_input.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/status.h"

namespace sac {

struct PacketSummary {
  PacketType type;
  std::uint64_t bytes;       // with framing
  std::uint32_t frames = 0;  // of a group
  bool low_delay = false;    // a group whose frames are sent one by one
};

struct IFrameSummary {
  std::size_t components = 0;
  bool texture_coordinates = false, normals = false, colors = false;
  bool order = false;  // the stream keeps the order of the input's vertices
};

// What can be told of a stream without computing its harmonics and frames.
struct StreamSummary {
  std::uint64_t bytes = 0;  // looked at
  std::optional<SequenceHeader> header;
  std::optional<IFrameSummary> i_frame;
  std::vector<PacketSummary> packets;
  std::uint64_t frames = 0;
  bool ended = false;
  bool has_index = false;  // of its groups
};

// Reads packets to the end of `input`. When the stream is damaged or truncated, `summary` holds what comes before.
Status Summarize(StreamInput& input, StreamSummary& summary);

const char* NameOf(PacketType type);

}  // namespace sac
