// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "format/frame_syntax.h"
#include "format/group.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/clip.h"
#include "sac/encoder.h"
#include "sac/mesh.h"

namespace sac {

using Bytes = std::vector<std::uint8_t>;

// The parts of a stream, which can be changed one by one and put together again. All failures end the program, since
// the vectors are made from known input.
struct StreamParts {
  SequenceHeader header;
  IFrameSyntax i_frame;
  std::vector<Bytes> groups;       // payloads of the whole groups
  std::vector<Bytes> open_groups;  // packets and records of the open groups, which follow the whole ones
  std::uint32_t frames = 0;        // number of frames in the end packet
  PlaneLayouts layouts;            // see Derive()

  Bytes Join() const;
};

Bytes Encode(const Clip& clip, const EncoderSettings& settings);
StreamParts Split(const Bytes& stream);

// Computes the members that depend on the header and the I-frame: the fingerprint, and the layouts that CodeGroup()
// needs.
void Derive(StreamParts& parts);

// The bytes that a stream begins with, and a packet put after `stream`.
Bytes Magic();
void AppendPacket(Bytes& stream, PacketType type, const Bytes& payload);

// Codes a group. `fill` makes each frame: it gets the frame's number in coding order, and the frame with the slot of
// the group structure and zeros. Coding stops after a frame that the format does not allow, which is still in the code.
Bytes CodeGroup(const StreamParts& parts, std::uint32_t frames, std::uint32_t pyramid,
                const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame = 0);

// The same of a layered group: the payloads of its own packet and of its layers. `base_levels`: as of GroupSyntax.
std::vector<Bytes> CodeLayeredGroup(const StreamParts& parts, const GroupSyntax& group,
                                    const std::function<void(std::uint32_t, FrameSyntax&)>& fill);

// Codes the packet of an open group and its records.
Bytes CodeOpenGroup(const StreamParts& parts, std::uint32_t frames,
                    const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame = 0);

// Fills a frame with random residuals that no encoder would choose: of any magnitude, with any references, or with
// `references` if that is not null. `index` is its number in coding order.
void FillAtRandom(std::mt19937& random, const References* references, std::uint32_t index, FrameSyntax& frame);

// The stream of spec.md, appendix A: four vertices and two triangles, coded without Draco, and three frames.
StreamParts SmallStream();

}  // namespace sac
