// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/files/mesh_files.h"

namespace sac {
namespace {

// A non-manifold edge (three triangles at 0-1), a degenerate and a duplicate triangle, a flipped one, an isolated
// vertex.
const std::vector<Triangle> kNastyTriangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {0, 0, 1}, {0, 1, 2}, {2, 1, 0}};
constexpr std::size_t kNastyVertices = 6;

TEST_F(MeshFileTest, ObjKeepsNastyTriangles) {
  const Mesh mesh = Read("a.obj",
                         "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 9 9 9\n"
                         "f 1 2 3\nf 1 2 4\nf 2 1 5\nf 1 1 2\nf 1 2 3\nf 3 2 1\n");
  EXPECT_EQ(mesh.triangles, kNastyTriangles);
  ASSERT_EQ(mesh.positions.size(), kNastyVertices);
  EXPECT_EQ(mesh.positions[5], (Vec3f{9, 9, 9}));
}

TEST_F(MeshFileTest, PlyAndOffKeepNastyTriangles) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n9 9 9\n";
  const std::string faces = "3 0 1 2\n3 0 1 3\n3 1 0 4\n3 0 0 1\n3 0 1 2\n3 2 1 0";
  const std::string ply_header =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Mesh& mesh :
       {Read("a.ply", ply_header + vertices + faces), Read("a.off", "OFF\n6 6 0\n" + vertices + faces)}) {
    EXPECT_EQ(mesh.triangles, kNastyTriangles);
    ASSERT_EQ(mesh.positions.size(), kNastyVertices);
    EXPECT_EQ(mesh.positions[5], (Vec3f{9, 9, 9}));
  }
}

TEST_F(MeshFileTest, StlWeldsAndKeepsDegenerateTriangles) {
  const float corners[3][3][3] = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {1, 0, 0}, {-0.0F, 0, 0}}, {{1, 0, 0}, {1, 0, 0}, {2, 2, 2}}};
  std::string binary = "solid, but binary" + std::string(63, ' ') + Little32(3);
  std::string ascii = "solid outer space\n";
  for (const auto& triangle : corners) {
    binary += std::string(12, '\0');
    ascii += "facet normal 0 0 1\nouter loop\n";
    for (const auto& corner : triangle) {
      ascii += "vertex";
      for (const float x : corner) {
        binary += LittleFloat(x);
        ascii += ' ';
        ascii += std::to_string(x);
      }
      ascii += "\r\n";
    }
    binary += std::string(2, '\0');
    ascii += "endloop\nendfacet\n";
  }
  ascii += "endsolid\n";
  const std::vector<Triangle> expected = {{0, 1, 2}, {2, 1, 0}, {1, 1, 3}};
  EXPECT_EQ(Read("b.stl", binary).triangles, expected);
  EXPECT_EQ(Read("a.STL", ascii).triangles, expected);
  EXPECT_EQ(Read("a.stl", ascii).positions[3], (Vec3f{2, 2, 2}));

  EXPECT_NE(Error("b.stl", binary.substr(0, 200)).find("neither ASCII STL nor binary STL"), std::string::npos);
  EXPECT_EQ(Error("b.stl", binary.substr(8, 9)).find("b.stl: neither ASCII"), 0U);
  EXPECT_EQ(Error("a.stl", ascii.substr(0, ascii.size() - 30)), "a.stl: ends before endsolid");
  EXPECT_EQ(Error("a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 x\n"), "a.stl: line 4: not a number: x");
  EXPECT_EQ(Error("a.stl", "solid\nfacet\nvertex 0 0 0\nendfacet\nendsolid"), "a.stl: line 4: a facet of 1 vertices");
  EXPECT_EQ(Error("a.stl", "solid\nendsolid\n"), "a.stl: no vertices");
}

TEST_F(MeshFileTest, StlNaNIsNotWeldedAway) {
  std::string binary = std::string(80, ' ') + Little32(1) + std::string(12, '\0');
  for (const float x : {0.F, 0.F, 0.F, std::nanf(""), 0.F, 0.F, 1.F, 0.F, 0.F}) binary += LittleFloat(x);
  const Mesh mesh = Read("n.stl", binary + std::string(2, '\0'));
  ASSERT_EQ(mesh.positions.size(), 3U);
  EXPECT_TRUE(std::isnan(mesh.positions[1][0]));
}

TEST_F(MeshFileTest, PolygonsBecomeFans) {
  const std::vector<Triangle> expected = {{4, 0, 1}, {4, 1, 2}, {4, 2, 3}};
  EXPECT_EQ(Read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nf 5 1 2 3 4\nf 1 2\n").triangles, expected);
  EXPECT_EQ(Read("a.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0 0\n5 4 0 1 2 3\n2 0 1\n").triangles, expected);
}

TEST_F(MeshFileTest, ObjSyntax) {
  // CRLF, negative and forward indices, continued lines, unknown statements, comments, "+", a missing final line end.
  const Mesh mesh = Read("a.obj",
                         "mtllib /dev/zero\r\n# c \\\r\nv +1 2e0 .5 \r\nv 0 0 0\r\n\r\nf -2 -1 3 # c\r\n  v 0 0 1\r\n"
                         "usemtl x\r\nf 1 2\\\r\n 3\r\nf 1/ 2/ 3/");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.positions[0], (Vec3f{1, 2, 0.5F}));
}

TEST_F(MeshFileTest, ObjErrorsNameTheLine) {
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1 1 2\n"), "a.obj: line 2: vertex 2, but there are 1");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1 1 0\n"), "a.obj: line 2: index out of range: 0");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1 1 -2\n"), "a.obj: line 2: index out of range: -2");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1/1 1 1\n"), "a.obj: line 2: texture vertex 1, but there are 0");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1//7 1 1\n"), "a.obj: line 2: normal 7, but there are 0");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf /1 1 1\n"), "a.obj: line 2: not an index: ");
  EXPECT_EQ(Error("a.obj", "v 0 0 0\nf 1 1 99999999999999999999\n"),
            "a.obj: line 2: not an index: 99999999999999999999");
  EXPECT_EQ(Error("a.obj", "v 0 0\n"), "a.obj: line 1: expected 3 numbers");
  EXPECT_EQ(Error("a.obj", "v 0 0 0,5\n"),
            "a.obj: line 1: not a number: 0,5 (a decimal comma; export with decimal points)");
  EXPECT_EQ(Error("a.obj", "v 0 0 x,5\n"), "a.obj: line 1: not a number: x,5");
  EXPECT_EQ(Error("a.obj", "hello\n"), "a.obj: no vertices");
}

TEST_F(MeshFileTest, ObjNaNIsLeftToTheCaller) {
  const Mesh mesh = Read("a.obj", "v 0 0 0\nv nan -inf 1e99\n");
  EXPECT_TRUE(std::isnan(mesh.positions[1][0]));
  EXPECT_EQ(mesh.positions[1][1], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(mesh.positions[1][2], std::numeric_limits<float>::infinity());
}

TEST_F(MeshFileTest, FloatsAreTheNearest) {
  // Just above the middle of two float32; by way of a double it would be rounded to the even one below.
  const std::string text = "1.00000005960464477539062500000001 1e-45 1e-60";
  const Vec3f expected = {std::nextafter(1.0F, 2.0F), std::numeric_limits<float>::denorm_min(), 0};
  EXPECT_EQ(Read("a.obj", "v " + text).positions[0], expected);
  EXPECT_EQ(Read("a.off", "OFF 1 0 0\n" + text).positions[0], expected);
}

TEST_F(MeshFileTest, ObjSeamsNormalsAndColors) {
  const Mesh mesh = Read("a.obj",
                         "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 1\nv 0 1 0\nv 1 1 1 1 1 1\nvt 0 0\nvt 1 0\nvt 0 0\nvt 5 5 5\n"
                         "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 0 0 2\nf 1/1/2 2/2/1 3/3/3\nf 3/4/1 2/-2/2 1/2/2\n");
  EXPECT_EQ(mesh.uvs, (std::vector<std::array<float, 2>>{{0, 0}, {1, 0}, {5, 5}}));
  EXPECT_EQ(mesh.uv_triangles, (std::vector<Triangle>{{0, 1, 0}, {2, 0, 1}}));
  // An entry for each vertex and value: of the vertices 0, 1 and 2, the first two have two.
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.colors, (std::vector<std::array<std::uint8_t, 4>>{
                             {255, 128, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}, {255, 255, 255, 255}}));
}

// A binary PLY of one triangle; `extra` are header lines between the vertices' coordinates and the faces, with `more`
// as their bytes for each vertex.
std::string BinaryPly(const std::string& extra = "", const std::string& more = "") {
  std::string ply =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty float y\r\n"
      "property float z\r\n" +
      extra +
      "element face 1\r\nproperty list uchar uint vertex_index \r\ncomment x\r\n"
      "end_header\n";
  for (int i = 0; i < 3; ++i) ply += std::string("\0\0\0\0\0\0\xE0\x3F", 8) + LittleFloat(2) + LittleFloat(3) + more;
  return ply + std::string(1, 3) + Little32(0) + Little32(1) + Little32(2);
}

TEST_F(MeshFileTest, BinaryPly) {
  const Mesh mesh = Read("a.ply", BinaryPly());
  EXPECT_EQ(mesh.positions, (Positions(3, {0.5F, 2, 3})));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));

  // Lists and types that OpenMesh cannot skip by itself.
  const Mesh listed =
      Read("a.ply", BinaryPly("property list uchar float weights\nproperty ushort red\nproperty short u\n",
                              std::string(1, 2) + LittleFloat(1) + LittleFloat(2) + "abcd"));
  EXPECT_EQ(listed.triangles, mesh.triangles);
  EXPECT_EQ(listed.positions, mesh.positions);
  EXPECT_TRUE(listed.colors.empty());
  EXPECT_TRUE(listed.uvs.empty());
}

TEST_F(MeshFileTest, PlyWedgeTextureCoordinates) {
  const Mesh mesh =
      Read("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n3 2 1 0 6 0 1 1 0 0.5 0.5\n");
  EXPECT_EQ(mesh.uvs, (std::vector<std::array<float, 2>>{{0, 0}, {1, 0}, {0, 1}, {0.5F, 0.5F}}));
  EXPECT_EQ(mesh.uv_triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
}

TEST_F(MeshFileTest, EveryPrefixOfABinaryPlyFails) {
  const std::string ply = BinaryPly();
  for (std::size_t size = 0; size < ply.size(); ++size) {
    SCOPED_TRACE(size);
    EXPECT_EQ(Error("a.ply", ply.substr(0, size)).find("a.ply: "), 0U);
  }
}

TEST_F(MeshFileTest, WrongCounts) {
  const auto ply = [](const std::string& vertices, const std::string& faces, const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
  };
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(Read("a.ply", ply("3", "1", body)).triangles.size(), 1U);
  EXPECT_EQ(Error("a.ply", ply("3", "2", body)), "a.ply: face 1: truncated");
  EXPECT_EQ(Error("a.ply", ply("9", "1", body)), "a.ply: vertex 4: truncated");
  EXPECT_EQ(Error("a.ply", ply("-3", "1", body)).find("a.ply: header: -3 elements"), 0U);
  EXPECT_EQ(Error("a.ply", ply("3", "4000000000", body)).find("a.ply: header: 4000000000 elements"), 0U);
  EXPECT_EQ(Error("a.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n")), "a.ply: face 0: truncated");
  EXPECT_EQ(Error("a.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n-1 0 1 2\n")),
            "a.ply: face 0: line 13, a list of no length");
  EXPECT_EQ(Error("a.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
            "a.ply: face 0: vertex 3, but there are 3");
  EXPECT_EQ(Error("a.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")), "a.ply: face 0: no vertex -1");
  EXPECT_EQ(Error("a.ply", ply("3", "1", "0 0 0\n1 0 0\n0 0,5 0\n3 0 1 2\n")),
            "a.ply: vertex 2: line 12, not a number: 0,5 (a decimal comma; export with decimal points)");
  EXPECT_EQ(Error("a.ply", ply("3\nproperty list int double weird", "1", "4000000000 1")),
            "a.ply: vertex 0: truncated");
  EXPECT_EQ(Error("a.ply", ply("3\nproperty list float int weird", "1", body)),
            "a.ply: header: the list weird has no length");
  EXPECT_EQ(Error("a.ply", ply("3\nproperty int64 weird", "1", body)), "a.ply: header: type int64");
  EXPECT_EQ(Error("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n"), "a.ply: header: ends before end_header");

  EXPECT_EQ(Error("a.off", "OFF\n3 2 0\n" + body), "a.off: line 6: face 1: the file ends here");
  EXPECT_EQ(Error("a.off", "OFF\n3 4000000000 0\n" + body),
            "a.off: line 2: cannot have the count 4000000000 in 45 bytes");
  EXPECT_EQ(Error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
            "a.off: line 6: face 0: vertex -1, but there are 3");
  EXPECT_EQ(Error("a.off", "OFF\n"), "a.off: line 1: the file ends here");
  EXPECT_EQ(Error("a.off", "4OFF\n1 0 0\n0 0 0 0\n"), "a.off: line 1: not an OFF file of three dimensions");
  EXPECT_EQ(Error("a.off", "OFF BINARY\n1 0 0\n0 0 0 0\n"), "a.off: line 1: binary OFF; write OFF as text");
  EXPECT_EQ(Error("a.off", "off\n1 0 0\n0 0 0\n"), "a.off: line 1: not an OFF file");
}

TEST_F(MeshFileTest, OffCommentsAndColors) {
  const Mesh mesh = Read("a.off",
                         "COFF # cube\r\n\r\n# counts\r\n3 1 0\r\n0 0 0   255 0 7 9\n1 0 0  1 2 3 4 # c\n"
                         "0 1 0\t5 6 7 8\n3 0 1 2 # end");
  EXPECT_EQ(mesh.colors, (std::vector<std::array<std::uint8_t, 4>>{{255, 0, 7, 9}, {1, 2, 3, 4}, {5, 6, 7, 8}}));
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(MeshFileTest, OffPrefixesAndFaceColors) {
  // Position, normal, colour of three, texture coordinates; a row over two lines; faces with colours.
  const MeshFile file = ReadFile("a.off",
                                 "STCNOFF 3 2 # no edges\n0 0 0 0 0 1 0.2 0 1 0.5 0.25\n1 0 0\n0 0 1 0 0 1 0 1\n"
                                 "0 1.0000000001 0 0 0 1 0 0 1 0.5 0.25\n3 0 1 2 255 0 0\n3 2 1 0\n");
  EXPECT_EQ(file.mesh.normals, (std::vector<Vec3f>(3, {0, 0, 1})));
  EXPECT_EQ(file.mesh.colors[0], (std::array<std::uint8_t, 4>{51, 0, 255, 255}));
  EXPECT_EQ(file.mesh.uvs, (std::vector<std::array<float, 2>>{{0.5F, 0.25F}, {0, 1}}));
  EXPECT_EQ(file.mesh.uv_triangles, (std::vector<Triangle>{{0, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(file.exact[2][1], 1.0000000001);
  EXPECT_EQ(file.warnings, (Warnings{"a.off: colors of faces (1) are not kept"}));
  const MeshFile more = ReadFile("b.off", "OFF\n1 0 0\n0 0 0 7 7\n");
  EXPECT_EQ(more.warnings.at(0), "b.off: vertices with further numbers (1) are not kept");
  EXPECT_EQ(Error("c.off", "STOFF 1 0 0\n0 0 0\n"),
            "c.off: line 2: vertex 0: a vertex without its texture coordinates");
  EXPECT_EQ(ReadFile("d.off", "OFF 2 0 0\n0 0 0\n0 nan 0\n").not_finite, "line 3, vertex 1: nan");
}

TEST_F(MeshFileTest, StlInDoubleAndWhatItLoses) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 5600000.0001 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\n";
  const MeshFile ascii = ReadFile("a.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n");
  EXPECT_EQ(ascii.exact.at(1)[0], 5600000.0001);
  EXPECT_EQ(ascii.mesh.triangles, (std::vector<Triangle>(2, {0, 1, 2})));
  EXPECT_EQ(ascii.warnings, (Warnings{"a.stl: 2 objects become one mesh"}));
  const std::string binary = std::string(80, ' ') + Little32(1) + std::string(48, '\0') + "\x1F\x80";
  EXPECT_EQ(ReadFile("b.stl", binary).warnings,
            (Warnings{"b.stl: attribute bytes or colors of triangles (1) are not kept"}));
}

TEST_F(MeshFileTest, MissingEmptyDirectoryUnknown) {
  EXPECT_EQ(Error("a.obj", ""), "a.obj: the file is empty");
  EXPECT_EQ(Error("a.txt", "v 0 0 0").find("a.txt: not a mesh file by its name"), 0U);
  Mesh mesh;
  EXPECT_EQ(ReadMesh(directory_.Path("none.obj"), mesh).message(),
            directory_.Path("none.obj") + ": No such file or directory");
  std::filesystem::create_directory(directory_.Path("d.ply"));
  EXPECT_EQ(ReadMesh(directory_.Path("d.ply"), mesh).message(), directory_.Path("d.ply") + ": is a directory");
}

Mesh NastyMesh() {
  Mesh mesh;
  const float values[] = {0.1F, 1 / 3.0F, 1e-45F, 3.4e38F, -0.0F, 16777217.0F, 1e-30F, -123.456F};
  for (std::size_t i = 0; i < kNastyVertices; ++i) {
    mesh.positions.push_back({values[i], values[i + 1], values[i + 2]});
    mesh.normals.push_back({values[i + 2], values[i + 1], values[i]});
    mesh.colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(250 + i), 0, 17});
  }
  mesh.triangles = kNastyTriangles;
  return mesh;
}

TEST_F(MeshFileTest, RoundTrips) {
  Mesh mesh = NastyMesh();
  for (const bool seams : {false, true}) {
    if (seams) {
      mesh.uvs = {{0.1F, 0.9F}, {1 / 3.0F, 0}};
      // The degenerate triangle has a corner of each.
      mesh.uv_triangles = {{0, 1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 1, 1}, {0, 0, 0}};
    }
    for (const std::string name : {"a.obj", "a.ply", "a.off"}) {
      SCOPED_TRACE(name);
      const Status written = WriteMesh(directory_.Path(name), mesh);
      ASSERT_TRUE(written.ok()) << written.message();
      Mesh back;
      const Status read = ReadMesh(directory_.Path(name), back);
      ASSERT_TRUE(read.ok()) << read.message();
      EXPECT_EQ(std::memcmp(back.positions.data(), mesh.positions.data(), sizeof(Vec3f) * kNastyVertices), 0);
      EXPECT_EQ(back.normals, mesh.normals);
      EXPECT_EQ(back.colors, mesh.colors);
      EXPECT_EQ(back.triangles, mesh.triangles);
      const bool carried = seams && name == "a.obj";
      EXPECT_EQ(back.uvs, carried ? mesh.uvs : decltype(mesh.uvs){});
      EXPECT_EQ(back.uv_triangles, carried ? mesh.uv_triangles : decltype(mesh.triangles){});
    }
  }
}

TEST_F(MeshFileTest, SeamlessTextureCoordinatesInPlyAndOff) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  mesh.uvs = {{0.1F, 0.2F}, {1, 0}, {0, 1 / 3.0F}};
  mesh.uv_triangles = mesh.triangles;
  for (const std::string name : {"a.ply", "a.off"}) {
    ASSERT_TRUE(WriteMesh(directory_.Path(name), mesh).ok());
    Mesh back;
    ASSERT_TRUE(ReadMesh(directory_.Path(name), back).ok());
    EXPECT_EQ(back.uvs, mesh.uvs);
    EXPECT_EQ(back.uv_triangles, mesh.uv_triangles);
  }
}

TEST_F(MeshFileTest, AllColorBytesSurvive) {
  Mesh mesh;
  for (int i = 0; i < 256; ++i) {
    const auto c = static_cast<std::uint8_t>(i);
    mesh.positions.push_back({});
    mesh.colors.push_back({c, static_cast<std::uint8_t>(255 - c), 0, c});
  }
  for (const std::string name : {"a.obj", "a.ply", "a.off"}) {
    ASSERT_TRUE(WriteMesh(directory_.Path(name), mesh).ok());
    Mesh back;
    ASSERT_TRUE(ReadMesh(directory_.Path(name), back).ok());
    EXPECT_EQ(back.colors, mesh.colors) << name;
  }
}

TEST_F(MeshFileTest, WriteErrors) {
  EXPECT_EQ(WriteMesh(directory_.Path("a.stl"), NastyMesh()).message(),
            directory_.Path("a.stl") + ": meshes are written as .obj, .ply or .off");
  EXPECT_EQ(WriteMesh(directory_.Path("none/a.obj"), NastyMesh()).message(),
            directory_.Path("none/a.obj") + ": No such file or directory");
  EXPECT_EQ(directory_.FileCount(), 0U);
}

}  // namespace
}  // namespace sac
