// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/damage_policy.h"
#include "codec/shape.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// Reads the starts of a stream, each a sequence header and an I-frame, and holds what follows from the one that frames
// are decoded with. A start may be repeated so that the stream can be entered there; one with other bytes begins a
// segment (spec.md 3). The mesh of the first is there at once. Its basis, and all of a later one, is computed when it
// is asked for or needed, so that the still comes early and the mesh stays until the last frame before is given out.
class StreamStart {
 public:
  // `limits` and `damage` must outlive the object.
  StreamStart(const Limits& limits, const DamagePolicy& damage) : limits_(limits), damage_(damage) {}

  // Checks that the packet after each sequence header is an I-frame, that I-frames stand nowhere else, and that the
  // first packet is a sequence header. Call it with the type of each packet before the packet is taken.
  Status CheckOrder(PacketType type);
  // Takes the payload of a sequence header. kCorrupt, kUnsupported or kLimit.
  Status TakeHeader(std::span<const std::uint8_t> payload);
  // Takes the payload of an I-frame. `opens_stream` says that nothing came before this start. Returns kCorrupt,
  // kUnsupported or kLimit.
  Status TakeIFrame(std::span<const std::uint8_t> payload, bool opens_stream);
  // Checks that the start which came last is that of segment `number`, to which a group belongs.
  Status CheckSegment(std::uint32_t number);
  // Whether shape() is that of the start which came last.
  bool IsReady() const { return is_ready_ && !next_; }
  // Computes all that follows from the start which came last. After a failure of another than the first, frames can
  // be decoded again from the next start on.
  Status Prepare();
  // Prepares for reading on at another place of the same stream.
  void Restart();

  // The header and the mesh, once they have been read.
  const std::optional<SequenceHeader>& header() const { return header_; }
  const StreamInfo& info() const { return info_; }
  const std::optional<Mesh>& mesh() const { return mesh_; }
  // Whether a start has come that replaces mesh() with the next group.
  bool MeshEnds() const { return next_.has_value(); }
  // The number of the segment that mesh() is of; none where it is not known.
  std::optional<std::uint32_t> segment() const { return segment_; }
  // Per vertex its index in the input; empty when the stream does not keep the order.
  const std::vector<std::uint32_t>& order() const { return order_; }
  Shape& shape() { return shape_; }
  const Shape& shape() const { return shape_; }

 private:
  // The bytes of a start.
  struct Bytes {
    std::vector<std::uint8_t> header;
    std::size_t i_frame_size = 0;
    std::uint32_t i_frame_crc = 0;
    bool operator==(const Bytes&) const = default;
  };
  // A start that waits for its first group.
  struct Next {
    Bytes bytes;
    SequenceHeader header;
    std::vector<std::uint8_t> i_frame;
    std::optional<std::uint32_t> segment;  // once its first group has come
  };

  // Decodes the mesh of an I-frame.
  Status DecodeMesh(const SequenceHeader& header, std::span<const std::uint8_t> payload);
  // Computes the basis of the mesh.
  Status ComputeBasis();
  // Makes the start that waits the one that frames are decoded with.
  Status Replace();

  const Limits& limits_;
  const DamagePolicy& damage_;
  std::optional<SequenceHeader> header_;
  Bytes bytes_;  // of header_ and mesh_
  StreamInfo info_;
  std::optional<Mesh> mesh_;
  std::vector<std::uint32_t> order_;
  IFrameSyntax syntax_;  // what ComputeBasis() needs of the I-frame
  DecodedMesh decoded_;  // likewise
  Shape shape_;
  bool is_ready_ = false;  // shape_ is mesh_'s
  std::optional<std::uint32_t> segment_;
  std::optional<Next> next_;
  SequenceHeader last_header_;  // the one that the I-frame to come belongs to
  std::vector<std::uint8_t> last_header_bytes_;
  bool follows_header_ = false;  // the packet before was the sequence header
  bool is_orphan_ = false;       // this packet is an I-frame, and it was not
  bool is_used_ = false;         // a group of mesh_ has come
  // Whether the next segment has the number after segment_'s: not so after a seek, or where damage was passed over.
  bool counts_ = true;
  Status failure_;  // of computing the basis of mesh_
};

}  // namespace sac
