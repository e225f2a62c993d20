// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/files/clip_files.h"

namespace sac {
namespace {

using ClipSequenceTest = ClipFileTest;

constexpr Vec3d kFar = {500000, 5600000, 300};

// An OBJ of one triangle whose corners are at `at` + `shift` * (1, 0, 0) + multiples of 0.0001.
std::string FarObj(double shift) {
  std::string obj;
  for (int i = 0; i < 3; ++i) {
    char line[100];
    std::snprintf(line, sizeof line, "v %.4f %.4f %.4f\n", kFar[0] + shift + i, kFar[1] + 0.2939 * i, kFar[2] - 0.1341);
    obj += line;
  }
  return obj + "f 1 2 3\n";
}

TEST_F(ClipSequenceTest, AnOffsetKeepsWhatFloatWouldRound) {
  const auto clip = Open({directory_.Write("f0.obj", FarObj(0)), directory_.Write("f1.obj", FarObj(0.0371))});
  ASSERT_NE(clip, nullptr);
  EXPECT_EQ(clip->offset(), (std::array<double, 3>{500001, 5600000, 300}));
  EXPECT_EQ(Told(*clip), Warnings{});
  Positions frame;
  bool end = false;
  for (const double shift : {0.0, 0.0371}) {
    ASSERT_TRUE(clip->Next(frame, end).ok());
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(frame[i][0], shift + i - 1, 1e-7);
      EXPECT_NEAR(frame[i][1], 0.2939 * i, 1e-7);
      EXPECT_NEAR(frame[i][2], -0.1341, 1e-7);
    }
  }
  EXPECT_EQ(Told(*clip), Warnings{});
}

TEST_F(ClipSequenceTest, NoOffsetWhereFloatHoldsTheCoordinates) {
  const auto clip = Open({directory_.Write("a.obj", "v 10 0.1 0\nv 11 0 0\nv 10 1 0\nf 1 2 3\n")});
  EXPECT_EQ(clip->offset(), (std::array<double, 3>{}));
  EXPECT_EQ(clip->mesh().positions[0], (Vec3f{10, 0.1F, 0}));
  const auto point = Open({directory_.Write("p.obj", "v 5600000 0 0\n")});
  EXPECT_EQ(point->offset(), (std::array<double, 3>{}));
}

TEST_F(ClipSequenceTest, AnOffsetMayBeGiven) {
  const auto clip = Open({directory_.Write("a.obj", "v 3 4 5\n")}, {.offset = {{1, 1, 2}}});
  EXPECT_EQ(clip->offset(), (std::array<double, 3>{1, 1, 2}));
  EXPECT_EQ(clip->mesh().positions[0], (Vec3f{2, 3, 3}));
  const auto cache =
      Open({WriteObj("b.obj", 0), WriteCache("b.pc2", {Positions(3, {5, 0, 0}), Positions(3, {7, 0, 0})})},
           {.offset = {{1, 0, 0}}});
  Positions frame;
  bool end = false;
  for (const float x : {4.0F, 6.0F}) {
    ASSERT_TRUE(cache->Next(frame, end).ok());
    EXPECT_EQ(frame[0][0], x);
  }
}

TEST_F(ClipSequenceTest, CoarseFloatsAreTold) {
  const Positions far = {{5600000, 0, 0}, {5600001, 2, 0}, {5600000, 0, 1}};
  const auto cache = Open({WriteObj("a.obj", 0), WriteCache("a.pc2", {far})});
  EXPECT_EQ(Told(*cache), (Warnings{"a.pc2: float32 has steps of 0.5 at its distance from the origin; move the mesh to "
                                    "the origin before the export"}));
  const auto stl = Open({directory_.Write("a.stl", Stl({far})), directory_.Write("b.stl", Stl({far}))});
  EXPECT_EQ(Told(*stl), (Warnings{"a.stl: float32 has steps of 0.5 at its distance from the origin; move the mesh to "
                                  "the origin before the export"}));
}

TEST_F(ClipSequenceTest, CoarseFloatsOfLaterFramesAreTold) {
  const Positions here = {{0, 0, 0}, {1, 2, 0}, {0, 0, 1}};
  Positions far = here, small = here;
  for (Vec3f& p : far) p[0] += 5600000;
  // Shrunk to a thousandth at ten times its size, nothing is lost that was to be seen.
  for (Vec3f& p : small) p = {20 + p[0] / 1000, p[1] / 1000, p[2] / 1000};
  const auto cache = Open({WriteObj("a.obj", 0), WriteCache("a.pc2", {here, small, far, far})});
  EXPECT_EQ(Frames(*cache).size(), 4U);
  EXPECT_EQ(Told(*cache),
            (Warnings{"a.pc2: frame 2: float32 has steps of 0.5 at its distance from the origin; move the "
                      "mesh to the origin before the export"}));
}

TEST_F(ClipSequenceTest, ChangesOfAttributesAreToldOnce) {
  const auto obj = [&](const std::string& name, const std::string& color, const std::string& uv,
                       const std::string& normal) {
    return directory_.Write(name, "v 0 0 0 " + color + "\nv 1 0 0 " + color + "\nv 0 1 0 " + color + "\nv 1 1 0 " +
                                      color + "\nvt 0 0\nvt 1 " + uv + "\nvn 0 0 1\nvn " + normal +
                                      "\nf 1/1/1 2/2/1 3/1/1\nf 3/1/2 2/2/2 4/1/2\n");
  };
  const auto clip = Open({obj("f0.obj", "1 0 0", "0", "0 0 1"), obj("f1.obj", "0 1 0", "0", "0 0 1"),
                          obj("f2.obj", "0 0 1", "1", "0 1 0"), obj("f3.obj", "0 0 1", "0.5", "1 0 0")});
  EXPECT_EQ(Told(*clip), Warnings{});
  const Warnings expected = {
      "f1.obj: its colors are not those of f0.obj, which every frame gets",
      "f2.obj: its texture coordinates are not those of f0.obj, which every frame gets",
      "f2.obj: its hard edges (corners with normals of their own) are not those of f0.obj, which every frame gets"};
  for (int pass = 0; pass < 2; ++pass) {
    EXPECT_EQ(Frames(*clip).size(), 4U);
    EXPECT_EQ(Told(*clip), expected);
    ASSERT_TRUE(clip->Rewind().ok());
  }
  // Normals that turn with the shape are no change, and neither is their order in the file.
  const std::string turned =
      directory_.Write("t.obj",
                       "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 0 1 1 0 0\nv 1 0 1 1 0 0\nvt 1 0\nvt 0 0\nvn 0 -1 0\n"
                       "f 1/2/1 2/1/1 3/2/1\nf 3/2/1 2/1/1 4/2/1\n");
  const auto same = Open({directory_.Path("f0.obj"), turned});
  EXPECT_EQ(Frames(*same).size(), 2U);
  EXPECT_EQ(Told(*same), Warnings{});
}

TEST_F(ClipSequenceTest, WhatTheFirstFileLosesIsTold) {
  const auto clip = Open({directory_.Write("a.obj", "g x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")});
  EXPECT_EQ(Told(*clip), (Warnings{"a.obj: 1 quad is triangulated; groups (1) are not kept"}));
}

TEST_F(ClipSequenceTest, AMovingQuadKeepsItsTriangles) {
  const std::string face = "f 1 2 3 4\n";
  const auto clip = Open({directory_.Write("f0.obj", "v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\n" + face),
                          directory_.Write("f1.obj", "v 0 0 0\nv 4 2 0\nv 1 2 0\nv 0 4 0\n" + face)});
  EXPECT_EQ(Frames(*clip).size(), 2U);
  // Other faces of the same triangles are another topology.
  const auto other = Open({directory_.Write("g0.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
                           directory_.Write("g1.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")});
  Positions frame;
  bool end = false;
  ASSERT_TRUE(other->Next(frame, end).ok());
  EXPECT_EQ(Short(other->Next(frame, end).message()), "g1.obj: its faces are not those of g0.obj");
}

TEST_F(ClipSequenceTest, WhatALaterFileLosesIsTold) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto clip = Open({directory_.Write("f0.obj", triangle), directory_.Write("f1.obj", "g arm\n" + triangle),
                          directory_.Write("f2.obj", "g arm\n" + triangle)});
  EXPECT_TRUE(Told(*clip).empty());
  EXPECT_EQ(Frames(*clip).size(), 3U);
  EXPECT_EQ(Told(*clip), Warnings{"f1.obj: groups (1) are not kept"});  // once
}

// Two triangles with a common edge, the second moved by `x`.
std::vector<Positions> Hinge(float x) {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0 + x, 1, 0}, {1 + x, 0, 0}, {1 + x, 1, 0}}};
}

TEST_F(ClipSequenceTest, StlIsWeldedOverTheClip) {
  const auto path = [&](const std::string& name, float x) { return directory_.Write(name, Stl(Hinge(x))); };
  const std::string apart = path("apart.stl", 1);
  // In all frames together: four vertices. Where one frame parts them, whichever it is: six.
  const auto hinge = Open({path("f0.stl", 0), path("f1.stl", 0)});
  EXPECT_EQ(hinge->mesh().triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(Told(*hinge), Warnings{});
  const std::vector<Triangle> loose = {{0, 1, 2}, {3, 4, 5}};
  for (const auto& [paths, where] : {std::pair{std::vector{directory_.Path("f0.stl"), apart}, 1U},
                                     {std::vector{apart, directory_.Path("f0.stl")}, 0U}}) {
    const auto clip = Open(paths);
    EXPECT_EQ(clip->mesh().triangles, loose);
    const std::vector<Positions> frames = Frames(*clip);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[where][3], (Vec3f{1, 1, 0}));
    EXPECT_EQ(frames[1 - where][3], (Vec3f{0, 1, 0}));
    EXPECT_EQ(Told(*clip), where == 1 ? Warnings{"f0.stl: corners of triangles that meet in it part in later frames: 6 "
                                                 "vertices and not 4"}
                                      : Warnings{});
  }
}

TEST_F(ClipSequenceTest, StlErrors) {
  const std::string first = directory_.Write("f0.stl", Stl(Hinge(0)));
  const std::string shorter = directory_.Write("f1.stl", Stl({Hinge(0)[0]}));
  EXPECT_EQ(OpenError({first, shorter}), "f1.stl: 1 triangles, but f0.stl has 2");
  const std::string broken = directory_.Write("f2.stl", Stl(Hinge(std::nanf(""))));
  EXPECT_EQ(OpenError({first, broken}), "f2.stl: triangle 1, corner 0: not a finite number");
}

}  // namespace
}  // namespace sac
