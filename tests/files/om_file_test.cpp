// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <string>

#include "tests/files/mesh_files.h"

namespace sac {
namespace {

// OM 2.2 (the B) of one triangle, as OpenMesh writes it: three edges, so six half-edges with next, vertex and face in
// bytes.
std::string Om() {
  std::string om = "OMTB" + Little32(3) + Little32(1) + Little32(3);
  const auto chunk = [&om](int entity, int type, int is_signed, int is_float, int dim) {
    const int bits = entity << 2 | type << 5 | is_signed << 9 | is_float << 10 | (dim - 1) << 11;
    om += static_cast<char>(bits & 0xFF);
    om += static_cast<char>(bits >> 8);
  };
  chunk(0, 0, 1, 1, 3);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) om += LittleFloat(x);
  chunk(6, 7, 1, 1, 3);
  om += std::string(
      "\2\1\0"
      "\5\0\377"
      "\4\2\0"
      "\1\1\377"
      "\0\0\0"
      "\3\2\377",
      18);
  chunk(0, 7, 1, 1, 1);
  om += std::string("\1\3\5", 3);
  chunk(2, 7, 1, 1, 1);
  om += '\0';
  chunk(7, 0, 0, 0, 1);
  return om;
}

TEST_F(MeshFileTest, OmHalfEdgesBecomeTriangles) {
  const Mesh mesh = Read("a.om", Om());
  EXPECT_EQ(mesh.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{1, 2, 0}}));
}

TEST_F(MeshFileTest, DamagedOmFails) {
  const std::string om = Om();
  for (std::size_t size = 0; size + 3 < om.size(); ++size) {
    Mesh mesh;
    const Status status = ReadMesh(directory_.Write("a.om", om.substr(0, size)), mesh);
    // Cut between two chunks it is a mesh of less, but never one with bad indices.
    EXPECT_TRUE(!status.ok() || mesh.triangles.empty()) << size;
  }
  EXPECT_EQ(Error("a.om", om.substr(0, 40)), "a.om: truncated");
  EXPECT_EQ(Error("a.om", om.substr(0, 15)), "a.om: not an OM file");
  // What is damaged is told by the status, not printed by OpenMesh.
  testing::internal::CaptureStderr();
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    std::string damaged = om;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    Mesh mesh;
    if (!ReadMesh(directory_.Write("a.om", damaged), mesh).ok()) continue;
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) EXPECT_LT(v, mesh.positions.size());
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(MeshFileTest, OmPropertiesThatAreNotKeptAreTold) {
  std::string om = Om();
  // Before the sentinel: colors of faces (entity 2, type 4, dimension 3), and a custom property of vertices (type 6)
  // with the name "a", a type "f" and two bytes.
  om.insert(om.size() - 2, std::string("\x88\x10\1\2\3", 5) + std::string("\xC2\0\1a\1f", 6) + Little32(2) + "xy");
  const MeshFile file = ReadFile("a.om", om);
  EXPECT_EQ(file.mesh.triangles.size(), 1U);
  EXPECT_EQ(file.warnings, (Warnings{"a.om: colors of faces (1), custom properties of vertices (1) are not kept"}));
}

}  // namespace
}  // namespace sac
