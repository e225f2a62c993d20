// SPDX-License-Identifier: Apache-2.0
#include "format/i_frame_syntax.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "format/range_coder.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

SequenceHeader Header() {
  SequenceHeader h;
  h.position_bits = 12;
  h.vertices = 60;
  h.triangles = 40;
  h.harmonics = 30;
  return h;
}

// An I-frame that uses every feature. The mesh is opaque to the syntax.
IFrameSyntax Everything() {
  std::mt19937 random(1);
  IFrameSyntax s;
  s.position_step = 90;
  s.position_slope = 1234567;
  s.mesh.resize(333);
  for (auto& b : s.mesh) b = static_cast<std::uint8_t>(random());
  s.welds = {{1, 0}, {2, 0}, {17, 3}, {118, 117}, {119, 0}};
  s.has_normals = s.has_colors = true;
  s.loose_vertices = {{{0, 0, 0}, {0, 0, 1}, {0, 0, 0, 255}},
                      {{4095, 4095, 4095}, {-0.6f, 0.8f, 0}, {255, 254, 253, 0}},
                      {{0, 4095, 17}, {1e-30f, -1e30f, 0.5f}, {1, 2, 3, 4}}};
  s.loose_triangles = {{0, 0, 0}, {59, 0, 59}, {1, 2, 3}, {1, 2, 3}};
  s.harmonics = {20, 1, 1, 5, 3};
  s.handles_per_harmonic = 3;
  s.fingerprint = {123.5f, -1e-7f};
  s.order.resize(60);
  std::iota(s.order.begin(), s.order.end(), 0u);
  for (std::size_t i = 59; i > 0; --i) std::swap(s.order[i], s.order[random() % (i + 1)]);
  return s;
}

void ExpectSame(const IFrameSyntax& a, const IFrameSyntax& b) {
  EXPECT_EQ(a.mesh, b.mesh);
  EXPECT_EQ(a.position_step, b.position_step);
  EXPECT_EQ(a.position_slope, b.position_slope);
  ASSERT_EQ(a.welds.size(), b.welds.size());
  for (std::size_t i = 0; i < a.welds.size(); ++i) {
    EXPECT_EQ(a.welds[i].point, b.welds[i].point);
    EXPECT_EQ(a.welds[i].onto, b.welds[i].onto);
  }
  EXPECT_EQ(a.has_normals, b.has_normals);
  EXPECT_EQ(a.has_colors, b.has_colors);
  ASSERT_EQ(a.loose_vertices.size(), b.loose_vertices.size());
  for (std::size_t i = 0; i < a.loose_vertices.size(); ++i) {
    EXPECT_EQ(a.loose_vertices[i].position, b.loose_vertices[i].position);
    if (a.has_normals) {
      EXPECT_EQ(a.loose_vertices[i].normal, b.loose_vertices[i].normal);
    }
    if (a.has_colors) {
      EXPECT_EQ(a.loose_vertices[i].color, b.loose_vertices[i].color);
    }
  }
  EXPECT_EQ(a.loose_triangles, b.loose_triangles);
  EXPECT_EQ(a.harmonics, b.harmonics);
  EXPECT_EQ(a.handles_per_harmonic, b.handles_per_harmonic);
  EXPECT_EQ(a.fingerprint, b.fingerprint);
  EXPECT_EQ(a.order, b.order);
}

// Parses an I-frame without positions.
Status Parse(const Bytes& bytes, const SequenceHeader& header, IFrameSyntax& back) {
  RangeDecoder positions({});
  SAC_RETURN_IF_ERROR(ParseIFrame(bytes, header, back, positions));
  return positions.AtEnd() ? Status::Ok() : Status::Corrupt("wrong length");
}

Status Parse(const IFrameSyntax& syntax, const SequenceHeader& header = Header()) {
  IFrameSyntax back;
  return Parse(WriteIFrame(syntax, header), header, back);
}

TEST(IFrameSyntax, ComesBackWithEverything) {
  IFrameSyntax back;
  back.order = {1, 2, 3};  // what was there before is gone
  const Status status = Parse(WriteIFrame(Everything(), Header()), Header(), back);
  ASSERT_TRUE(status.ok()) << status.message();
  ExpectSame(Everything(), back);
}

TEST(IFrameSyntax, ComesBackWithAlmostNothing) {
  SequenceHeader header;
  header.vertices = header.harmonics = 1;
  header.position_bits = 1;
  IFrameSyntax least, back;
  least.harmonics = {1};
  ASSERT_TRUE(Parse(WriteIFrame(least, header), header, back).ok());
  ExpectSame(least, back);
}

TEST(IFrameSyntax, PositionsFollowInTheSameCode) {
  IFrameSyntax syntax = Everything(), back;
  BitModel model;
  std::uint32_t raw = 1234;
  for (const bool bin : {true, false, true}) {
    bool bit = bin;
    syntax.positions.Bit(model, bit);
    syntax.positions.Raw(raw, 11);
  }
  const Bytes bytes = WriteIFrame(syntax, Header());
  RangeDecoder positions({});
  ASSERT_TRUE(ParseIFrame(bytes, Header(), back, positions).ok());
  EXPECT_FALSE(positions.AtEnd());
  model = {};
  for (const bool bin : {true, false, true}) {
    bool bit = false;
    positions.Bit(model, bit);
    positions.Raw(raw, 11);
    EXPECT_EQ(bit, bin);
    EXPECT_EQ(raw, 1234u);
  }
  EXPECT_TRUE(positions.AtEnd());
}

TEST(IFrameSyntax, AttributesComeBackEachAlone) {
  for (const bool normals : {false, true}) {
    IFrameSyntax syntax = Everything(), back;
    syntax.has_normals = normals;
    syntax.has_colors = !normals;
    ASSERT_TRUE(Parse(WriteIFrame(syntax, Header()), Header(), back).ok());
    ExpectSame(syntax, back);
  }
}

TEST(IFrameSyntax, AnUnchangedOrderIsNearlyFree) {
  SequenceHeader header = Header();
  header.vertices = 5000;
  IFrameSyntax without = Everything(), with = Everything();
  without.order.clear();
  with.order.resize(5000);
  std::iota(with.order.begin(), with.order.end(), 0u);
  EXPECT_LT(WriteIFrame(with, header).size(), WriteIFrame(without, header).size() + 12);
}

TEST(IFrameSyntax, EveryRuleIsChecked) {
  IFrameSyntax s = Everything();
  s.order[3] = s.order[4];
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "not a permutation";
  s = Everything();
  s.harmonics = {20, 1, 1, 5, 2};
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "too few harmonics";
  s.harmonics = {20, 1, 1, 5, 4};
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "too many harmonics";
  s.harmonics = {20, 0, 2, 5, 3};
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "a component without harmonics";
  s.harmonics = {};
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "no component";
  s = Everything();
  s.welds.push_back({120, 0});
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "more points than Draco's triangles have corners";
  s = Everything();
  s.welds[2].onto = s.welds[2].point + 0x80000001u;  // 2^31 - 1 points back
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "a weld onto a point before the first";
  s = Everything();
  s.loose_vertices[1].position[2] = 4096;
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "off the grid";
  s = Everything();
  s.loose_triangles[2][1] = 60;
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "a missing vertex";
  s = Everything();
  s.loose_triangles.resize(41);
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "more triangles than the header says";
  s = Everything();
  s.loose_vertices.resize(61);
  EXPECT_EQ(Parse(s).code(), StatusCode::kCorrupt) << "more vertices than the header says";
}

TEST(IFrameSyntax, PrefixesFailCleanly) {
  const Bytes bytes = WriteIFrame(Everything(), Header());
  IFrameSyntax back;
  int accepted = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const Status status = Parse(prefix, Header(), back);
    if (!status.ok()) {
      EXPECT_EQ(status.code(), StatusCode::kCorrupt) << size;
      continue;
    }
    // Four bytes beyond the end are taken for zeros, so that a prefix may happen to be an I-frame, but not the same.
    EXPECT_NE(WriteIFrame(back, Header()), bytes) << size;
    ++accepted;
  }
  EXPECT_LE(accepted, 3);
}

TEST(IFrameSyntax, SurplusBytesAreRefused) {
  Bytes bytes = WriteIFrame(Everything(), Header());
  bytes.resize(bytes.size() + 5, 0x55);
  IFrameSyntax back;
  EXPECT_EQ(Parse(bytes, Header(), back).code(), StatusCode::kCorrupt);
}

TEST(IFrameSyntax, MutationsAreRefusedOrStayWithinTheHeader) {
  const SequenceHeader header = Header();
  const Bytes bytes = WriteIFrame(Everything(), header);
  std::mt19937 random(2);
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes changed = bytes;
    for (std::size_t j = random() % 4 + 1; j > 0; --j) {
      // Half of them within the last 100 bytes, where the mesh is not.
      const std::size_t at = i % 2 ? random() % changed.size() : changed.size() - 1 - random() % 100;
      changed[at] = static_cast<std::uint8_t>(random());
    }
    IFrameSyntax s;
    if (!Parse(changed, header, s).ok()) continue;
    ++accepted;
    std::uint32_t next = 0;
    for (const Weld& w : s.welds) {
      EXPECT_LT(w.onto, w.point);
      EXPECT_GE(w.point, next);
      EXPECT_LT(w.point, 3 * header.triangles);
      next = w.point + 1;
    }
    for (const LooseVertex& v : s.loose_vertices)
      EXPECT_LT(*std::max_element(v.position.begin(), v.position.end()), 4096u);
    for (const auto& t : s.loose_triangles) EXPECT_LT(*std::max_element(t.begin(), t.end()), header.vertices);
    EXPECT_LE(s.loose_vertices.size(), header.vertices);
    EXPECT_LE(s.loose_triangles.size(), header.triangles);
    EXPECT_EQ(std::accumulate(s.harmonics.begin(), s.harmonics.end(), 0u), header.harmonics);
    EXPECT_TRUE(std::find(s.harmonics.begin(), s.harmonics.end(), 0u) == s.harmonics.end());
    std::sort(s.order.begin(), s.order.end());
    for (std::uint32_t v = 0; v < s.order.size(); ++v) EXPECT_EQ(s.order[v], v);
  }
  EXPECT_GT(accepted, 1000);  // those within the mesh
}

}  // namespace
}  // namespace sac
