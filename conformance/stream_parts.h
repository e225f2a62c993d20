// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "format/frame_syntax.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/clip.h"
#include "sac/encoder.h"
#include "sac/mesh.h"

namespace sac {

using Bytes = std::vector<std::uint8_t>;

// The pieces of a stream, to be changed one by one and put together again. All failures end the program: the vectors
// are made of known input.
struct StreamParts {
  SequenceHeader header;
  IFrameSyntax i_frame;
  std::vector<Bytes> groups;       // payloads
  std::vector<Bytes> open_groups;  // after the others; packets and records
  std::uint32_t frames = 0;        // that the end packet says
  PlaneLayouts layouts;            // see Derive()

  Bytes Join() const;
};

Bytes Encode(const Clip& clip, const EncoderSettings& settings);
StreamParts Split(const Bytes& stream);

// Fills in what follows from the header and the I-frame: the fingerprint, and the layouts that CodeGroup() needs.
void Derive(StreamParts& parts);

// The first packets of a stream, and what may follow them.
Bytes Magic();
void AppendPacket(Bytes& stream, PacketType type, const Bytes& payload);

// Codes a group whose frames `fill` makes: it is given each frame's number in coding order, with the structure's slot
// and zeros in it. Stops after a frame that the format does not allow, which is then in the code all the same.
Bytes CodeGroup(const StreamParts& parts, std::uint32_t frames, std::uint32_t pyramid,
                const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame = 0);

// The packet of an open group and its records.
Bytes CodeOpenGroup(const StreamParts& parts, std::uint32_t frames,
                    const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame = 0);

// Four vertices and two triangles without Draco's help, and three frames: the stream of spec.md, appendix A.
StreamParts SmallStream();

}  // namespace sac
