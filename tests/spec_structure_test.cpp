// SPDX-License-Identifier: Apache-2.0
// Runs the worked examples of spec.md that concern the order of frames and of coefficients.
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "format/frame_coder.h"
#include "format/group.h"
#include "format/plane_layout.h"
#include "format/prediction.h"
#include "tests/spec_examples.h"

namespace sac {
namespace {

std::string Text(const FrameSlot& slot) {
  std::ostringstream line;
  line << "display " << slot.display << " level " << slot.level << " references";
  for (const std::uint32_t r : slot.references) line << " " << r;
  return line.str();
}

TEST(Spec, GroupStructure) {
  for (const char* id : {"group-structure", "group-structure-cut"}) {
    const Lines& lines = Example(id);
    ASSERT_FALSE(lines.empty());
    unsigned frames = 0, pyramid = 0;
    ASSERT_EQ(std::sscanf(lines[0].c_str(), "frames %u pyramid %u", &frames, &pyramid), 2);
    const std::vector<FrameSlot> slots = GroupStructure(frames, pyramid);
    ASSERT_EQ(slots.size(), lines.size() - 1);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      EXPECT_EQ(Text(slots[i]), lines[i + 1]);
    }
  }
}

TEST(Spec, LayeredOrder) {
  const Lines& lines = Example("layered-order");
  ASSERT_FALSE(lines.empty());
  unsigned frames = 0, pyramid = 0, base_levels = 0;
  ASSERT_EQ(std::sscanf(lines[0].c_str(), "frames %u pyramid %u base_levels %u", &frames, &pyramid, &base_levels), 3);
  const std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(frames, pyramid), base_levels);
  ASSERT_EQ(slots.size(), lines.size() - 1);
  const std::vector<GroupLayer> layers = LayersOf(slots, base_levels, {});
  for (std::size_t l = 0; l < layers.size(); ++l) {
    for (std::size_t i = layers[l].first; i < layers[l].end; ++i) {
      EXPECT_EQ("layer " + std::to_string(l) + " " + Text(slots[i]), lines[i + 1]);
    }
  }
}

TEST(Spec, HarmonicOrder) {
  const Lines& lines = Example("harmonic-order");
  ASSERT_EQ(lines.size(), 2u);
  std::ostringstream order;
  order << "order";
  const auto counts = Row<std::uint32_t>("harmonic-order", "counts");
  for (const HarmonicIndex& i : HarmonicOrder(counts)) order << " (" << i.component << "," << i.k << ")";
  EXPECT_EQ(order.str(), lines[1]);
}

TEST(Spec, LevelSteps) {
  for (const char* id : {"level-steps", "level-steps-capped"}) {
    SequenceHeader header;
    header.level_growth = Row<std::uint8_t>(id, "growth").at(0);
    const auto steps = Row<std::int32_t>(id, "steps");
    for (std::size_t level = 0; level < steps.size(); ++level) {
      const auto l = static_cast<std::uint32_t>(level);
      for (const Plane plane : {kMotion, kDisplacement, kDetail}) {
        EXPECT_EQ(LevelStep(header, plane, l), steps[level]) << id << " " << level;
      }
      EXPECT_EQ(LevelStep(header, kCorrection, l), 16);
    }
  }
}

}  // namespace
}  // namespace sac
