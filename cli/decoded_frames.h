// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "sac/decoder.h"
#include "sac/status.h"

namespace sac {

// The frames of a stream, one after the other, decoded from chunks that are asked for when they are needed. Memory
// holds a chunk beside what the decoder holds.
class DecodedFrames {
 public:
  // Gives the next bytes of the stream, none at its end. They stay until the next call.
  using NextChunk = std::function<Status(std::span<const std::uint8_t>& chunk)>;

  // `name` of the stream begins the messages about it; those of `next_chunk` come as they are.
  DecodedFrames(std::string name, NextChunk next_chunk, const DecoderSettings& settings = {})
      : name_(std::move(name)),
        next_chunk_(std::move(next_chunk)),
        skip_damage_(settings.skip_damage),
        decoder_(settings) {}

  // `end` is set, and `frame` left alone, after the last frame of a complete stream; with skip_damage of any that has
  // frames.
  Status Next(DecodedFrame& frame, bool& end);

  const Decoder& decoder() const { return decoder_; }
  // Bytes taken so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  Status At(const Status& status) const { return {status.code(), name_ + ": " + status.message()}; }

  std::string name_;
  NextChunk next_chunk_;
  bool skip_damage_;
  Decoder decoder_;
  bool ended_ = false;
  std::span<const std::uint8_t> chunk_;
  std::uint64_t bytes_ = 0;
};

}  // namespace sac
