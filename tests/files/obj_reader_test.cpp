// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "tests/files/mesh_files.h"

namespace sac {
namespace {

using ObjReaderTest = MeshFileTest;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

const std::string kCube =
    "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\n"
    "vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\nvn 0 1 0\nvn 0 0 -1\nvn 0 0 1\n"
    "f 1//1 2//1 4//1 3//1\nf 5//2 7//2 8//2 6//2\nf 1//3 5//3 6//3 2//3\n"
    "f 3//4 4//4 8//4 7//4\nf 1//5 3//5 7//5 5//5\nf 2//6 6//6 8//6 4//6\n";

TEST_F(ObjReaderTest, PositionsAreDouble) {
  const MeshFile file = ReadFile("a.obj", "v 500000.4045 5600000.2939 300.8660\n");
  EXPECT_EQ(file.exact, (std::vector<Vec3d>{{500000.4045, 5600000.2939, 300.8660}}));
  EXPECT_EQ(file.mesh.positions[0][1], 5600000.5F);
}

TEST_F(ObjReaderTest, CornersOfACubeKeepTheirNormals) {
  const MeshFile file = ReadFile("a.obj", kCube);
  const Mesh& mesh = file.mesh;
  ASSERT_EQ(mesh.triangles.size(), 12U);
  ASSERT_EQ(mesh.normal_triangles.size(), 12U);
  // Three for each vertex, none of them shared by two vertices.
  ASSERT_EQ(mesh.normals.size(), 24U);
  std::set<std::pair<std::uint32_t, std::uint32_t>> owners;
  for (std::size_t j = 0; j < 12; ++j) {
    Vec3f expected{};
    expected[j / 4] = j / 2 % 2 == 0 ? -1.0F : 1.0F;
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.normals[mesh.normal_triangles[j][k]], expected);
      owners.insert({mesh.normal_triangles[j][k], mesh.triangles[j][k]});
    }
  }
  EXPECT_EQ(owners.size(), 24U);
  EXPECT_EQ(file.faces.ends, (std::vector<std::uint32_t>{4, 8, 12, 16, 20, 24}));
  EXPECT_EQ(file.warnings, (Warnings{"a.obj: 6 quads are triangulated"}));
}

TEST_F(ObjReaderTest, EqualNormalsOfCornersBecomeOneAVertex) {
  // Different indices of equal values; the vertex without a face has none.
  const Mesh mesh = Read("a.obj", kSquare + "vn 0 0 1\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//3\nf 3//3 2//2 1//2\n");
  EXPECT_TRUE(mesh.normal_triangles.empty());
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}}));
}

TEST_F(ObjReaderTest, FacesWithoutNormalsGetTheirPlanes) {
  const MeshFile file = ReadFile("a.obj", kSquare + "vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\n");
  ASSERT_EQ(file.mesh.normal_triangles.size(), 2U);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(file.mesh.normals[file.mesh.normal_triangles[0][k]], (Vec3f{1, 0, 0}));
    EXPECT_EQ(file.mesh.normals[file.mesh.normal_triangles[1][k]], (Vec3f{0, 0, 1}));
  }
  EXPECT_EQ(file.warnings,
            (Warnings{"a.obj: normals are missing on 1 of 2 faces; those get the normals of their planes"}));
}

TEST_F(ObjReaderTest, WhatIsNotKeptIsTold) {
  const std::string obj = "mtllib a.mtl\no Body\n" + kSquare +
                          "vt 0 0 0.5\nvt 1 0\nvt 1 1\ng a\nusemtl red\ns 1\nf 1/1 2/2 3/3 4/1\ng b\nusemtl red\n"
                          "s off\nf 1 2 3\no Head\ng a\nl 1 2\np 3\np 4\nvp 0 0\ncstype bezier\nhello 1\n"
                          "v 0 0 0 2\nvn 0 0 1\nf 1 2 3 4 5\nf 1 2\n";
  EXPECT_EQ(
      ReadFile("a.obj", obj).warnings,
      (Warnings{"a.obj: 1 quad and 1 larger polygon are triangulated; 1 face of fewer than three vertices left "
                "out; 2 objects become one mesh; material libraries (1), object names (2), third texture "
                "coordinates (1), groups (2), materials (1), smoothing groups (1), lines (1), points (2), "
                "free-form statements (2), statements (hello), weights of vertices (1), normals that no face uses "
                "(1) are not kept",
                "a.obj: texture coordinates are missing on 12 of 18 corners of triangles; those get 0 0"}));
  EXPECT_EQ(ReadFile("a.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 2 0\nf 1 2 3 4\n").warnings,
            (Warnings{"a.obj: 1 quad is triangulated",
                      "a.obj: 1 polygon with edges that cross or touch: triangles of it overlap; triangulate it before "
                      "the export"}));
  EXPECT_EQ(ReadFile("a.obj", kSquare + "vt 0 0\nf 1 2 3\n").warnings,
            (Warnings{"a.obj: texture coordinates that no face uses (1) are not kept"}));
  EXPECT_EQ(ReadFile("a.obj", "# a cube\n" + kSquare + "s off\nf 1 2 3\nf 1 3 4\n").warnings, Warnings{});
}

TEST_F(ObjReaderTest, Colors) {
  const MeshFile file = ReadFile("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0.2 0.4 0.6\nf 1 2 3\n");
  EXPECT_EQ(file.mesh.colors,
            (std::vector<std::array<std::uint8_t, 4>>{{255, 128, 0, 255}, {255, 255, 255, 255}, {51, 102, 153, 255}}));
  EXPECT_EQ(file.warnings, (Warnings{"a.obj: colors finer than 8 bits (1) are not kept",
                                     "a.obj: colors are missing on 1 of 3 vertices; those become white"}));
  const MeshFile bytes = ReadFile("a.obj", "v 0 0 0 255 0 7\nv 1 0 0 1 2 3\nv 0 1 0 9 9 9\nf 1 2 3\n");
  EXPECT_EQ(bytes.mesh.colors[1], (std::array<std::uint8_t, 4>{1, 2, 3, 255}));
  EXPECT_EQ(bytes.warnings, Warnings{});
  // Brighter than white, in numbers that are no bytes.
  const MeshFile bright = ReadFile("a.obj", "v 0 0 0 0 0 1.7\nv 1 0 0 1 0 1\nv 0 1 0 0.2 -3 0.4\nf 1 2 3\n");
  EXPECT_EQ(bright.mesh.colors,
            (std::vector<std::array<std::uint8_t, 4>>{{0, 0, 255, 255}, {255, 0, 255, 255}, {51, 0, 102, 255}}));
  EXPECT_EQ(bright.warnings, Warnings{"a.obj: colors beyond black and white (2) are not kept"});
}

TEST_F(ObjReaderTest, PolygonsFollowTheFirstFrame) {
  // A quad that is concave at corner 3, then at corner 2.
  const std::string face = "f 1 2 3 4\n";
  const MeshFile first = ReadFile("a.obj", "v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\n" + face);
  const std::string moved = "v 0 0 0\nv 4 2 0\nv 1 2 0\nv 0 4 0\n" + face;
  const MeshFile alone = ReadFile("b.obj", moved);
  const MeshFile later = ReadFile("b.obj", moved, {.first = &first});
  EXPECT_EQ(later.faces, first.faces);
  EXPECT_EQ(later.mesh.triangles, first.mesh.triangles);
  EXPECT_NE(alone.mesh.triangles, first.mesh.triangles);
}

TEST_F(ObjReaderTest, LinesOfEveryKindAndByteOrderMarks) {
  const std::string lines[] = {"v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 \\", "3"};
  for (const std::string end : {"\n", "\r", "\r\n", "\xC2\x85", "\xE2\x80\xA8", "\xE2\x80\xA9", "\v", "\f"}) {
    std::string obj = "\xEF\xBB\xBF";
    for (const std::string& line : lines) obj += line + end;
    EXPECT_EQ(Read("a.obj", obj).triangles, (std::vector<Triangle>{{0, 1, 2}}));
  }
  EXPECT_EQ(Error("a.obj", std::string("\xFF\xFEv\0 \0", 6)), "a.obj: text in UTF-16 or UTF-32; save it as UTF-8");
}

TEST_F(ObjReaderTest, ThePlaceOfWhatIsNotFinite) {
  EXPECT_EQ(ReadFile("a.obj", "v 0 0 0\n# c\nv 0 1.#IND 0\nv nan 0 0\n").not_finite, "line 3, vertex 1: 1.#IND");
  EXPECT_EQ(ReadFile("a.obj", "v 0 0 1e39\n").not_finite, "line 1, vertex 0: 1e39");
  EXPECT_EQ(ReadFile("a.obj", kSquare).not_finite, "");
}

TEST_F(ObjReaderTest, PointsAndSoupsAreTold) {
  EXPECT_EQ(
      ReadFile("a.obj", kSquare).warnings,
      (Warnings{"a.obj: no faces: its 4 vertices are coded each by itself; a mesh with faces takes far fewer bytes"}));
  const std::string soup = kSquare + "v 0 0 0\nv 1 1 0\nf 1 2 3\nf 5 6 4\n";
  EXPECT_EQ(
      ReadFile("a.obj", soup).warnings,
      (Warnings{"a.obj: no triangle shares a vertex with another: 6 vertices at 4 places; merge them (weld, merge "
                "by distance) before the export, for fewer bytes"}));
  EXPECT_EQ(ReadFile("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").warnings, Warnings{});
}

}  // namespace
}  // namespace sac
