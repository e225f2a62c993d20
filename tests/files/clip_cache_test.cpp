// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "files/byte_order.h"
#include "tests/files/clip_files.h"

namespace sac {
namespace {

using ClipCacheTest = ClipFileTest;

// A cache of `frames` frames of three points, x of all being the frame's number.
std::vector<Positions> Counting(std::size_t frames) {
  std::vector<Positions> positions;
  for (std::size_t f = 0; f < frames; ++f) {
    const auto x = static_cast<float>(f);
    positions.push_back({{x, 0, 0}, {x, 1, 0}, {x, 2, 0}});
  }
  return positions;
}

TEST_F(ClipCacheTest, WholeFramesOfATruncatedCacheAreSalvaged) {
  const std::string obj = WriteObj("a.obj", 0);
  for (const std::string name : {"a.pc2", "a.mdd"}) {
    WriteCache(name, Counting(5));
    std::string bytes = directory_.Read(name);
    const std::string path = directory_.Write(name, bytes.substr(0, bytes.size() - 50));
    const std::string what = name + ": header says 5 frames of 3 points, but the file has 3 whole frames and 22 bytes";
    EXPECT_EQ(OpenError({obj, path}), what);
    const auto clip = Open({obj, path}, {.skip_damage = true});
    EXPECT_EQ(Told(*clip), (Warnings{what + "; the first 3 frames are read"}));
    const std::vector<Positions> frames = Frames(*clip);
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[2][0][0], 2);
    // Not a whole frame is nothing to show.
    directory_.Write(name, bytes.substr(0, bytes.size() - 5 * 36 + 30));
    EXPECT_NE(OpenError({obj, path}, {.skip_damage = true}).find("0 whole frames and 30 bytes"), std::string::npos);
  }
}

TEST_F(ClipCacheTest, ACacheLongerThanItsHeaderSays) {
  const std::string obj = WriteObj("a.obj", 0);
  WriteCache("a.pc2", Counting(3));
  std::string bytes = directory_.Read("a.pc2");
  StoreLittle32(2, bytes.data() + 28);
  EXPECT_EQ(Frames(*Open({obj, directory_.Write("b.pc2", bytes)}, {.skip_damage = true})).size(), 2U);
  // A writer that crashed leaves no number of frames.
  StoreLittle32(0, bytes.data() + 28);
  const std::string path = directory_.Write("c.pc2", bytes);
  EXPECT_EQ(OpenError({obj, path}), "c.pc2: no frames");
  const auto clip = Open({obj, path}, {.skip_damage = true});
  EXPECT_EQ(Frames(*clip).size(), 3U);
  EXPECT_EQ(Told(*clip), (Warnings{"c.pc2: header says 0 frames of 3 points, but the file has 3 whole frames and 0 "
                                   "bytes; the first 3 frames are read"}));
}

TEST_F(ClipCacheTest, StartFrameAndSampleRateAreTold) {
  const std::string obj = WriteObj("a.obj", 0);
  WriteCache("a.pc2", Counting(2));
  std::string bytes = directory_.Read("a.pc2");
  EXPECT_EQ(Told(*Open({obj, directory_.Path("a.pc2")})), Warnings{});
  StoreLittleFloat(12.5F, bytes.data() + 20);
  StoreLittleFloat(0.25F, bytes.data() + 24);
  EXPECT_EQ(Told(*Open({obj, directory_.Write("a.pc2", bytes)})),
            (Warnings{"a.pc2: its start frame 12.5 is not kept; frames begin at 0",
                      "a.pc2: its sample rate 0.25 is not kept; it becomes 1"}));
}

TEST_F(ClipCacheTest, UnevenTimesAreTold) {
  const std::string obj = WriteObj("a.obj", 0);
  WriteCache("a.mdd", Counting(4));
  const std::string bytes = directory_.Read("a.mdd");
  const auto told = [&](const std::vector<float>& times) {
    std::string with = bytes;
    for (std::size_t f = 0; f < times.size(); ++f) StoreBigFloat(times[f], with.data() + 8 + 4 * f);
    return Told(*Open({obj, directory_.Write("a.mdd", with)}));
  };
  EXPECT_EQ(told({0, 1 / 30.0F, 2 / 30.0F, 3 / 30.0F}), Warnings{});
  // Far from 0, float32 rounds by more than a hundredth of a frame.
  EXPECT_EQ(told({0, 0, 0, 0}).size(), 1U);
  EXPECT_EQ(
      told({0, 0.5F, 0.75F, 1.5F}),
      (Warnings{"a.mdd: its times are uneven: frame 2 comes 0.25 s after the one before, the mean is 0.5 s; frames "
                "become even"}));
  EXPECT_EQ(told({1, 2, 3, 4}), (Warnings{"a.mdd: its first time 1 s is not kept; frames begin at 0 s"}));
}

// A grid of n by n vertices in the plane z = 0 and its triangles.
Mesh Grid(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n * n; ++i) {
    mesh.positions.push_back({static_cast<float>(i % n), static_cast<float>(i / n), 0});
    if (i % n + 1 == n || i / n + 1 == n) continue;
    mesh.triangles.push_back({i, i + 1, i + n});
    mesh.triangles.push_back({i + 1, i + n + 1, i + n});
  }
  return mesh;
}

TEST_F(ClipCacheTest, AnotherOrderOfVerticesIsSuspected) {
  const Mesh grid = Grid(12);
  const std::string obj = directory_.Path("grid.obj");
  ASSERT_TRUE(WriteMesh(obj, grid).ok());
  // Bent, ten times as large and with two vertices parked far away, the order is the same.
  Positions bent = grid.positions;
  for (Vec3f& p : bent) p = {10 * p[0], 8 * std::sin(p[1] / 4), 10 * std::cos(p[1] / 4)};
  bent[5] = bent[99] = {1e5F, 0, 0};
  EXPECT_EQ(Told(*Open({obj, WriteCache("same.pc2", {bent})})), Warnings{});
  Positions mixed = grid.positions;
  std::shuffle(mixed.begin(), mixed.end(), std::mt19937(1));
  EXPECT_EQ(
      Told(*Open({obj, WriteCache("mixed.pc2", {mixed})})),
      (Warnings{"mixed.pc2: edges of the mesh are many times as long in it: are the vertices of grid.obj in another "
                "order than those of the cache?"}));
}

}  // namespace
}  // namespace sac
