// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/join_packets.h"
#include "tests/test_clips.h"

namespace sac {

inline constexpr std::uint32_t kFrames = 23;

// Settings of clips that are sought in: groups of `group` frames, 25 frames a second.
inline EncoderSettings Grouped(std::uint32_t group = 5) {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = group;
  settings.pyramid = 4;
  settings.frame_rate_numerator = 25;
  return settings;
}

// The frames from where `decoder` stands to the end of the stream or `max_frames` of them.
inline std::vector<DecodedFrame> ReadOn(Decoder& decoder, const Bytes& stream, std::uint64_t byte,
                                        std::size_t max_frames = 1000) {
  std::vector<DecodedFrame> frames;
  for (auto rest = std::span(stream).subspan(byte); !rest.empty() && frames.size() < max_frames;) {
    const Status status = decoder.Send(rest);
    EXPECT_TRUE(status.ok()) << status.message();
    if (!status.ok()) return frames;
    for (DecodedFrame frame; frames.size() < max_frames && decoder.Receive(frame).ok();) frames.push_back(frame);
  }
  return frames;
}

}  // namespace sac
