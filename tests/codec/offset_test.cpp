// SPDX-License-Identifier: Apache-2.0
// The offset of a stream: what was taken from the author's coordinates comes back, and changes nothing else.
#include <gtest/gtest.h>

#include <limits>

#include "sac/sac.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

using Offset = std::array<double, 3>;

std::vector<std::uint8_t> EncodeAt(const Offset& offset) {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.offset = offset;
  return Encode(BendingClip(4), settings).bytes;
}

TEST(StreamOffset, ComesBackBesideTheSamePositions) {
  constexpr Offset kOffset = {500000.1, -5600000.000000001, 1e300};
  const std::vector<std::uint8_t> plain = EncodeAt({}), moved = EncodeAt(kOffset);
  EXPECT_EQ(moved.size(), plain.size() + 24);
  EXPECT_EQ(EncodeAt({0, -0.0, 0}), plain);
  Decoder decoder;
  std::span<const std::uint8_t> rest(moved);
  EXPECT_EQ(decoder.info(), nullptr);
  ASSERT_TRUE(decoder.Send(rest).ok());
  ASSERT_NE(decoder.info(), nullptr);
  EXPECT_EQ(decoder.info()->offset, kOffset);
  const Decoded a = Decode(plain), b = Decode(moved);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t t = 0; t < a.frames.size(); ++t) {
    EXPECT_EQ(a.frames[t].positions, b.frames[t].positions);
    EXPECT_EQ(a.frames[t].box.low, b.frames[t].box.low);
  }
}

TEST(StreamOffset, IsFinite) {
  EncoderSettings settings;
  std::unique_ptr<Encoder> encoder;
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    settings.offset = {0, x, 0};
    const Status status = Encoder::Create(BendingClip(1).mesh, settings, encoder);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message(), "the offset is not finite");
  }
}

TEST(StreamOffset, ThroughC) {
  const std::vector<std::uint8_t> stream = EncodeAt({1, 2, 3e9});
  sac_decoder* decoder = nullptr;
  ASSERT_EQ(sac_decoder_open(&decoder, nullptr), SAC_OK);
  double offset[3] = {7, 7, 7};
  EXPECT_EQ(sac_decoder_offset(decoder, offset), SAC_NEED_MORE_DATA);
  EXPECT_EQ(sac_decoder_offset(decoder, nullptr), SAC_INVALID_ARGUMENT);
  const std::uint8_t* data = stream.data();
  std::size_t size = stream.size();
  ASSERT_EQ(sac_decoder_send(decoder, &data, &size), SAC_OK);
  EXPECT_EQ(sac_decoder_offset(decoder, offset), SAC_OK);
  EXPECT_EQ((Offset{offset[0], offset[1], offset[2]}), (Offset{1, 2, 3e9}));
  sac_decoder_close(decoder);
}

}  // namespace
}  // namespace sac
