// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "files/stream_input.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/metadata.h"
#include "sac/status.h"

namespace sac {

struct PacketSummary {
  PacketType type;
  std::uint64_t bytes;       // with framing
  std::uint32_t frames = 0;  // of a group
  bool low_delay = false;    // a group whose frames are sent one by one
  std::uint32_t layers = 0;  // of a group, its own packet counted; 0: it is not layered
  std::uint32_t segment = 0;
};

struct IFrameSummary {
  std::size_t components = 0;
  bool texture_coordinates = false, normals = false, colors = false;
  bool order = false;  // the stream keeps the order of the input's vertices
};

// What can be told of a stream without computing its harmonics and frames.
struct StreamSummary {
  std::uint64_t bytes = 0;               // looked at
  std::optional<SequenceHeader> header;  // this and the I-frame are those of the first segment
  std::optional<IFrameSummary> i_frame;
  std::vector<PacketSummary> packets;
  std::uint64_t frames = 0;
  std::uint32_t segments = 0;  // 0 before the first group
  Metadata metadata;
  bool ended = false;
  bool has_index = false;  // of its groups
};

// Reads packets to the end of `input`. When the stream is damaged or truncated, `summary` holds what comes before.
Status Summarize(StreamInput& input, StreamSummary& summary);

const char* NameOf(PacketType type);

}  // namespace sac
