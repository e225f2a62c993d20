// SPDX-License-Identifier: Apache-2.0
// Decodes the vectors of conformance/ and compares the results with the manifest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "conformance/coefficients.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "geometry/bounding_box.h"
#include "sac/decoder.h"
#include "sac/version.h"

namespace sac {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

const std::filesystem::path kDirectory = SAC_CONFORMANCE;

Json ManifestOf(const std::filesystem::path& directory) {
  return Json::parse(std::ifstream(directory / "manifest.json"));
}

const Json& Manifest() {
  static const Json manifest = ManifestOf(kDirectory);
  return manifest;
}

// The vectors of today, and those of the released versions that this decoder knows (golden/README.md).
std::vector<std::filesystem::path> Directories() {
  std::vector<std::filesystem::path> directories{kDirectory};
  for (const auto& entry : std::filesystem::directory_iterator(kDirectory / "golden")) {
    unsigned major = 0, minor = 0;
    if (std::sscanf(entry.path().filename().c_str(), "%u.%u", &major, &minor) != 2) continue;
    if (major == SAC_STREAM_VERSION_MAJOR && minor <= SAC_STREAM_VERSION_MINOR) directories.push_back(entry.path());
  }
  return directories;
}

Bytes Read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  return {text.begin(), text.end()};
}

struct Decoding {
  Decoder decoder;
  std::vector<DecodedFrame> frames;
  Status status;
};

Decoding Decode(const Bytes& bytes) {
  Decoding d;
  for (std::span<const std::uint8_t> rest(bytes); !rest.empty();) {
    d.status = d.decoder.Send(rest);
    if (!d.status.ok()) return d;
    DecodedFrame frame;
    while ((d.status = d.decoder.Receive(frame)).ok()) d.frames.push_back(frame);
    if (d.status.code() != StatusCode::kNeedMoreData) return d;
  }
  d.status = d.decoder.Finish();
  return d;
}

template <class Tuples>
std::string TuplesCrc32(const Tuples& tuples) {
  ByteWriter bytes;
  for (const auto& t : tuples) {
    for (const std::uint32_t v : t) bytes.U32(v);
  }
  char text[9];
  std::snprintf(text, sizeof text, "%08x", Crc32(bytes.bytes()));
  return text;
}

// Decodes a valid stream of `directory` and compares what comes with the manifest's `vector`.
void CheckValid(const std::filesystem::path& directory, const Json& vector) {
  const std::string file = vector.at("file");
  SCOPED_TRACE(directory / file);
  const Bytes bytes = Read(directory / file);
  EXPECT_LT(bytes.size(), 10000u);
  const Decoding d = Decode(bytes);
  ASSERT_TRUE(d.status.ok()) << d.status.message();
  const Mesh& mesh = *d.decoder.mesh();
  EXPECT_EQ(d.frames.size(), vector.at("frames"));
  Json segments = Json::array();
  for (const DecodedFrame& frame : d.frames) {
    if (frame.segment == segments.size()) segments.push_back({frame.index, frame.positions.size()});
  }
  EXPECT_EQ(segments.size() > 1 ? segments : Json(), vector.value("segments", Json()));
  EXPECT_EQ(mesh.positions.size(), vector.at("vertices"));
  EXPECT_EQ(mesh.triangles.size(), vector.at("triangles"));
  EXPECT_EQ(TuplesCrc32(mesh.triangles), vector.at("triangles_crc32"));
  EXPECT_EQ(mesh.uvs.size(), vector.value("uvs", 0u));
  EXPECT_EQ(mesh.normals.size(), vector.value("normals", 0u));
  EXPECT_EQ(mesh.normal_triangles.empty() ? "" : TuplesCrc32(mesh.normal_triangles),
            vector.value("normal_triangles_crc32", ""));
  const std::array<double, 3> none = {};
  EXPECT_EQ(d.decoder.info()->offset, vector.value("offset", none));
  EXPECT_EQ(mesh.uvs.empty() ? "" : TuplesCrc32(mesh.uv_triangles), vector.value("uv_triangles_crc32", ""));
  EXPECT_EQ(mesh.colors.empty() ? "" : TuplesCrc32(mesh.colors), vector.value("colors_crc32", ""));
  std::vector<std::array<std::uint32_t, 1>> order;
  for (const std::uint32_t i : d.decoder.order()) order.push_back({i});
  EXPECT_EQ(order.empty() ? "" : TuplesCrc32(order), vector.value("order_crc32", ""));

  std::uint32_t crc = 0;
  ASSERT_TRUE(CoefficientsCrc32(bytes, crc).ok());
  EXPECT_EQ(crc, std::stoul(vector.at("coefficients_crc32").get<std::string>(), nullptr, 16));

  // The tolerance of spec.md 8, plus the rounding to binary32 here and in the manifest.
  const double diagonal = BoundingBox(mesh.positions).diagonal();
  const double tolerance = 1e-6 * std::max(diagonal, static_cast<double>(d.decoder.info()->position_step));
  for (const Json& row : vector.at("positions")) {
    const auto& position = d.frames.at(row.at(0)).positions.at(row.at(1));
    for (std::size_t a = 0; a < 3; ++a) {
      const double expected = row.at(2 + a);
      EXPECT_NEAR(static_cast<double>(position[a]), expected, tolerance + std::abs(expected) * 0x1p-23) << row;
    }
  }
}

TEST(Conformance, ValidStreamsDecode) {
  for (const auto& directory : Directories()) {
    const Json manifest = ManifestOf(directory);
    for (const Json& vector : manifest.at("valid")) CheckValid(directory, vector);
  }
}

TEST(Conformance, InvalidStreamsAreRefused) {
  for (const auto& directory : Directories()) {
    const Json manifest = ManifestOf(directory);
    for (const Json& vector : manifest.at("invalid")) {
      const std::string file = vector.at("file"), wanted = vector.at("class");
      const Decoding d = Decode(Read(directory / file));
      const StatusCode code = wanted == "limit"         ? StatusCode::kLimit
                              : wanted == "unsupported" ? StatusCode::kUnsupported
                                                        : StatusCode::kCorrupt;
      EXPECT_EQ(d.status.code(), code) << directory / file << ": " << d.status.message();
    }
  }
}

// Every rule of spec.md 11 has a file, except for the rules that no stream of 10 kB can break.
TEST(Conformance, EveryRuleHasAFile) {
  std::set<std::string> rules, broken;
  std::ifstream spec(SAC_SPEC);
  for (std::string line; std::getline(spec, line);) {
    if (line.rfind("| R", 0) == 0) rules.insert(line.substr(2, line.find(' ', 2) - 2));
  }
  for (const Json& vector : Manifest().at("invalid")) broken.insert(vector.at("rule"));
  EXPECT_TRUE(broken.insert("R60").second);
  EXPECT_EQ(broken, rules);
}

// Prints the decoder's messages, so that a person can see that each file is refused for the intended reason.
TEST(Conformance, MessagesAreOfOneLine) {
  for (const Json& vector : Manifest().at("invalid")) {
    const Decoding d = Decode(Read(kDirectory / vector.at("file").get<std::string>()));
    EXPECT_EQ(d.status.message().find('\n'), std::string::npos);
    std::printf("%-40s %s\n", vector.at("file").get<std::string>().c_str(), d.status.message().c_str());
  }
}

}  // namespace
}  // namespace sac
