// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/encoded_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "codec/encode/stream_encoder.h"
#include "codec/i_frame.h"
#include "format/crc32.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes EncodeFrom(EncodedStart start, const Clip& clip, const EncoderSettings& settings) {
  StreamEncoder encoder(std::move(start), settings);
  for (const Positions& frame : clip.frames) EXPECT_TRUE(encoder.Send(frame).ok());
  EXPECT_TRUE(encoder.Finish().ok());
  return encoder.TakeBytes();
}

EncodedStart Start(const Clip& clip, const EncoderSettings& settings) {
  EncodedStart start;
  const Status status = EncodeStart(clip.mesh, settings, start);
  EXPECT_TRUE(status.ok()) << status.message();
  return start;
}

Status Read(const Bytes& bytes, const Limits& limits = {}) {
  EncodedStart start;
  const Status status = ReadStreamStart(bytes, limits, start);
  EXPECT_EQ(status.ok(), status.message().empty());
  return status;
}

EncoderSettings Small() {
  EncoderSettings settings;
  settings.harmonics = 12;
  settings.group = 4;
  settings.pyramid = 4;
  return settings;
}

Bytes SmallStart() { return WriteStreamStart(Start(TurningPartsClip(1), Small())); }

// `bytes` with `change` made to what follows the packets, under a CRC-32 that is right.
Bytes WithEncoderPart(Bytes bytes, const std::function<void(std::span<std::uint8_t>)>& change) {
  const std::size_t size = 8 + 4 * TurningPartsClip(1).mesh.positions.size() + 12;
  const std::span<std::uint8_t> part = std::span(bytes).subspan(bytes.size() - 4 - size, size);
  change(part);
  const std::uint32_t crc = Crc32(part);
  for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  return bytes;
}

TEST(EncodedStart, GroupsFromAStartThatIsReadAgainAreTheSameBytes) {
  const std::map<std::string, std::function<void(EncoderSettings&)>> kinds = {
      {"smooth", [](auto&) {}},
      {"detail", [](auto& s) { s.quality = 90; }},
      {"chosen harmonics", [](auto& s) { s.harmonics.reset(); }},
      {"bounded", [](auto& s) { s.max_error = 1e-3; }},
      {"previous", [](auto& s) { s.reference_shape = ReferenceShape::kPrevious; }},
      {"low delay", [](auto& s) { s.low_delay = true; }},
      {"kept order", [](auto& s) { s.keep_order = true; }},
      {"exact harmonics", [](auto& s) { s.handles_per_harmonic = 0; }},
  };
  for (const Clip& clip : {TurningPartsClip(9), BendingClip(9)}) {
    for (const auto& [kind, apply] : kinds) {
      EncoderSettings settings = Small();
      apply(settings);
      EncodedStart start = Start(clip, settings);
      const Bytes written = WriteStreamStart(start);
      EncodedStart again;
      const Status status = ReadStreamStart(written, {}, again);
      ASSERT_TRUE(status.ok()) << kind << ": " << status.message();
      EXPECT_EQ(WriteStreamStart(again), written) << kind;
      const Bytes stream = EncodeFrom(std::move(again), clip, settings);
      EXPECT_EQ(stream, EncodeFrom(std::move(start), clip, settings)) << kind;
      EXPECT_EQ(stream, Encode(clip, settings).bytes) << kind;
      EXPECT_EQ(Decode(stream).frames.size(), clip.frames.size()) << kind;
    }
  }
}

TEST(EncodedStart, WrittenStartsBeginAsTheirStreamsDo) {
  const Clip clip = BendingClip(3);
  const EncodedStart start = Start(clip, Small());
  const Bytes written = WriteStreamStart(start), stream = Encode(clip, Small()).bytes;
  const std::size_t packets = written.size() - 8 - 4 * clip.mesh.positions.size() - 12 - 4;
  EXPECT_TRUE(std::equal(written.begin(), written.begin() + static_cast<std::ptrdiff_t>(packets), stream.begin()));
}

TEST(EncodedStart, EveryPrefixAndAnotherByteAreRefused) {
  Bytes bytes = SmallStart();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(Read(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))).code(),
              StatusCode::kCorrupt)
        << size;
  }
  bytes.push_back(0);
  EXPECT_EQ(Read(bytes).code(), StatusCode::kCorrupt);
}

TEST(EncodedStart, EveryChangedByteIsRefused) {
  const Bytes bytes = SmallStart();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes changed = bytes;
    changed[i] ^= 0x10;
    EXPECT_FALSE(Read(changed).ok()) << i;
  }
}

TEST(EncodedStart, OrdersAndBoundsThatDoNotFitAreRefused) {
  const Bytes bytes = SmallStart();
  const auto set_bound = [](double bound) {
    return [bound](std::span<std::uint8_t> part) { std::memcpy(part.data(), &bound, sizeof(bound)); };
  };
  ASSERT_TRUE(Read(WithEncoderPart(bytes, set_bound(0))).ok());
  for (const double bound : {1e-3, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_EQ(Read(WithEncoderPart(bytes, set_bound(bound))).code(), StatusCode::kCorrupt) << bound;
  }
  // The first vertex twice, then a vertex that is not there.
  for (const std::uint8_t high : {std::uint8_t{0}, std::uint8_t{0xff}}) {
    const auto change = [high](std::span<std::uint8_t> part) {
      std::copy_n(part.begin() + 8, 4, part.begin() + 12);
      part[15] = high;
    };
    EXPECT_EQ(Read(WithEncoderPart(bytes, change)).code(), StatusCode::kCorrupt);
  }

  EncoderSettings bounded = Small();
  bounded.max_error = 1e-3;
  const Bytes with_bound = WriteStreamStart(Start(TurningPartsClip(1), bounded));
  ASSERT_TRUE(Read(with_bound).ok());
  EXPECT_EQ(Read(WithEncoderPart(with_bound, set_bound(0))).code(), StatusCode::kCorrupt);

  EncoderSettings kept = Small();
  kept.keep_order = true;
  const auto swap_two = [](std::span<std::uint8_t> part) {
    std::swap_ranges(part.begin() + 8, part.begin() + 12, part.begin() + 12);
  };
  const Bytes with_order = WriteStreamStart(Start(TurningPartsClip(1), kept));
  EXPECT_EQ(Read(WithEncoderPart(with_order, swap_two)).code(), StatusCode::kCorrupt);
  EXPECT_TRUE(Read(WithEncoderPart(bytes, swap_two)).ok());  // nothing says otherwise
}

TEST(EncodedStart, OtherHarmonicsAreRefused) {
  EncodedStart start = Start(BendingClip(1), Small());
  IFrameSyntax syntax;
  ASSERT_TRUE(ReadIFrame(start.i_frame, start.header, syntax).ok());
  syntax.fingerprint[0] += 1;
  start.i_frame = WriteIFrame(syntax, start.header);
  EXPECT_EQ(Read(WriteStreamStart(start)).code(), StatusCode::kUnsupported);
}

TEST(EncodedStart, LimitsHold) {
  const Bytes bytes = SmallStart();
  Limits vertices;
  vertices.vertices = 10;
  EXPECT_EQ(Read(bytes, vertices).code(), StatusCode::kLimit);
  Limits memory;
  memory.memory = 1000;
  EXPECT_EQ(Read(bytes, memory).code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace sac
