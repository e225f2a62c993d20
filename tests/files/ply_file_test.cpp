// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/files/mesh_files.h"

namespace sac {
namespace {

using PlyFileTest = MeshFileTest;

enum class Format { kAscii, kLittle, kBig };

// The bytes of `value` as a number of the type of that name.
std::string Number(Format format, const std::string& type, double value) {
  if (format == Format::kAscii) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g ", value);
    return text;
  }
  std::uint64_t bits = 0;
  std::size_t size = 0;
  if (type == "float" || type == "float32") {
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    size = 4;
  } else if (type == "double" || type == "float64") {
    bits = std::bit_cast<std::uint64_t>(value);
    size = 8;
  } else {
    bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    size = type.find("char") != std::string::npos || type.find("int8") != std::string::npos  ? 1
           : type.find("short") != std::string::npos || type.find("16") != std::string::npos ? 2
                                                                                             : 4;
  }
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) {
    bytes += static_cast<char>(bits >> (8 * (format == Format::kBig ? size - 1 - i : i)) & 0xFF);
  }
  return bytes;
}

std::string Header(Format format) {
  const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  return std::string("ply\nformat ") + names[static_cast<int>(format)] + " 1.0\n";
}

const std::string kIntegers[] = {"char",   "int8",   "uchar", "uint8", "short", "int16",
                                 "ushort", "uint16", "int",   "int32", "uint",  "uint32"};
const std::string kReals[] = {"float", "float32", "double", "float64"};

TEST_F(PlyFileTest, EveryTypeInEveryFormat) {
  for (const Format format : {Format::kAscii, Format::kLittle, Format::kBig}) {
    for (const std::string* types : {&kIntegers[0], &kReals[0]}) {
      for (std::size_t i = 0; i < (types == kIntegers ? std::size(kIntegers) : std::size(kReals)); ++i) {
        const std::string& type = types[i];
        const std::string count = kIntegers[i % std::size(kIntegers)];
        const std::string index = types == kIntegers ? type : "int";
        SCOPED_TRACE(Header(format) + type);
        // A list of it before the coordinates, a value of it after them.
        std::string ply = Header(format) + "element vertex 3\nproperty list " + count + " " + type +
                          " weights\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
                          " z\nproperty " + type + " quality\nelement face 1\nproperty " + type +
                          " flags\nproperty list " + count + " " + index + " vertex_indices\nend_header\n";
        for (int v = 0; v < 3; ++v) {
          ply += Number(format, count, 2) + Number(format, type, 7) + Number(format, type, 9);
          for (const double x : {1.0 + v, 100.0, 3.0, 5.0}) ply += Number(format, type, x);
        }
        ply += Number(format, type, 1) + Number(format, count, 3);
        for (const int v : {2, 0, 1}) ply += Number(format, index, v);
        const MeshFile file = ReadFile("a.ply", ply);
        EXPECT_EQ(file.mesh.positions, (Positions{{1, 100, 3}, {2, 100, 3}, {3, 100, 3}}));
        EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
        EXPECT_EQ(file.warnings,
                  (Warnings{"a.ply: vertex properties (weights, quality), face properties (flags) are not kept"}));
      }
    }
  }
}

TEST_F(PlyFileTest, SignsAndDigits) {
  for (const Format format : {Format::kAscii, Format::kLittle, Format::kBig}) {
    const std::string ply =
        Header(format) + "element vertex 1\nproperty double x\nproperty short y\nproperty uint z\n" + "end_header\n" +
        Number(format, "double", 5600000.2939) + Number(format, "short", -3) + Number(format, "uint", 4294967295.0);
    EXPECT_EQ(ReadFile("a.ply", ply).exact, (std::vector<Vec3d>{{5600000.2939, -3, 4294967295.0}}));
  }
  const std::string floats = Header(Format::kBig) + "element vertex 1\nproperty float x\nproperty float y\n" +
                             "property float z\nend_header\n" + std::string(12, '\0');
  EXPECT_TRUE(ReadFile("a.ply", floats).exact.empty());
}

std::string Triangle3(const std::string& properties, const std::string& row, const std::string& face = "",
                      const std::string& face_row = "") {
  std::string ply = Header(Format::kAscii) +
                    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + properties +
                    "element face 1\nproperty list uchar int vertex_index\n" + face + "end_header\n";
  for (const char* position : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) ply += position + row + "\n";
  return ply + "3 0 1 2 " + face_row + "\n";
}

TEST_F(PlyFileTest, AttributesUnderAllNames) {
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const Mesh mesh =
        Read("a.ply", Triangle3(std::string("property float ") + u + "\nproperty float " + v + "\n", "0.25 0.75"));
    EXPECT_EQ(mesh.uvs, (std::vector<std::array<float, 2>>{{0.25F, 0.75F}})) << u;
    EXPECT_EQ(mesh.uv_triangles, (std::vector<Triangle>{{0, 0, 0}}));
  }
  const Mesh mesh = Read("a.ply", Triangle3("property float nx\nproperty float ny\nproperty float nz\n", "0 0 1"));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>(3, {0, 0, 1})));
  for (const std::string names : {"red green blue alpha", "diffuse_red diffuse_green diffuse_blue alpha", "r g b a"}) {
    std::string properties, left = names + " ";
    for (auto at = left.find(' '); at != std::string::npos; left.erase(0, at + 1), at = left.find(' ')) {
      properties += "property uchar " + left.substr(0, at) + "\n";
    }
    EXPECT_EQ(Read("a.ply", Triangle3(properties, "255 1 0 7")).colors,
              (std::vector<std::array<std::uint8_t, 4>>(3, {255, 1, 0, 7})))
        << names;
  }
}

TEST_F(PlyFileTest, ColorsOfOtherTypesAreRounded) {
  const auto colors = [&](const std::string& type, const std::string& row, Warnings& warnings) {
    const MeshFile file = ReadFile(
        "a.ply",
        Triangle3("property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n", row));
    warnings = file.warnings;
    return file.mesh.colors.at(0);
  };
  const Warnings finer = {"a.ply: colors finer than 8 bits (3) are not kept"};
  Warnings warnings;
  EXPECT_EQ(colors("ushort", "65535 32768 257", warnings), (std::array<std::uint8_t, 4>{255, 128, 1, 255}));
  EXPECT_EQ(warnings, finer);
  EXPECT_EQ(colors("ushort", "65535 514 257", warnings), (std::array<std::uint8_t, 4>{255, 2, 1, 255}));
  EXPECT_EQ(warnings, Warnings{});
  EXPECT_EQ(colors("float", "1 0.5 0.2", warnings), (std::array<std::uint8_t, 4>{255, 128, 51, 255}));
  EXPECT_EQ(warnings, finer);
  EXPECT_EQ(colors("double", "255 17 3", warnings), (std::array<std::uint8_t, 4>{255, 17, 3, 255}));
  EXPECT_EQ(warnings, Warnings{});
  EXPECT_EQ(colors("int", "255 17 3", warnings), (std::array<std::uint8_t, 4>{255, 17, 3, 255}));
}

TEST_F(PlyFileTest, OtherElementsAndSecondUvsAreTold) {
  std::string ply = Triangle3(
      "property float s\nproperty float t\nproperty float u\nproperty float v\n"
      "property uchar red\nproperty uchar alpha\n",
      "0 1 2 3 4 5", "property uchar red\nproperty list uchar float texcoord\n", "200 6 0 0 1 0 0 1");
  ply.insert(ply.find("end_header"),
             "element edge 2\nproperty int vertex1\nproperty int vertex2\nelement tristrips 1\n"
             "property list int int vertex_indices\nelement material 0\nproperty int x\nobj_info x\n");
  ply += "0 1\n1 2\n4 0 1 2 -1\n";
  const MeshFile file = ReadFile("a.ply", ply);
  EXPECT_EQ(file.mesh.uvs, (std::vector<std::array<float, 2>>{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_TRUE(file.mesh.colors.empty());
  EXPECT_EQ(file.warnings,
            (Warnings{"a.ply: vertex properties (u, v, red, alpha), face properties (red), elements (edge, tristrips), "
                      "texture coordinates of vertices beside those of corners (3) are not kept"}));
}

TEST_F(PlyFileTest, FacesMayComeFirst) {
  const std::string ply = Header(Format::kAscii) +
                          "element face 1\nproperty list uchar int vertex_indices\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nend_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(Read("a.ply", ply).triangles, (std::vector<Triangle>{{2, 1, 0}}));
}

TEST_F(PlyFileTest, LineEndsOfHeaders) {
  const std::string lines[] = {"ply",
                               "format binary_little_endian 1.0",
                               "element vertex 1",
                               "property uchar x",
                               "property uchar y",
                               "property uchar z",
                               "end_header"};
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    std::string ply;
    for (const std::string& line : lines) ply += line + end;
    // The first byte of the data would be the LF of a CRLF.
    EXPECT_EQ(Read("a.ply", ply + "\n\x05\x06").positions, (Positions{{10, 5, 6}}));
  }
  std::string ascii = "\xEF\xBB\xBF" + Triangle3("", "");
  for (auto at = ascii.find('\n'); at != std::string::npos; at = ascii.find('\n')) ascii.replace(at, 1, "\xC2\x85");
  EXPECT_EQ(Read("a.ply", ascii).triangles.size(), 1U);
}

TEST_F(PlyFileTest, ThePlaceOfWhatIsNotFinite) {
  std::string ply = Triangle3("", "");
  ply.replace(ply.find("1 0 0"), 5, "1 nan 0");
  EXPECT_EQ(ReadFile("a.ply", ply).not_finite, "line 11, vertex 1: nan");
  const std::string binary = Header(Format::kLittle) + "element vertex 1\nproperty float x\nproperty float y\n" +
                             "property float z\nend_header\n" + std::string(8, '\0') + LittleFloat(std::nanf(""));
  EXPECT_EQ(ReadFile("a.ply", binary).not_finite, "vertex 0");
}

}  // namespace
}  // namespace sac
