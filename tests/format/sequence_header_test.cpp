// SPDX-License-Identifier: Apache-2.0
#include "format/sequence_header.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>

namespace sac {
namespace {

SequenceHeader Valid() {
  SequenceHeader h;
  h.vertices = 1000;
  h.triangles = 1996;
  h.harmonics = 100;
  h.frame_rate_numerator = 30000;
  h.frame_rate_denominator = 1001;
  h.origin_x = -1.5f;
  h.origin_y = 0;
  h.origin_z = 1e6f;
  h.cell = 0.01f;
  h.motion_step = 0.03f;
  h.displacement_step = 0.001f;
  h.rotation_step = 0.002f;
  h.translation_step = 0.003f;
  return h;
}

Status Parse(const SequenceHeader& header, const Limits& limits = {}) {
  SequenceHeader back;
  return ParseSequenceHeader(WriteSequenceHeader(header), limits, back);
}

// The fields by name, as the one list gives them.
std::map<std::string, double> Fields(const SequenceHeader& header) {
  std::map<std::string, double> fields;
  VisitFields(header, [&](const char* name, auto value) { fields[name] = static_cast<double>(value); });
  return fields;
}

void ExpectRoundTrip(const SequenceHeader& header, const Limits& limits = {}) {
  SequenceHeader back;
  const Status status = ParseSequenceHeader(WriteSequenceHeader(header), limits, back);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(Fields(back), Fields(header));
}

TEST(SequenceHeader, ComesBack) {
  ExpectRoundTrip(Valid());
  EXPECT_NEAR(Valid().frames_per_second(), 29.97, 0.001);
}

TEST(SequenceHeader, ExtremesComeBack) {
  SequenceHeader h = Valid();
  h.vertices = h.triangles = h.harmonics = h.frame_rate_numerator = h.frame_rate_denominator = 0xffffffffu;
  h.position_bits = 24;
  h.reference_shape = 1;
  h.origin_x = -FLT_MAX;
  h.origin_y = FLT_MAX;
  h.origin_z = -FLT_TRUE_MIN;
  h.cell = h.motion_step = FLT_TRUE_MIN;
  h.displacement_step = h.rotation_step = h.translation_step = FLT_MAX;
  Limits limits;
  limits.vertices = limits.expert.triangles = 0xffffffffu;
  limits.memory = ~std::uint64_t{0};
  ExpectRoundTrip(h, limits);

  h = Valid();
  h.vertices = h.harmonics = h.frame_rate_denominator = 1;
  h.triangles = h.frame_rate_numerator = 0;
  h.position_bits = 1;
  ExpectRoundTrip(h);
}

TEST(SequenceHeader, AnOffsetIsThereOrNot) {
  SequenceHeader h = Valid(), back;
  const std::size_t size = WriteSequenceHeader(h).size();
  h.offset_x = h.offset_y = -0.0;
  EXPECT_EQ(WriteSequenceHeader(h).size(), size);
  h.offset_x = 0.1;
  h.offset_z = -1e300;
  EXPECT_EQ(WriteSequenceHeader(h).size(), size + 24);
  ASSERT_TRUE(ParseSequenceHeader(WriteSequenceHeader(h), {}, back).ok());
  EXPECT_EQ(InfoOf(back).offset, (std::array<double, 3>{0.1, 0, -1e300}));
  std::vector<std::uint8_t> zero = WriteSequenceHeader(Valid());
  zero.resize(size + 24);
  EXPECT_EQ(ParseSequenceHeader(zero, {}, back).message(), "sequence header: an offset of zero");
}

TEST(SequenceHeader, EveryRuleIsChecked) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const std::map<std::string, std::function<void(SequenceHeader&)>> breaks = {
      {"reference shape", [](auto& h) { h.reference_shape = 2; }},
      {"no position bits", [](auto& h) { h.position_bits = 0; }},
      {"position bits", [](auto& h) { h.position_bits = 25; }},
      {"shrinking levels", [](auto& h) { h.level_growth = 63; }},
      {"exploding levels", [](auto& h) { h.level_growth = 129; }},
      {"no patches", [](auto& h) { h.patch_size = 0; }},
      {"huge patches", [](auto& h) { h.patch_size = 1025; }},
      {"detail step", [](auto& h) { h.detail_step = -0.1f; }},
      {"detail step not a number", [=](auto& h) { h.detail_step = nan; }},
      {"correction step", [=](auto& h) { h.correction_step = infinity; }},
      {"no vertices", [](auto& h) { h.vertices = h.harmonics = 0; }},
      {"no harmonics", [](auto& h) { h.harmonics = 0; }},
      {"harmonics", [](auto& h) { h.harmonics = h.vertices + 1; }},
      {"frame rate", [](auto& h) { h.frame_rate_denominator = 0; }},
      {"origin x", [=](auto& h) { h.origin_x = nan; }},
      {"origin y", [=](auto& h) { h.origin_y = infinity; }},
      {"origin z", [=](auto& h) { h.origin_z = -infinity; }},
      {"cell", [](auto& h) { h.cell = 0; }},
      {"cell infinite", [=](auto& h) { h.cell = infinity; }},
      {"motion step", [](auto& h) { h.motion_step = -0.1f; }},
      {"displacement step", [=](auto& h) { h.displacement_step = nan; }},
      {"rotation step", [](auto& h) { h.rotation_step = -0.0f; }},
      {"offset x", [](auto& h) { h.offset_x = std::numeric_limits<double>::quiet_NaN(); }},
      {"offset z", [](auto& h) { h.offset_z = std::numeric_limits<double>::infinity(); }},
      {"translation step", [=](auto& h) { h.translation_step = -infinity; }},
  };
  for (const auto& [rule, apply] : breaks) {
    SequenceHeader h = Valid();
    apply(h);
    EXPECT_EQ(Parse(h).code(), StatusCode::kCorrupt) << rule;
  }
}

TEST(SequenceHeader, AnotherVersionIsUnsupportedWhateverFollows) {
  SequenceHeader h = Valid();
  h.version_minor = kVersionMinor + 1;
  EXPECT_EQ(Parse(h).code(), StatusCode::kUnsupported);
  h = Valid();
  h.version_major = kVersionMajor + 1;
  h.cell = 0;
  auto bytes = WriteSequenceHeader(h);
  bytes.resize(bytes.size() + 20);
  SequenceHeader back;
  EXPECT_EQ(ParseSequenceHeader(bytes, {}, back).code(), StatusCode::kUnsupported);
  EXPECT_EQ(ParseSequenceHeader(std::span(bytes).first(2), {}, back).code(), StatusCode::kUnsupported);
}

TEST(SequenceHeader, LimitsAreRespected) {
  Limits limits;
  limits.vertices = 1000;
  limits.expert.triangles = 1996;
  EXPECT_TRUE(Parse(Valid(), limits).ok());
  SequenceHeader h = Valid();
  h.vertices = 1001;
  EXPECT_EQ(Parse(h, limits).code(), StatusCode::kLimit);
  h = Valid();
  h.triangles = 1997;
  EXPECT_EQ(Parse(h, limits).code(), StatusCode::kLimit);
}

// One without an offset, and one with.
TEST(SequenceHeader, HasOneLength) {
  SequenceHeader moved = Valid();
  moved.offset_y = 1;
  const auto bytes = WriteSequenceHeader(moved), plain = WriteSequenceHeader(Valid());
  SequenceHeader back;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::uint8_t> prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(ParseSequenceHeader(prefix, {}, back).ok(), size == plain.size()) << size;
  }
  auto longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(ParseSequenceHeader(longer, {}, back).code(), StatusCode::kCorrupt);
}

}  // namespace
}  // namespace sac
