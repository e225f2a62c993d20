// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/damage_policy.h"
#include "codec/shape.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// Reads the start of a stream, its sequence header and its I-frame, and holds everything derived from them. Both may be
// repeated in the stream so that it can be entered at the repetition (spec.md 3). Repetitions must have the same bytes.
class StreamStart {
 public:
  // `limits` and `damage` must outlive the object.
  StreamStart(const Limits& limits, const DamagePolicy& damage) : limits_(limits), damage_(damage) {}

  // Checks that the packet after each sequence header is an I-frame and that I-frames stand nowhere else. Call it with
  // the type of each packet before the packet is taken.
  Status CheckOrder(PacketType type);
  // Takes the payload of a sequence header. kCorrupt, kUnsupported or kLimit.
  Status TakeHeader(std::span<const std::uint8_t> payload);
  // Takes the payload of an I-frame. `is_new` says whether the mesh was decoded from it; it is false for a repetition.
  // Returns kCorrupt, kUnsupported or kLimit.
  Status TakeIFrame(std::span<const std::uint8_t> payload, bool& is_new);
  // Prepares for reading on at another place of the same stream.
  void Restart() { follows_header_ = is_foreign_ = false; }

  // The header and the mesh, once they have been read.
  const std::optional<SequenceHeader>& header() const { return header_; }
  const StreamInfo& info() const { return info_; }
  const std::optional<Mesh>& mesh() const { return mesh_; }
  // Per vertex its index in the input; empty when the stream does not keep the order.
  const std::vector<std::uint32_t>& order() const { return order_; }
  Shape& shape() { return shape_; }
  const Shape& shape() const { return shape_; }
  // Whether the header of another stream has come, so that packets are passed over.
  bool is_foreign() const { return is_foreign_; }

 private:
  Status DecodeIFrame(std::span<const std::uint8_t> payload);

  const Limits& limits_;
  const DamagePolicy& damage_;
  std::optional<SequenceHeader> header_;
  std::vector<std::uint8_t> header_bytes_;
  StreamInfo info_;
  std::optional<Mesh> mesh_;
  std::vector<std::uint32_t> order_;
  Shape shape_;
  std::uint32_t i_frame_crc_ = 0;
  std::size_t i_frame_size_ = 0;
  bool follows_header_ = false;  // the packet before was the sequence header
  bool is_foreign_ = false;
};

}  // namespace sac
