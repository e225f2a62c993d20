// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/damage_policy.h"
#include "codec/decode/group_sequence.h"
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
  Status Finish();

  Status Seek(std::uint32_t frame, std::uint64_t& byte);
  Status SeekTime(double seconds, std::uint64_t& byte);
  Status AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed);
  Status Interpolate(double time, Positions& positions, FrameInfo& info, const FrameBuffers* buffers);

  // Makes an error final: later calls return it until a seek.
  Status Latch(Status status) {
    if (!status.ok()) error_ = status;
    return status;
  }

  const StreamStart& start() const { return start_; }
  std::optional<std::uint32_t> total_frames() const { return total_frames_; }
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
  Status TakeIFrame(std::span<const std::uint8_t> payload);
  Status TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin);
  Status TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin);
  Status ParseAndCheckEnd(std::span<const std::uint8_t> payload, std::uint64_t begin, std::uint32_t& frames);

  bool FrameWaits() const { return groups_ && groups_->HasFrame(); }
  Status Check(const FrameBuffers* buffers) const {
    return buffers ? CheckBuffers(*buffers, start_.shape().vertices()) : Status::Ok();
  }
  Status BeyondTheEnd(double time) const;
  // Reads on until the frames before and after `time` are held.
  Status ReadAround(double time);
  void GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
               const FrameBuffers* buffers);

  const DecoderSettings& settings_;
  DamagePolicy damage_;
  PacketSource packets_;
  StreamStart start_;
  std::optional<GroupSequence> groups_;  // once the I-frame has been read
  SeekTable places_;
  NormalField normals_;  // computes the normals for the caller's buffers
  std::optional<std::uint32_t> total_frames_;
  std::optional<Status> error_;
  bool ended_ = false;     // the end packet has been read
  bool finished_ = false;  // no more bytes will be sent
};

}  // namespace sac
