// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "format/frame_coder.h"
#include "format/plane_layout.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

SequenceHeader Header(bool all_planes) {
  SequenceHeader header;
  header.vertices = 40;
  header.level_growth = 77;
  header.detail_step = header.correction_step = all_planes ? 1.0f : 0.0f;
  return header;
}

PlaneLayouts Layouts(bool all_planes) {
  return LayOutPlanes(Header(all_planes), std::vector<std::uint32_t>{20, 7, 1}, std::vector<std::uint32_t>{16, 16, 8});
}

FrameSyntax Zero(const FrameSlot& slot, const PlaneLayouts& layouts) {
  FrameSyntax frame;
  frame.slot = slot;
  frame.planes = EmptyPlanes(layouts);
  return frame;
}

// Residuals of a size of their own per plane and frame: none, few, many, or so great that a group's sums stay just
// within the limits.
FrameSyntax RandomFrame(const FrameSlot& slot, const PlaneLayouts& layouts, std::mt19937& random) {
  FrameSyntax frame = Zero(slot, layouts);
  const auto draw = [&](std::int32_t limit) {
    const std::int32_t sizes[] = {0, 1, 3, 20, 5000, limit};
    const std::int32_t size = sizes[random() % std::size(sizes)];
    return [&random, size, limit] {
      if (size == 0) return 0;
      if (size == limit && random() % 4 == 0) return random() % 2 ? limit : -limit;
      return static_cast<std::int32_t>(random() % (2 * static_cast<std::uint32_t>(size) + 1)) - size;
    };
  };
  std::generate(frame.rigid.begin(), frame.rigid.end(), draw(kMaxCoefficient / 32));
  for (PlaneValues& plane : frame.planes) std::generate(plane.begin(), plane.end(), draw(kMaxResidual / 64));
  return frame;
}

std::optional<Bytes> Write(const std::vector<FrameSlot>& structure, std::vector<FrameSyntax> frames,
                           const PlaneLayouts& layouts) {
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(Header(layouts[kDetail].size() > 0), layouts);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!coder.Code(range, structure[i], frames[i])) return std::nullopt;
  }
  return range.Finish();
}

struct Read {
  bool ok = true;
  bool at_end = false;
  std::vector<FrameSyntax> frames;
};

Read Parse(const Bytes& code, const std::vector<FrameSlot>& structure, const PlaneLayouts& layouts) {
  Read read;
  RangeDecoder range(code);
  FrameCoder<RangeDecoder> coder(Header(layouts[kDetail].size() > 0), layouts);
  for (const FrameSlot& slot : structure) {
    FrameSyntax& frame = read.frames.emplace_back();
    if (!(read.ok = coder.Code(range, slot, frame))) break;
  }
  read.at_end = range.AtEnd();
  return read;
}

void ExpectSame(const FrameSyntax& a, const FrameSyntax& b) {
  EXPECT_EQ(a.slot.display, b.slot.display);
  EXPECT_EQ(a.slot.level, b.slot.level);
  EXPECT_EQ(a.slot.references, b.slot.references);
  EXPECT_EQ(a.intra(), b.intra());
  EXPECT_EQ(a.rigid, b.rigid);
  EXPECT_EQ(a.planes, b.planes);
}

TEST(FrameSyntax, RandomFramesComeBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    const PlaneLayouts layouts = Layouts(i % 2 == 0);
    const auto structure = GroupStructure(static_cast<std::uint32_t>(1 + random() % 20), i % 3 ? 8 : 1);
    std::vector<FrameSyntax> frames;
    for (std::uint32_t f = 0; f < structure.size(); ++f) {
      frames.push_back(RandomFrame(structure[f], layouts, random));
      if (f > 0 && random() % 3 == 0) {  // references of its own
        References& references = frames.back().slot.references;
        references.resize(random() % 3);
        for (std::uint32_t& r : references) r = static_cast<std::uint32_t>(random() % f);
      }
    }
    const auto code = Write(structure, frames, layouts);
    ASSERT_TRUE(code);
    const Read read = Parse(*code, structure, layouts);
    EXPECT_TRUE(read.ok);
    EXPECT_TRUE(read.at_end);
    ASSERT_EQ(read.frames.size(), frames.size());
    for (std::size_t f = 0; f < frames.size(); ++f) ExpectSame(frames[f], read.frames[f]);
  }
}

TEST(FrameSyntax, ExtremesComeBackAndNoMore) {
  const PlaneLayouts layouts = Layouts(true);
  const auto structure = GroupStructure(1, 1);
  for (const std::int32_t sign : {1, -1}) {
    FrameSyntax frame = Zero(structure[0], layouts);
    frame.rigid.values.fill(sign * kMaxCoefficient);
    for (PlaneValues& plane : frame.planes) std::fill(plane.begin(), plane.end(), sign * kMaxResidual);
    const auto code = Write(structure, {frame}, layouts);
    ASSERT_TRUE(code);
    ExpectSame(Parse(*code, structure, layouts).frames[0], frame);

    frame.rigid[4] = sign * (kMaxCoefficient + 1);
    EXPECT_FALSE(Write(structure, {frame}, layouts));
    for (std::size_t p = 0; p < kPlanes; ++p) {
      FrameSyntax beyond = Zero(structure[0], layouts);
      beyond.planes[p][5] = sign * (kMaxResidual + 1);
      EXPECT_FALSE(Write(structure, {beyond}, layouts)) << p;
    }
  }
}

TEST(FrameSyntax, FramesOfZerosCostNearlyNothing) {
  for (const std::uint32_t pyramid : {1u, 16u}) {
    const PlaneLayouts layouts = Layouts(true);
    const auto structure = GroupStructure(2000, pyramid);
    std::vector<FrameSyntax> frames;
    for (const FrameSlot& slot : structure) frames.push_back(Zero(slot, layouts));
    const auto code = Write(structure, frames, layouts);
    ASSERT_TRUE(code);
    EXPECT_LT(8.0 * static_cast<double>(code->size()), 0.1 * 2000);
  }
}

TEST(FrameSyntax, SmallResidualsAreCheap) {
  // One in fifty is not zero: 0.14 bits of position and one of sign in fifty, and a little to learn.
  const PlaneLayouts layouts = Layouts(false);
  const auto structure = GroupStructure(200, 1);
  std::mt19937 random(2);
  std::vector<FrameSyntax> frames;
  std::size_t values = 0;
  for (const FrameSlot& slot : structure) {
    frames.push_back(Zero(slot, layouts));
    for (PlaneValues& plane : frames.back().planes) {
      for (std::int32_t& v : plane) v = random() % 50 ? 0 : 1 - 2 * static_cast<std::int32_t>(random() % 2);
      values += plane.size();
    }
  }
  const auto code = Write(structure, frames, layouts);
  ASSERT_TRUE(code);
  EXPECT_LT(8.0 * static_cast<double>(code->size()), 0.22 * static_cast<double>(values));
}

TEST(FrameSyntax, BitsAddUp) {
  const PlaneLayouts layouts = Layouts(true);
  const auto structure = GroupStructure(10, 4);
  std::mt19937 random(3);
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(Header(layouts[kDetail].size() > 0), layouts);
  FrameBits bits;
  for (const FrameSlot& slot : structure) {
    FrameSyntax frame = RandomFrame(slot, layouts, random);
    ASSERT_TRUE(coder.Code(range, slot, frame, &bits));
  }
  double sum = bits.side;
  for (const double part : bits.planes) {
    EXPECT_GT(part, 0);
    sum += part;
  }
  EXPECT_NEAR(sum, range.bits(), 1e-6);
}

// Whatever is read stays within the format.
void ExpectWithinRange(const Read& read, const PlaneLayouts& layouts) {
  const std::size_t whole = read.frames.size() - (read.ok ? 0 : 1);
  for (std::size_t f = 0; f < whole; ++f) {
    const FrameSyntax& frame = read.frames[f];
    EXPECT_LE(frame.slot.references.size(), 2u);
    for (const std::uint32_t r : frame.slot.references) EXPECT_LT(r, f);
    for (const std::int32_t v : frame.rigid) EXPECT_LE(std::abs(v), kMaxCoefficient);
    for (std::size_t p = 0; p < kPlanes; ++p) {
      EXPECT_EQ(frame.planes[p].size(), layouts[p].size());
      for (const std::int32_t v : frame.planes[p]) EXPECT_LE(std::abs(v), kMaxResidual);
    }
  }
}

TEST(FrameSyntax, PrefixesAndMutationsAreHarmless) {
  const PlaneLayouts layouts = Layouts(true);
  const auto structure = GroupStructure(4, 2);
  std::mt19937 random(4);
  std::vector<FrameSyntax> frames;
  for (const FrameSlot& slot : structure) frames.push_back(RandomFrame(slot, layouts, random));
  const auto code = Write(structure, frames, layouts);
  ASSERT_TRUE(code);
  for (std::size_t size = 0; size < code->size(); size += size < 100 ? 1 : 7) {
    const Bytes prefix(code->begin(), code->begin() + static_cast<std::ptrdiff_t>(size));
    const Read read = Parse(prefix, structure, layouts);
    ExpectWithinRange(read, layouts);
    const bool same = read.ok && read.at_end && read.frames.back().planes == frames.back().planes;
    EXPECT_FALSE(same) << size;
  }
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    Bytes changed = *code;
    for (std::size_t j = 1 + random() % 4; j > 0; --j) {
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    }
    if (i % 4 == 0) std::generate(changed.begin(), changed.end(), [&] { return static_cast<std::uint8_t>(random()); });
    const Read read = Parse(changed, structure, layouts);
    ExpectWithinRange(read, layouts);
    refused += !read.ok;
  }
  EXPECT_GT(refused, 25);
}

}  // namespace
}  // namespace sac
