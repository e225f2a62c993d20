// SPDX-License-Identifier: Apache-2.0
#include "rate_control/reference_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "synth/synth.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

constexpr double kPi = 3.14159265358979;

struct Result {
  Status status;
  EncodedClip encoded;
  std::vector<std::uint8_t> bytes;
};

Result EncodeWith(ClipReader& clip, const ClipEncoding& encoding) {
  Result out;
  const auto sink = [&](std::span<const std::uint8_t> bytes) {
    out.bytes.insert(out.bytes.end(), bytes.begin(), bytes.end());
    return Status::Ok();
  };
  out.status = EncodeClip(clip, encoding, sink, out.encoded);
  return out;
}

Result EncodeWith(const Clip& clip, const ClipEncoding& encoding) {
  MemoryClipReader reader(clip);
  return EncodeWith(reader, encoding);
}

ClipEncoding Rounds(std::uint32_t rounds) {
  ClipEncoding encoding;
  encoding.reference_rounds = rounds;
  encoding.encoder.harmonics = 60;
  return encoding;
}

// A flag whose first frame alone has noise of `noise` metres.
Clip NoisyStart(double noise, std::uint32_t frames = 16) {
  SynthClip synth;
  EXPECT_TRUE(SynthClip::Create({SynthKind::kFlag, 500, frames, 1}, synth).ok());
  Clip clip{synth.mesh(), {}};
  for (std::uint32_t t = 0; t < frames; ++t) clip.frames.push_back(synth.Frame(t));
  std::mt19937 random(7);
  for (Vec3f& p : clip.frames[0]) {
    for (float& x : p) x += static_cast<float>(noise * Signed(random));
  }
  clip.mesh.positions = clip.frames[0];
  return clip;
}

// A sheet that is flat at first, and then has waves that are too short for the harmonics and stand still: they cost
// nothing where the shape is flat.
Clip FlatStart() {
  constexpr int kSide = 24;
  Clip clip;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i)
      clip.mesh.positions.push_back({0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 0});
  }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const std::uint32_t v = j * kSide + i;
      clip.mesh.triangles.push_back({v, v + 1, v + kSide});
      clip.mesh.triangles.push_back({v + 1, v + kSide + 1, v + kSide});
    }
  }
  std::mt19937 random(3);
  Positions waves = RandomPositions(random, clip.mesh.positions.size());
  for (int t = 0; t < 12; ++t) {
    Positions frame = clip.mesh.positions;
    for (std::size_t v = 0; t > 0 && v < frame.size(); ++v) {
      frame[v][2] += static_cast<float>(0.3 * std::sin(2 * kPi * (0.4 * frame[v][0] - 0.05 * t)));
      frame[v][2] += 0.004F * waves[v][2];
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(ReferenceShape, NoiseOfTheFirstFrameIsLeftOut) {
  const Clip clip = NoisyStart(0.004);
  const Result first = EncodeWith(clip, Rounds(0));
  for (const std::uint32_t rounds : {1u, 2u, 3u}) {
    const Result fitted = EncodeWith(clip, Rounds(rounds));
    ASSERT_TRUE(fitted.status.ok()) << fitted.status.message();
    EXPECT_TRUE(fitted.encoded.fitted_reference);
    EXPECT_EQ(fitted.encoded.trials, rounds + 1);
    EXPECT_LT(fitted.encoded.distortion.sted, 0.8 * first.encoded.distortion.sted);
    EXPECT_LT(fitted.encoded.distortion.kg, first.encoded.distortion.kg);
    EXPECT_LT(fitted.encoded.bytes, first.encoded.bytes);
    EXPECT_EQ(fitted.encoded.bytes, fitted.bytes.size());
    const Decoded decoded = Decode(fitted.bytes);
    ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
    ASSERT_EQ(decoded.frames.size(), clip.frames.size());
    double largest = 0;
    for (std::size_t t = 0; t < clip.frames.size(); ++t) {
      largest = std::max(largest, MaxDistance(clip.frames[t], decoded.frames[t].positions, fitted.encoded.order));
    }
    EXPECT_DOUBLE_EQ(fitted.encoded.distortion.max_error, largest);
  }
  EXPECT_FALSE(first.encoded.fitted_reference);
  EXPECT_EQ(first.encoded.trials, 0u);
}

TEST(ReferenceShape, EqualInputGivesEqualBytes) {
  const Clip clip = NoisyStart(0.004);
  EXPECT_EQ(EncodeWith(clip, Rounds(2)).bytes, EncodeWith(clip, Rounds(2)).bytes);
}

TEST(ReferenceShape, AFirstFrameThatCostsLessIsKept) {
  const Clip clip = FlatStart();
  const Result kept = EncodeWith(clip, Rounds(2));
  EXPECT_FALSE(kept.encoded.fitted_reference);
  EXPECT_EQ(kept.encoded.trials, 3u);
  EXPECT_EQ(kept.bytes, EncodeWith(clip, Rounds(0)).bytes);
}

TEST(ReferenceShape, TargetsAreMetWithFewerBytes) {
  const Clip clip = NoisyStart(0.004);
  const auto sted = EncodeWith(clip, Rounds(0)).encoded.distortion.sted;
  std::uint64_t before = 0;
  for (const std::uint32_t rounds : {0u, 2u}) {
    ClipEncoding encoding = Rounds(rounds);
    encoding.targets.sted = sted;
    const Result result = EncodeWith(clip, encoding);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
    EXPECT_LE(result.encoded.distortion.sted, sted);
    EXPECT_EQ(result.encoded.fitted_reference, rounds > 0);
    EXPECT_EQ(result.encoded.bytes, result.bytes.size());
    if (rounds > 0) {
      EXPECT_LT(static_cast<double>(result.encoded.bytes), 0.95 * static_cast<double>(before));
    }
    before = result.encoded.bytes;
  }
}

TEST(ReferenceShape, IsTheFirstFrameWhereItHasToBe) {
  const Clip clip = NoisyStart(0.004);
  const auto changed = [](const std::function<void(ClipEncoding&)>& change) {
    ClipEncoding encoding = Rounds(2);
    change(encoding);
    return encoding;
  };
  for (const ClipEncoding& encoding :
       {changed([](ClipEncoding& e) {
          e.measure = false;
          e.reference_rounds.reset();
        }),
        changed([](ClipEncoding& e) { e.encoder.low_delay = true; }),
        changed([](ClipEncoding& e) { e.encoder.max_error = 0.01; }),
        changed([](ClipEncoding& e) { e.encoder.reference_shape = ReferenceShape::kPrevious; })}) {
    EXPECT_EQ(RoundsOf(encoding), 0u);
    const Result result = EncodeWith(clip, encoding);
    EXPECT_FALSE(result.encoded.fitted_reference);
    EXPECT_EQ(result.encoded.trials, 0u);
    EXPECT_EQ(result.bytes, Encode(clip, encoding.encoder).bytes);
  }
  EXPECT_EQ(RoundsOf({}), kReferenceRounds);
  const ClipEncoding unmeasured = changed([](ClipEncoding& e) { e.measure = false; });
  EXPECT_EQ(EncodeWith(clip, unmeasured).bytes, EncodeWith(clip, Rounds(2)).bytes);
  const Clip still{clip.mesh, {clip.mesh.positions}};
  EXPECT_EQ(EncodeWith(still, Rounds(2)).bytes, EncodeWith(still, Rounds(0)).bytes);
}

// What fails from the first frame fails as it does without a search for a shape.
TEST(ReferenceShape, FailuresAreThoseOfTheFirstFrame) {
  Clip clip = NoisyStart(0.004);
  clip.frames[11][5][1] = 1e20F;
  for (const std::uint32_t group : {4u, 128u}) {
    ClipEncoding encoding = Rounds(0);
    encoding.encoder.group = group;
    const Result before = EncodeWith(clip, encoding);
    encoding.reference_rounds = 2;
    const Result after = EncodeWith(clip, encoding);
    EXPECT_EQ(after.status.code(), StatusCode::kInvalidArgument);
    EXPECT_NE(after.status.message().find("frame 11, vertex 5: "), std::string::npos) << after.status.message();
    EXPECT_EQ(after.status.message(), before.status.message());
    EXPECT_EQ(after.bytes, before.bytes);
    EXPECT_EQ(after.encoded.frames, before.encoded.frames);
    EXPECT_EQ(after.encoded.order, before.encoded.order);
  }
}

TEST(ReferenceShape, AFailureOfTheSinkLeavesNoFrames) {
  const Clip clip = NoisyStart(0.004);
  MemoryClipReader reader(clip);
  EncodedClip encoded;
  const auto sink = [](std::span<const std::uint8_t>) { return Status::IoError("full"); };
  EXPECT_EQ(EncodeClip(reader, Rounds(1), sink, encoded).message(), "full");
  EXPECT_EQ(encoded.frames, 0u);
}

// Cannot be read after it has been read `reads` times.
class FailingReader : public MemoryClipReader {
 public:
  FailingReader(const Clip& clip, int reads) : MemoryClipReader(clip), left_(reads) {}
  std::string name() const override { return "disk"; }
  Status Rewind() override {
    if (left_-- == 0) return Status::IoError("disk: it is gone");
    return MemoryClipReader::Rewind();
  }

 private:
  int left_;
};

TEST(ReferenceShape, AFailureFromAFittedShapeLeavesTheFirstFrame) {
  const Clip clip = NoisyStart(0.004);
  FailingReader never(clip, 0);
  EXPECT_EQ(EncodeWith(never, Rounds(2)).status.message(), "disk: it is gone");
  for (const int reads : {1, 2}) {
    FailingReader reader(clip, reads);
    const Result result = EncodeWith(reader, Rounds(2));
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    EXPECT_FALSE(result.encoded.fitted_reference);
    EXPECT_EQ(result.bytes, EncodeWith(clip, Rounds(0)).bytes);
  }
}

TEST(ReferenceShape, CanBeCancelledInEveryTrial) {
  const Clip clip = NoisyStart(0.004);
  std::uint32_t last = 0;
  ClipEncoding encoding = Rounds(2);
  encoding.progress = [&](const EncodingProgress& p) {
    EXPECT_GE(p.trial, last);
    last = p.trial;
    return true;
  };
  EXPECT_TRUE(EncodeWith(clip, encoding).status.ok());
  EXPECT_EQ(last, 3u);
  for (const std::uint32_t trial : {1u, 2u, 3u}) {
    encoding.progress = [&](const EncodingProgress& p) { return p.trial != trial || p.frames == 0; };
    const Result result = EncodeWith(clip, encoding);
    EXPECT_EQ(result.status.code(), StatusCode::kCancelled);
    EXPECT_TRUE(result.bytes.empty());
  }
}

TEST(HeldStream, DropsWhatIsTooLong) {
  std::vector<std::uint8_t> given;
  const ByteSink sink = [&](std::span<const std::uint8_t> bytes) {
    given.assign(bytes.begin(), bytes.end());
    return Status::InvalidArgument("full");
  };
  HeldStream stream(4);
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  EXPECT_TRUE(stream.Give(sink).ok());  // nothing yet
  stream.Add(bytes);
  EXPECT_TRUE(stream.is_whole());
  EXPECT_EQ(stream.Give(sink).message(), "full");
  EXPECT_EQ(given, bytes);
  EXPECT_TRUE(stream.Give({}).ok());
  stream.Add(std::span(bytes).first(1));
  EXPECT_TRUE(stream.is_whole());
  stream.Add(std::span(bytes).first(1));
  EXPECT_FALSE(stream.is_whole());
  stream.Add({});
  EXPECT_FALSE(stream.is_whole());
}

}  // namespace
}  // namespace sac
