// SPDX-License-Identifier: Apache-2.0
// What mesh files hold of normals of corners and of an offset.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <sstream>

#include "files/mesh_file.h"
#include "tests/files/mesh_files.h"
#include "tests/hard_cube.h"

namespace sac {
namespace {

using MeshOutputTest = MeshFileTest;

TEST_F(MeshOutputTest, NormalsOfCornersStandInObjAlone) {
  const Mesh cube = HardCubeMesh();
  const auto format = [&](const std::string& name, std::string& warning) {
    std::string bytes;
    Warnings warnings;
    EXPECT_TRUE(FormatMesh(name, cube, {}, bytes, warnings).ok());
    warning = warnings.empty() ? "" : warnings.front();
    return bytes;
  };
  std::string warning;
  const std::string obj = format("a.obj", warning);
  EXPECT_EQ(warning, "");
  EXPECT_NE(obj.find("vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\n"), std::string::npos);
  EXPECT_NE(obj.find("\nf 1//1 2//1 4//1\nf 1//1 4//1 3//1\nf 5//2 7//2 8//2\n"), std::string::npos);
  for (const std::string name : {"a.ply", "a.off"}) {
    const Mesh back = Read(name, format(name, warning));
    EXPECT_EQ(warning, name +
                           ": corners of a vertex have normals of their own, which the format cannot hold; written "
                           "without. OBJ holds them");
    EXPECT_TRUE(back.normals.empty());
    EXPECT_EQ(back.triangles, cube.triangles);
  }
  // Corners that agree are a vertex's.
  Mesh smooth = cube;
  smooth.normals.assign(6, {0, 0, 1});
  std::string bytes;
  Warnings warnings;
  ASSERT_TRUE(FormatMesh("b.ply", smooth, {}, bytes, warnings).ok());
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(Read("b.ply", bytes).normals, std::vector<Vec3f>(8, {0, 0, 1}));
}

TEST_F(MeshOutputTest, UvsAndNormalsOfCornersTogether) {
  Mesh mesh = HardCubeMesh();
  mesh.uvs = {{0, 0}, {1, 0}, {0.5F, 1}};
  mesh.uv_triangles.assign(12, {0, 1, 2});
  std::string bytes;
  Warnings warnings;
  ASSERT_TRUE(FormatMesh("a.obj", mesh, {}, bytes, warnings).ok());
  EXPECT_NE(bytes.find("\nf 1/1/1 2/2/1 4/3/1\n"), std::string::npos);
  EXPECT_TRUE(warnings.empty());
  // A vertex has another place in the texture at each corner.
  ASSERT_TRUE(FormatMesh("a.off", mesh, {}, bytes, warnings).ok());
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[1],
            "a.off: texture coordinates have seams, which the format cannot hold; written without. OBJ holds them");
}

TEST_F(MeshOutputTest, AnOffsetIsAddedInDoublePrecision) {
  Mesh mesh;
  mesh.positions = {{0.1F, 0.25F, 1}, {-0.3F, 1e-7F, 2}, {1, 0, 1e-7F}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.colors = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}};
  const std::array<double, 3> offset = {5600000, -500000.5, 0};
  std::string bytes;
  Warnings warnings;
  const auto sum = [&](std::size_t v, std::size_t a) { return offset[a] + static_cast<double>(mesh.positions[v][a]); };
  for (const std::string name : {"a.obj", "a.off"}) {
    ASSERT_TRUE(FormatMesh(name, mesh, offset, bytes, warnings).ok());
    std::istringstream text(bytes);
    std::string line;
    for (int skipped = 0; name == "a.off" && skipped < 2; ++skipped) std::getline(text, line);
    for (std::size_t v = 0; v < 3; ++v) {
      std::getline(text, line);
      std::istringstream words(name == "a.obj" ? line.substr(2) : line);
      for (std::size_t a = 0; a < 2; ++a) {
        double x = 0;
        words >> x;
        EXPECT_EQ(x, sum(v, a)) << name;
      }
    }
    const Mesh back = Read(name, bytes);
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(back.normals, mesh.normals);
    EXPECT_EQ(back.colors, mesh.colors);
  }
  ASSERT_TRUE(FormatMesh("a.ply", mesh, offset, bytes, warnings).ok());
  const std::size_t vertices = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("property double x\nproperty double y\nproperty double z\nproperty float nx\n"),
            std::string::npos);
  for (std::size_t v = 0; v < 3; ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      double x = 0;
      std::memcpy(&x, bytes.data() + vertices + (24 + 12 + 4) * v + 8 * a, sizeof x);
      EXPECT_EQ(x, sum(v, a));
    }
  }
  const Mesh back = Read("a.ply", bytes);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.colors, mesh.colors);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace sac
