// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/coded_normals.h"

#include <draco/compression/attributes/normal_compression_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "geometry/corner_groups.h"

namespace sac {
namespace {

// Of normals that Draco quantizes to the same one number, for each normal.
std::vector<std::uint32_t> ClassesByCode(const std::vector<Vec3f>& normals) {
  draco::OctahedronToolBox octahedron;
  octahedron.SetQuantizationBits(kNormalBits);
  std::vector<std::uint32_t> classes;
  classes.reserve(normals.size());
  for (const Vec3f& n : normals) {
    std::int32_t s = 0, t = 0;
    octahedron.FloatVectorToQuantizedOctahedralCoords(n.data(), &s, &t);
    classes.push_back(static_cast<std::uint32_t>(s) << kNormalBits | static_cast<std::uint32_t>(t));
  }
  return classes;
}

// Whether two normals differ in direction by less than a quarter of what quantization may take from each.
bool AreNear(const Vec3f& a, const Vec3f& b) {
  constexpr double kNear = 1e-3;  // radians
  const auto length = [](const Vec3f& n) { return std::hypot(double{n[0]}, double{n[1]}, double{n[2]}); };
  const double la = length(a), lb = length(b);
  if (la == 0 || lb == 0) return false;
  return std::hypot(a[0] / la - b[0] / lb, a[1] / la - b[1] / lb, a[2] / la - b[2] / lb) < kNear;
}

// One number for the normals of a vertex that are near each other, for each normal. Each has one vertex.
std::vector<std::uint32_t> ClassesByDistance(const std::vector<Triangle>& triangles, const CodedNormals& normals) {
  // Beyond as many at a vertex, none are compared: the time is quadratic, and nobody has so many for the sake of shape.
  constexpr std::size_t kMost = 64;
  std::vector<std::array<std::uint32_t, 2>> uses;  // vertex and normal
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) uses.push_back({triangles[j][k], normals.triangles[j][k]});
  }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  std::vector<std::uint32_t> classes(normals.values.size());
  std::iota(classes.begin(), classes.end(), 0u);
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end][0] == uses[begin][0]) ++end;
    for (std::size_t i = begin + 1; i < end && end - begin <= kMost; ++i) {
      for (std::size_t first = begin; first < i; ++first) {
        const std::uint32_t a = uses[first][1], b = uses[i][1];
        if (classes[a] == a && classes[b] == b && AreNear(normals.values[a], normals.values[b])) classes[b] = a;
      }
    }
  }
  return classes;
}

}  // namespace

CodedNormals NormalsToCode(const Mesh& mesh) {
  CodedNormals out{mesh.normals, mesh.normal_triangles};
  const auto merge = [&](const std::vector<std::uint32_t>& classes) {
    MergeNormals(mesh.triangles, mesh.positions.size(), classes, {}, out.values, out.triangles);
  };
  if (!out.triangles.empty()) merge(ClassesByCode(out.values));
  // What differs by rounding alone may be quantized apart, most of all on symmetric shapes.
  if (!out.triangles.empty()) merge(ClassesByDistance(mesh.triangles, out));
  return out;
}

std::vector<Vec3f> NormalsOfVertices(const Mesh& mesh, const CodedNormals& normals) {
  if (normals.triangles.empty()) return normals.values;
  std::vector<Vec3f> of_vertices(mesh.positions.size());
  for (std::size_t j = mesh.triangles.size(); j-- > 0;) {
    for (std::size_t k = 3; k-- > 0;) of_vertices[mesh.triangles[j][k]] = normals.values[normals.triangles[j][k]];
  }
  return of_vertices;
}

}  // namespace sac
