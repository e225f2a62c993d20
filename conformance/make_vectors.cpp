// SPDX-License-Identifier: Apache-2.0
// make_vectors DIRECTORY writes all conformance vectors and their manifest into DIRECTORY, and the examples of appendix
// A into spec.md in the directory above. See README.md.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "conformance/appendix.h"
#include "conformance/coefficients.h"
#include "conformance/invalid_vectors.h"
#include "conformance/valid_vectors.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "sac/decoder.h"

namespace sac {
namespace {

using Json = nlohmann::ordered_json;

bool Write(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return static_cast<bool>(file.flush());
}

std::string Hex(std::uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

template <class Tuple>
std::string TuplesCrc32(const std::vector<Tuple>& tuples) {
  ByteWriter bytes;
  for (const Tuple& t : tuples) {
    for (const std::uint32_t v : t) bytes.U32(v);
  }
  return Hex(Crc32(bytes.bytes()));
}

std::optional<Json> Describe(const ValidVector& vector) {
  Decoder decoder;
  std::vector<DecodedFrame> frames;
  Json segments = Json::array();
  Status status;
  for (std::span<const std::uint8_t> rest(vector.stream); status.ok() && !rest.empty();) {
    status = decoder.Send(rest);
    for (DecodedFrame frame; status.ok() && (status = decoder.Receive(frame)).ok();) {
      if (frame.segment == segments.size()) segments.push_back({frame.index, frame.positions.size()});
      frames.push_back(frame);
    }
    if (status.code() == StatusCode::kNeedMoreData) status = Status::Ok();
  }
  if (status.ok()) status = decoder.Finish();
  std::uint32_t crc = 0;
  if (status.ok()) status = CoefficientsCrc32(vector.stream, crc);
  if (!status.ok()) {
    std::fprintf(stderr, "%s: %s\n", vector.name.c_str(), status.message().c_str());
    return {};
  }
  const Mesh& mesh = *decoder.mesh();
  Json json = {{"file", "valid/" + vector.name + ".sac"},
               {"covers", vector.covers},
               {"frames", frames.size()},
               {"vertices", mesh.positions.size()},
               {"triangles", mesh.triangles.size()},
               {"triangles_crc32", TuplesCrc32(mesh.triangles)},
               {"coefficients_crc32", Hex(crc)}};
  if (segments.size() > 1) json["segments"] = segments;
  if (const auto& offset = decoder.info()->offset; offset != std::array<double, 3>{}) json["offset"] = offset;
  if (!mesh.uvs.empty()) {
    json["uvs"] = mesh.uvs.size();
    json["uv_triangles_crc32"] = TuplesCrc32(mesh.uv_triangles);
  }
  if (!mesh.normals.empty()) json["normals"] = mesh.normals.size();
  if (!mesh.normal_triangles.empty()) json["normal_triangles_crc32"] = TuplesCrc32(mesh.normal_triangles);
  if (!mesh.colors.empty()) json["colors_crc32"] = TuplesCrc32(mesh.colors);
  if (!decoder.order().empty()) {
    std::vector<std::array<std::uint32_t, 1>> order;
    for (const std::uint32_t i : decoder.order()) order.push_back({i});
    json["order_crc32"] = TuplesCrc32(order);
  }
  json["positions"] = Json::array();
  std::vector<std::size_t> which = {0, frames.size() / 2, frames.size() - 1};
  if (frames.empty()) which.clear();
  which.erase(std::unique(which.begin(), which.end()), which.end());
  for (const std::size_t f : which) {
    const std::size_t count = frames[f].positions.size();
    std::vector<std::size_t> vertices = {0, count / 2, count - 1};
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::size_t v : vertices) {
      Json row = {f, v};
      for (const float x : frames[f].positions[v]) row.push_back(static_cast<double>(x));
      json["positions"].push_back(row);
    }
  }
  return json;
}

int Main(const std::filesystem::path& directory) {
  for (const char* part : {"valid", "invalid"}) {
    std::filesystem::remove_all(directory / part);
    std::filesystem::create_directories(directory / part);
  }
  Json manifest = {{"valid", Json::array()}, {"invalid", Json::array()}};
  bool good = true;
  for (const ValidVector& v : ValidVectors()) {
    const std::optional<Json> json = Describe(v);
    good = Write(directory / "valid" / (v.name + ".sac"), v.stream) && json && good;
    if (json) manifest["valid"].push_back(*json);
  }
  for (const InvalidVector& v : InvalidVectors()) {
    const std::string file = "invalid/" + v.rule + "_" + v.name + ".sac";
    good = Write(directory / file, v.stream) && good;
    manifest["invalid"].push_back({{"file", file}, {"rule", v.rule}, {"class", v.status}});
  }
  // The manifest has one line per vector, so that changes can be read as a diff.
  std::ofstream file(directory / "manifest.json");
  file << "{\n";
  for (const char* part : {"valid", "invalid"}) {
    file << "\"" << part << "\": [\n";
    for (std::size_t i = 0; i < manifest[part].size(); ++i) {
      file << manifest[part][i].dump() << (i + 1 < manifest[part].size() ? ",\n" : "\n");
    }
    file << (std::string(part) == "valid" ? "],\n" : "]\n");
  }
  file << "}\n";
  if (!UpdateAppendix(directory / ".." / "spec.md")) {
    std::fprintf(stderr, "make_vectors: spec.md has no appendix A to write\n");
    good = false;
  }
  return good && file.flush() ? 0 : 1;
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_vectors DIRECTORY\n");
    return 2;
  }
  return sac::Main(argv[1]);
}
