// SPDX-License-Identifier: Apache-2.0
// What stands before Draco, and Draco: an I-frame's mesh in a stream that allows it 2,000 triangles.
#include <algorithm>

#include "codec/draco_mesh.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sac;
  SequenceHeader header;
  header.vertices = header.triangles = 2000;
  DracoMesh mesh;
  if (!DecodeDraco(std::span(data, size), header, mesh).ok()) return 0;
  FUZZ_REQUIRE(mesh.triangles.size() <= header.triangles);
  FUZZ_REQUIRE(mesh.entries <= 3 * header.triangles);
  const auto below = [](const std::vector<Triangle>& triangles, std::size_t end) {
    return std::all_of(triangles.begin(), triangles.end(),
                       [end](const Triangle& t) { return *std::max_element(t.begin(), t.end()) < end; });
  };
  FUZZ_REQUIRE(below(mesh.triangles, mesh.entries));
  FUZZ_REQUIRE(below(mesh.uv_triangles, mesh.uvs.size()));
  FUZZ_REQUIRE(mesh.uv_triangles.empty() || mesh.uv_triangles.size() == mesh.triangles.size());
  FUZZ_REQUIRE(below(mesh.normal_triangles, mesh.normals.size()));
  FUZZ_REQUIRE(mesh.normal_triangles.empty() || mesh.normal_triangles.size() == mesh.triangles.size());
  FUZZ_REQUIRE(below(mesh.color_triangles, mesh.colors.size()));
  FUZZ_REQUIRE(mesh.color_triangles.empty() || mesh.color_triangles.size() == mesh.triangles.size());
  return 0;
}
