// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/damage_policy.h"
#include "codec/decode/group_sequence.h"
#include "codec/decode/handle_output.h"
#include "codec/decode/packet_source.h"
#include "codec/decode/seek_table.h"
#include "codec/decode/stream_start.h"
#include "codec/decode/vertex_buffer.h"
#include "format/packet.h"
#include "geometry/normals.h"
#include "sac/decoder.h"
#include "sac/status.h"

namespace sac {

// Decodes one stream. The functions are those of Decoder, which says what they do; they may throw std::bad_alloc, after
// which Latch() has to be called. A byte takes this way: PacketSource finds packets, Take() hands each to StreamStart
// or to GroupSequence, Receive() asks the latter for frames.
class StreamDecoder {
 public:
  // `settings` must outlive the object. Allocates nothing.
  explicit StreamDecoder(const DecoderSettings& settings);

  Status Send(std::span<const std::uint8_t>& bytes);
  // Decodes into `positions`, and copies from there into `buffers` unless that is null. A frame is taken only after the
  // buffers have been checked.
  Status Receive(Positions& positions, FrameInfo& info, const FrameBuffers* buffers);
  Status ReceiveHandles(std::span<float> matrices, FrameInfo& info, bool& exact);
  Status Finish();

  Status Seek(std::uint32_t frame, std::uint64_t& byte);
  Status SeekTime(double seconds, std::uint64_t& byte);
  Status AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed);
  Status Interpolate(double time, Positions& positions, FrameInfo& info, const FrameBuffers* buffers);
  Status InterpolateHandles(double time, std::span<float> matrices, FrameInfo& info, bool& exact);
  Status Weights(BlendWeights& weights);

  // Makes an error final: later calls return it until a seek.
  Status Latch(Status status) {
    if (!status.ok()) error_ = status;
    return status;
  }

  // Computes what frames need beside the mesh. The basis of the mesh that is there; not that of the next segment.
  Status Prepare();
  // Goes on without layers of a group that have not come.
  Status Flush();

  const StreamStart& start() const { return start_; }
  const std::optional<Metadata>& metadata() const { return metadata_; }
  std::optional<std::uint32_t> total_frames() const { return total_frames_; }
  // The most layers that a group so far may have, 0 before the first.
  std::uint32_t layers() const { return groups_ ? groups_->position().layers : position_.layers; }
  const LostFrames& lost() const { return damage_.lost(); }

 private:
  // Reads a packet or a record of an open group, from the front of `bytes` or from the bytes to be read again.
  Status Advance(std::span<const std::uint8_t>& bytes);
  // Whether more can be read without more bytes. After Finish() it also takes the frames of a packet that the end of
  // the bytes cuts off.
  bool CanAdvance();
  // Reads on without more bytes, unless frames wait.
  Status AdvanceAlone();

  // Takes a packet that begins at byte `begin` of the stream.
  Status Take(const Packet& packet, std::uint64_t begin);
  Status TakeStart(const Packet& packet, std::uint64_t begin);
  void TakeSkippable(const Packet& packet);
  // Takes the whole frames of a group packet that the end of the bytes cuts off.
  void TakeCutPacket(std::span<const std::uint8_t> packet);
  Status TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin);
  Status TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin);
  Status ParseAndCheckEnd(std::span<const std::uint8_t> payload, std::uint64_t begin, std::uint32_t& frames);

  bool FrameWaits() const { return groups_ && groups_->HasFrame(); }
  Status Check(const FrameBuffers* buffers) const {
    return buffers && start_.mesh() ? CheckBuffers(*buffers, start_.mesh()->positions.size()) : Status::Ok();
  }
  // Makes groups_ the sequence of the start that came last, whose basis it computes if need be.
  Status PrepareGroups();
  Status BeyondTheEnd(double time) const;
  // Reads on until the frames before and after `time` are held. At the end of a segment, where the frame after has
  // another mesh, `time` becomes that of the frame before.
  Status ReadAround(double& time);
  // Gives the next frame that is to be shown, once `check` passes for the mesh that it moves.
  template <class CheckOutput>
  Status Next(const CheckOutput& check, FrameOutput& output, std::uint32_t& frame);
  // Gives the shape at `time`, which becomes that of the shape.
  template <class CheckOutput>
  Status At(double& time, const CheckOutput& check, FrameOutput& output);
  // Checks that `matrices` has room for those of the mesh's handles, if the mesh is there.
  Status CheckHandles(std::span<float> matrices);
  void Describe(std::uint32_t frame, double time, FrameInfo& info) const;
  void GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
               const FrameBuffers* buffers);

  const DecoderSettings& settings_;
  DamagePolicy damage_;
  PacketSource packets_;
  StreamStart start_;
  std::optional<GroupSequence> groups_;  // of the last start whose basis is there
  GroupSequence::Position position_;     // while there is none
  std::uint64_t start_begin_ = 0;        // byte of the last sequence header
  struct HeldPacket {
    Packet packet;
    std::uint64_t begin;
  };
  std::optional<HeldPacket> held_packet_;  // came while a group waited for layers; to be taken after its frames
  std::optional<Metadata> metadata_;
  SeekTable places_;
  std::optional<HandleOutput> handles_;  // of groups_, once it is asked for
  NormalField normals_;                  // computes the normals for the caller's buffers
  std::optional<std::uint32_t> total_frames_;
  std::optional<Status> error_;
  bool ended_ = false;     // the end packet has been read
  bool finished_ = false;  // no more bytes will be sent
};

}  // namespace sac
