// SPDX-License-Identifier: Apache-2.0
#include "format/prediction.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sac {
namespace {

SequenceHeader Header(ReferenceShape reference_shape = ReferenceShape::kKey) {
  SequenceHeader header;
  header.vertices = 2;
  header.reference_shape = static_cast<std::uint8_t>(reference_shape);
  header.detail_step = header.correction_step = 1;
  return header;
}

PlaneLayouts Layouts() { return LayOutPlanes(Header(), std::vector<std::uint32_t>{2}, std::vector<std::uint32_t>{2}); }

// A frame whose residuals are all `residual`.
FrameSyntax Frame(const References& references, std::int32_t residual, std::uint32_t level = 0,
                  std::uint32_t display = 0) {
  FrameSyntax frame;
  frame.slot = {display, level, references};
  frame.rigid.values.fill(residual);
  frame.planes = EmptyPlanes(Layouts());
  for (PlaneValues& plane : frame.planes) plane.assign(plane.size(), residual);
  return frame;
}

void ExpectAll(const FrameCoefficients& frame, std::int32_t rigid, std::int32_t planes, std::int32_t correction) {
  for (const std::int32_t v : frame.rigid) EXPECT_EQ(v, rigid);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    EXPECT_FALSE(frame.planes[p].empty());
    for (const std::int32_t v : frame.planes[p]) EXPECT_EQ(v, p == kCorrection ? correction : planes) << p;
  }
}

TEST(LevelStep, GrowsFromLevelToLevel) {
  SequenceHeader header = Header();
  header.level_growth = 64;
  for (std::uint32_t level = 0; level < 20; ++level) EXPECT_EQ(LevelStep(header, kMotion, level), 16);
  header.level_growth = 128;
  EXPECT_EQ(LevelStep(header, kMotion, 0), 16);
  EXPECT_EQ(LevelStep(header, kDetail, 3), 128);
  EXPECT_EQ(LevelStep(header, kMotion, 8), 4096);
  EXPECT_EQ(LevelStep(header, kMotion, 1000000), 4096);
  EXPECT_EQ(LevelStep(header, kCorrection, 3), 16);
  header.level_growth = 96;  // 16, 24, 36, 54, 81, 121.5
  EXPECT_EQ(LevelStep(header, kDisplacement, 4), 81);
  EXPECT_EQ(LevelStep(header, kDisplacement, 5), 122);
}

TEST(Predictor, SumsUp) {
  Predictor predictor(Header(), Layouts());
  ASSERT_TRUE(predictor.Add(Frame({}, 5)));
  ASSERT_TRUE(predictor.Add(Frame({0}, -2)));
  ASSERT_TRUE(predictor.Add(Frame({1}, 1)));
  ASSERT_TRUE(predictor.Add(Frame({}, 7)));   // from zero again
  ASSERT_TRUE(predictor.Add(Frame({0}, 1)));  // from one long ago
  ASSERT_EQ(predictor.frames().size(), 5u);
  ExpectAll(predictor.frames()[0], 5, 80, 80);
  ExpectAll(predictor.frames()[1], 3, 48, -32);  // corrections are not predicted
  ExpectAll(predictor.frames()[2], 4, 64, 16);
  ExpectAll(predictor.frames()[3], 7, 112, 112);
  ExpectAll(predictor.frames()[4], 6, 96, 16);
}

TEST(Predictor, TakesTheMeanOfTwo) {
  Predictor predictor(Header(), Layouts());
  ASSERT_TRUE(predictor.Add(Frame({}, 4)));
  ASSERT_TRUE(predictor.Add(Frame({}, -1)));
  ExpectAll(predictor.Predict({0, 0, {0, 1}}), 2, 24, 0);  // 1.5 goes up
  ASSERT_TRUE(predictor.Add(Frame({}, -2)));
  ExpectAll(predictor.Predict({0, 0, {1, 2}}), -1, -24, 0);  // so does -1.5
  ASSERT_TRUE(predictor.Add(Frame({0, 1}, 1)));
  ExpectAll(predictor.frames()[3], 3, 40, 16);
}

TEST(Predictor, BendsAtFineLevels) {
  // 4, 1, x, 0, 2 at times 0, 2, 3, 4, 6, in steps.
  Predictor predictor(Header(), Layouts());
  for (const auto& [display, value] : {std::array{0, 4}, {2, 1}, {4, 0}, {6, 2}}) {
    ASSERT_TRUE(predictor.Add(Frame({}, value, 0, static_cast<std::uint32_t>(display))));
  }
  const auto expect = [&](const FrameSlot& slot, std::int32_t planes, std::int32_t detail) {
    const FrameCoefficients prediction = predictor.Predict(slot);
    for (const Plane p : {kMotion, kDisplacement}) EXPECT_EQ(prediction.planes[p][1], planes);
    EXPECT_EQ(prediction.planes[kDetail][1], detail);
  };
  expect({3, 2, {1, 2}}, 8, 8);
  expect({3, 3, {1, 2}}, 8 - 2 - 3, 8);  // -(4 - 2 * 1 + 0) - (1 - 2 * 0 + 2), in steps and sixteenths
  expect({1, 3, {0, 1}}, 40 - 2, 40);    // the frame at -2 is not there; 2 * 1 - 4 - 0 from the one at 4
  expect({3, 3, {2, 1}}, 8 - 2 - 3, 8);
  expect({3, 3, {2}}, 0, 0);
  expect({3, 3, {1, 1}}, 16, 16);
}

TEST(Predictor, FinerLevelsCountInTheirOwnSteps) {
  SequenceHeader header = Header();
  header.level_growth = 96;
  Predictor predictor(header, Layouts());
  ASSERT_TRUE(predictor.Add(Frame({}, 1)));
  ASSERT_TRUE(predictor.Add(Frame({0, 0}, 1, 1)));
  ExpectAll(predictor.frames()[1], 2, 16 + 24, 16);
}

TEST(Predictor, AgainstThePreviousFrameOnlyTheRigidMotionIsPredicted) {
  Predictor predictor(Header(ReferenceShape::kPrevious), Layouts());
  ASSERT_TRUE(predictor.Add(Frame({}, 5)));
  ExpectAll(predictor.Predict({0, 0, {0}}), 5, 0, 0);
  ASSERT_TRUE(predictor.Add(Frame({0}, -2)));
  ExpectAll(predictor.frames()[1], 3, -32, -32);
}

TEST(Predictor, RefusesWhatLeavesTheRange) {
  for (const std::int32_t sign : {1, -1}) {
    Predictor predictor(Header(), Layouts());
    FrameSyntax edge = Frame({}, 0);
    edge.rigid[3] = sign * kMaxCoefficient;
    edge.planes[kDetail][1] = sign * (kMaxCoefficient / kCoefficientsPerStep);
    ASSERT_TRUE(predictor.Add(edge));

    FrameSyntax beyond = Frame({0}, 0);
    beyond.rigid[3] = sign;
    EXPECT_FALSE(predictor.Add(beyond));
    beyond = Frame({0}, 0);
    beyond.planes[kDetail][1] = sign;
    EXPECT_FALSE(predictor.Add(beyond));
    EXPECT_EQ(predictor.frames().size(), 1u);

    beyond.planes[kDetail][1] = -sign;  // back is fine
    EXPECT_TRUE(predictor.Add(beyond));
    // The largest residual at the coarsest level does not overflow.
    beyond = Frame({}, 0, 1000);
    beyond.planes[kMotion][0] = sign * kMaxResidual;
    EXPECT_TRUE(predictor.Add(beyond));  // level_growth of 1
    SequenceHeader growing = Header();
    growing.level_growth = 128;
    EXPECT_FALSE(Predictor(growing, Layouts()).Add(beyond));
  }
}

}  // namespace
}  // namespace sac
