// SPDX-License-Identifier: Apache-2.0
#include "format/stream_splicer.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "format/metadata.h"
#include "sac/encoder.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr std::uint32_t kGroup = 5;

EncoderSettings Small() {
  EncoderSettings settings;
  settings.harmonics = 12;
  settings.group = kGroup;
  settings.pyramid = 4;
  return settings;
}

struct Spliced {
  Status status;
  Bytes bytes;
  FrameSpan taken;  // of the last stream
};

Spliced Splice(const std::vector<Bytes>& streams, const FrameSpan& wanted = {}, const SpliceSettings& settings = {},
               std::size_t chunk = 1000) {
  Spliced out;
  StreamSplicer splicer(settings);
  const auto run = [&] {
    for (const Bytes& stream : streams) {
      splicer.Begin(wanted);
      for (std::size_t at = 0; at < stream.size(); at += chunk) {
        SAC_RETURN_IF_ERROR(splicer.Take(std::span(stream).subspan(at, std::min(chunk, stream.size() - at))));
      }
      SAC_RETURN_IF_ERROR(splicer.End());
    }
    return splicer.Finish();
  };
  out.status = run();
  out.bytes = splicer.TakeBytes();
  out.taken = splicer.taken();
  return out;
}

Bytes Cut(const Bytes& stream, std::uint64_t begin, std::uint64_t end) {
  const Spliced cut = Splice({stream}, {begin, end});
  EXPECT_TRUE(cut.status.ok()) << cut.status.message();
  return cut.bytes;
}

Metadata MetadataOf(const Bytes& stream) {
  Metadata metadata;
  for (const Packet& packet : Packets(stream)) {
    if (packet.type != PacketType::kMetadata) continue;
    EXPECT_TRUE(ParseMetadata(packet.payload, metadata).ok());
  }
  return metadata;
}

TEST(StreamSplicer, WhatWasCutJoinsToTheSameBytes) {
  const std::map<std::string, std::function<void(EncoderSettings&)>> kinds = {
      {"smooth", [](auto&) {}},
      {"detail", [](auto& s) { s.quality = 90; }},
      {"layers", [](auto& s) { s.base_levels = 1; }},
      {"low delay", [](auto& s) { s.low_delay = true; }},
      {"previous", [](auto& s) { s.reference_shape = ReferenceShape::kPrevious; }},
      {"starts", [](auto& s) { s.repeat_start = 2; }},
      {"no index", [](auto& s) { s.index = false; }},
      {"metadata",
       [](auto& s) {
         s.metadata.name = "a clip";
         s.metadata.first_frame = 1001;
         s.extra_packets = {{9, {1, 2, 3}}, {10, {}}};
       }},
  };
  const Clip clip = BendingClip(4 * kGroup + 2);
  for (const auto& [kind, apply] : kinds) {
    EncoderSettings settings = Small();
    apply(settings);
    const Bytes whole = Encode(clip, settings).bytes;
    const std::vector<DecodedFrame> frames = Decode(whole).frames;
    const SpliceSettings same = {settings.index, settings.repeat_start, false};
    EXPECT_EQ(Splice({whole}, {}, same).bytes, whole) << kind;
    const std::vector<Bytes> parts = {Cut(whole, 0, kGroup), Cut(whole, kGroup, 3 * kGroup),
                                      Cut(whole, 3 * kGroup, 4 * kGroup + 2)};
    for (const std::size_t chunk : {std::size_t{1}, std::size_t{100}, whole.size()}) {
      const Spliced joined = Splice(parts, {}, same, chunk);
      EXPECT_TRUE(joined.status.ok()) << kind << ": " << joined.status.message();
      EXPECT_EQ(joined.bytes, whole) << kind;
    }
    const Decoded second = Decode(parts[1]);
    ASSERT_EQ(second.frames.size(), 2 * kGroup) << kind << ": " << second.status.message();
    for (std::size_t t = 0; t < second.frames.size(); ++t) {
      EXPECT_EQ(second.frames[t].positions, frames[kGroup + t].positions) << kind;
    }
    EXPECT_EQ(MetadataOf(parts[1]).first_frame.value_or(-1), settings.metadata.first_frame.value_or(0) + kGroup);
    EXPECT_EQ(MetadataOf(parts[1]).name, settings.metadata.name);
  }
}

TEST(StreamSplicer, TakesWholeGroups) {
  const Bytes whole = Encode(BendingClip(4 * kGroup), Small()).bytes;
  EXPECT_EQ(Splice({whole}, {kGroup + 1, 2 * kGroup + 1}).taken, (FrameSpan{kGroup, 3 * kGroup}));
  EXPECT_EQ(Splice({whole}, {kGroup, kGroup + 1}).taken, (FrameSpan{kGroup, 2 * kGroup}));
  EXPECT_EQ(Splice({whole}, {0, 2 * kGroup}).taken, (FrameSpan{0, 2 * kGroup}));
  EXPECT_EQ(Splice({whole}, {4 * kGroup, 9 * kGroup}).taken.size(), 0u);
}

TEST(StreamSplicer, OrderGapsAndOverlapsAreRefused) {
  const Bytes whole = Encode(BendingClip(4 * kGroup), Small()).bytes;
  const Bytes a = Cut(whole, 0, kGroup), b = Cut(whole, kGroup, 2 * kGroup), c = Cut(whole, 2 * kGroup, 4 * kGroup);
  const auto message = [](const std::vector<Bytes>& streams) {
    const Spliced spliced = Splice(streams);
    EXPECT_EQ(spliced.status.code(), StatusCode::kInvalidArgument);
    return spliced.status.message();
  };
  EXPECT_EQ(message({a, c}), "begins with frame 10 of the clip, but frames from 5 on are missing");
  EXPECT_EQ(message({b, a}),
            "begins with frame 0 of the clip, but the streams before go to frame 9: given twice, or in another order");
  EXPECT_EQ(message({a, a}),
            "begins with frame 0 of the clip, but the streams before go to frame 4: given twice, or in another order");
  EXPECT_EQ(message({a, b, b}),
            "begins with frame 5 of the clip, but the streams before go to frame 9: given twice, or in another order");
  EXPECT_TRUE(Splice({b, c}).status.ok());
  const Spliced turned = Splice({c, a, a}, {}, {true, 0, true});
  EXPECT_TRUE(turned.status.ok()) << turned.status.message();
  EXPECT_EQ(Decode(turned.bytes).frames.size(), 4 * kGroup);
}

TEST(StreamSplicer, OtherMeshesAreSegments) {
  const Clip first = BendingClip(kGroup + 1), second = TurningPartsClip(2 * kGroup);
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(first.mesh, Small(), encoder).ok());
  for (const Positions& frame : first.frames) ASSERT_TRUE(encoder->Send(frame).ok());
  ASSERT_TRUE(encoder->BeginSegment(second.mesh).ok());
  for (const Positions& frame : second.frames) ASSERT_TRUE(encoder->Send(frame).ok());
  ASSERT_TRUE(encoder->Finish().ok());
  const Bytes whole = encoder->TakeBytes();
  const Bytes a = Encode(first, Small()).bytes, b = Encode(second, Small()).bytes;
  EXPECT_EQ(Splice({a, b}).bytes, whole);
  // A cut across the border has both meshes, and a cut behind it the second alone.
  EXPECT_EQ(Decode(Cut(whole, kGroup, kGroup + 2)).frames.back().segment, 1u);
  EXPECT_EQ(Decode(Cut(whole, kGroup + 1, 3 * kGroup + 1)).frames.back().segment, 0u);
  EXPECT_EQ(Splice({Cut(whole, 0, kGroup + 2), Cut(whole, 2 * kGroup + 1, 3 * kGroup + 1)}).bytes, whole);
}

TEST(StreamSplicer, OtherFrameRatesAreRefused) {
  EncoderSettings settings = Small();
  const Bytes a = Encode(BendingClip(2), settings).bytes;
  settings.frame_rate_numerator = 25;
  const Spliced spliced = Splice({a, Encode(TurningPartsClip(2), settings).bytes});
  EXPECT_EQ(spliced.status.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(spliced.status.message(), "its frame rate is not that of the first stream");
}

TEST(StreamSplicer, BoxesAreThoseOfWhatIsThere) {
  EncoderSettings settings = Small();
  settings.bounds = true;
  const Clip clip = BendingClip(4 * kGroup);
  const Bytes whole = Encode(clip, settings).bytes;
  const Metadata all = MetadataOf(whole);
  const Bytes first = Cut(whole, 0, 2 * kGroup), second = Cut(whole, 2 * kGroup, 4 * kGroup);
  const auto check = [&](const Bytes& stream, std::size_t begin, std::size_t end) {
    const Metadata said = MetadataOf(stream);
    ASSERT_TRUE(said.bounds);
    ASSERT_EQ(said.group_bounds.size(), (end - begin) / kGroup);
    for (std::size_t t = begin; t < end; ++t) {
      const Box box = said.GroupBounds((t - begin) / kGroup);
      for (const Vec3f& p : clip.frames[t]) {
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_LE(box.low[i], static_cast<double>(p[i]) + 1e-6);
          EXPECT_GE(box.high[i], static_cast<double>(p[i]) - 1e-6);
        }
      }
    }
  };
  check(first, 0, 2 * kGroup);
  check(second, 2 * kGroup, 4 * kGroup);
  check(Splice({first, second}).bytes, 0, 4 * kGroup);
  EXPECT_LT(MetadataOf(first).bounds->diagonal(), 1.01 * all.bounds->diagonal());
  EXPECT_EQ(Splice({whole}).bytes, whole);
}

TEST(StreamSplicer, WhatIsNotWholeIsRefused) {
  EncoderSettings settings = Small();
  settings.base_levels = 1;
  for (const bool low_delay : {false, true}) {
    settings.low_delay = low_delay;
    settings.base_levels = low_delay ? 0 : 1;
    Bytes stream = Encode(BendingClip(kGroup + 1), settings).bytes;
    for (std::size_t size = 0; size < stream.size(); ++size) {
      const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(Splice({prefix}).status.ok()) << size;
    }
    for (std::size_t i = 0; i < stream.size(); i += 3) {
      Bytes changed = stream;
      changed[i] ^= 0x20;
      EXPECT_FALSE(Splice({changed}).status.ok()) << i;
    }
    stream.push_back(0);
    EXPECT_EQ(Splice({stream}).status.code(), StatusCode::kCorrupt);
  }
}

// Packets that are sound but do not follow each other.
TEST(StreamSplicer, PacketsOutOfOrderAreRefused) {
  EncoderSettings settings = Small();
  settings.base_levels = 1;
  const std::vector<Packet> packets = Packets(Encode(BendingClip(2 * kGroup), settings).bytes);
  const auto code = [&](const std::function<void(std::vector<Packet>&)>& change) {
    std::vector<Packet> changed = packets;
    change(changed);
    return Splice({Join(changed)}).status.code();
  };
  EXPECT_EQ(code([](auto&) {}), StatusCode::kOk);
  EXPECT_EQ(code([](auto& p) { p.erase(p.begin()); }), StatusCode::kCorrupt);      // no header
  EXPECT_EQ(code([](auto& p) { p.erase(p.begin() + 1); }), StatusCode::kCorrupt);  // no I-frame
  EXPECT_EQ(code([](auto& p) { p.erase(p.begin() + 2); }), StatusCode::kCorrupt);  // a layer without its group
  EXPECT_EQ(code([](auto& p) { p.erase(p.begin() + 3); }), StatusCode::kCorrupt);  // the layers behind one that is gone
  EXPECT_EQ(code([](auto& p) { p.insert(p.begin() + 2, p[1]); }), StatusCode::kCorrupt);
  EXPECT_EQ(code([](auto& p) { p.back().payload[0] += 1; }), StatusCode::kCorrupt);
}

}  // namespace
}  // namespace sac
