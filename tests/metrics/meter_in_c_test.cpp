// SPDX-License-Identifier: Apache-2.0
// The meter's C interface, against the C++ one.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "metrics/error_meter.h"
#include "sac/sac_measure.h"
#include "synth/synth.h"

namespace sac {
namespace {

TEST(MeterInC, MeasuresWhatTheOtherMeasures) {
  SynthClip clip;
  ASSERT_TRUE(SynthClip::Create({.kind = SynthKind::kFlag, .vertices = 100, .frames = 3}, clip).ok());
  const std::vector<Triangle>& triangles = clip.mesh().triangles;
  const auto count = static_cast<std::uint32_t>(triangles.size());
  const auto vertices = static_cast<std::uint32_t>(clip.mesh().positions.size());
  ErrorMeter expected(triangles, vertices);
  sac_meter* meter = nullptr;
  ASSERT_EQ(sac_meter_open(&meter, vertices, triangles[0].data(), count), SAC_OK);
  sac_distortion distortion;
  ASSERT_EQ(sac_meter_result(meter, &distortion), SAC_OK);
  EXPECT_EQ(distortion.frames, 0u);
  for (std::uint32_t f = 0; f < 2; ++f) {
    const Positions original = clip.Frame(f), decoded = clip.Frame(f + 1);
    expected.Add(original, decoded);
    ASSERT_EQ(sac_meter_add(meter, original[0].data(), decoded[0].data()), SAC_OK);
  }
  ASSERT_EQ(sac_meter_result(meter, &distortion), SAC_OK);
  const DistortionMetrics metrics = expected.Result();
  EXPECT_EQ(distortion.frames, 2u);
  EXPECT_EQ(distortion.kg, metrics.kg);
  EXPECT_EQ(distortion.sted, metrics.sted);
  EXPECT_EQ(distortion.sted_spatial, metrics.sted_s);
  EXPECT_EQ(distortion.sted_temporal, metrics.sted_t);
  EXPECT_EQ(distortion.max_error, metrics.max_error);
  EXPECT_GT(distortion.max_error, 0);
  EXPECT_EQ(sac_meter_add(meter, nullptr, clip.mesh().positions[0].data()), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_meter_message(meter)), "positions: a null pointer");
  sac_meter_close(meter);
}

TEST(MeterInC, RefusesWhatItCannotMeasure) {
  const std::uint32_t triangle[] = {0, 1, 3};
  sac_meter* meter = nullptr;
  EXPECT_EQ(sac_meter_open(&meter, 3, triangle, 1), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_meter_message(meter)), "triangle 0 has vertex 3 of 3");
  sac_distortion distortion;
  EXPECT_EQ(sac_meter_add(meter, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_meter_result(meter, &distortion), SAC_INVALID_ARGUMENT);
  sac_meter_close(meter);
  EXPECT_EQ(sac_meter_open(&meter, 3, nullptr, 1), SAC_INVALID_ARGUMENT);
  sac_meter_close(meter);
  EXPECT_EQ(sac_meter_open(nullptr, 3, triangle, 1), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_meter_add(nullptr, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_meter_result(nullptr, &distortion), SAC_INVALID_ARGUMENT);
  sac_meter_close(nullptr);
}

}  // namespace
}  // namespace sac
