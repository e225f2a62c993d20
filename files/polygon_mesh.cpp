// SPDX-License-Identifier: Apache-2.0
#include "files/polygon_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/corner_attributes.h"
#include "files/triangulation.h"

namespace sac {
namespace {

std::string Plural(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

Status CheckFaces(const PolygonMesh& parsed) {
  const Faces& faces = parsed.faces;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    for (std::uint32_t k = faces.begin(face); k < faces.ends[face]; ++k) {
      if (faces.vertices[k] < parsed.positions.size()) continue;
      return Status::Corrupt("face " + std::to_string(face) + ": vertex " + std::to_string(faces.vertices[k]) +
                             ", but there are " + std::to_string(parsed.positions.size()));
    }
  }
  return Status::Ok();
}

// The line that says what becomes of faces and which things are not kept.
void TellLosses(const PolygonMesh& parsed, const Triangulation& cut, Warnings& warnings) {
  std::string line;
  const auto add = [&line](const std::string& part) { line += (line.empty() ? "" : "; ") + part; };
  if (cut.quads + cut.polygons > 0) {
    std::string what = cut.quads > 0 ? Plural(cut.quads, "quad") : "";
    if (cut.polygons > 0) what += (what.empty() ? "" : " and ") + Plural(cut.polygons, "larger polygon");
    add(what + (cut.quads + cut.polygons == 1 ? " is triangulated" : " are triangulated"));
  }
  if (cut.fragments > 0) add(Plural(cut.fragments, "face") + " of fewer than three vertices left out");
  if (parsed.objects > 1) add(std::to_string(parsed.objects) + " objects become one mesh");
  if (const std::string lost = parsed.losses.Text(); !lost.empty()) add(lost + " are not kept");
  if (!line.empty()) warnings.push_back(line);
  if (cut.overlapping > 0) {
    warnings.push_back(Plural(cut.overlapping, "polygon") +
                       " with edges that cross or touch: triangles of it overlap; triangulate it before the export");
  }
}

// A mesh of points, or of triangles that hang together nowhere, is coded at many times the size.
void TellLooseParts(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, Warnings& warnings) {
  if (triangles.empty()) {
    warnings.push_back("no faces: its " + std::to_string(positions.size()) +
                       " vertices are coded each by itself; a mesh with faces takes far fewer bytes");
    return;
  }
  std::vector<bool> used(positions.size());
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) {
      if (used[v]) return;
      used[v] = true;
    }
  }
  std::vector<Vec3d> places = positions;
  std::sort(places.begin(), places.end());
  const auto count = static_cast<std::size_t>(std::unique(places.begin(), places.end()) - places.begin());
  if (4 * count > 3 * positions.size()) return;
  warnings.push_back("no triangle shares a vertex with another: " + std::to_string(positions.size()) + " vertices at " +
                     std::to_string(count) +
                     " places; merge them (weld, merge by distance) before the export, for fewer bytes");
}

}  // namespace

Status PolygonMesh::EndFace() {
  if (faces.vertices.size() >= kNone) return Status::Limit("more than 2^32 - 2 corners of faces");
  faces.ends.push_back(static_cast<std::uint32_t>(faces.vertices.size()));
  return Status::Ok();
}

std::vector<std::array<std::uint8_t, 4>> RoundColors(const std::vector<std::array<float, 4>>& colors, Losses& losses) {
  // Whole numbers above 1 are bytes. Others above 1 are brighter than white, which 8 bits cannot hold.
  float largest = 0;
  bool whole = true;
  for (const auto& c : colors) {
    if (c[3] < 0) continue;
    largest = std::max({largest, c[0], c[1], c[2]});
    for (int k = 0; k < 3; ++k) whole = whole && c[k] == std::floor(c[k]);
  }
  const float scale = largest > 1 && whole ? 1.0F : 255.0F;
  // As far as three decimals may be from a byte.
  constexpr float kTolerance = 0.1276F;
  std::vector<std::array<std::uint8_t, 4>> bytes;
  bytes.reserve(colors.size());
  std::uint64_t rounded = 0, beyond = 0;
  for (const auto& c : colors) {
    if (c[3] < 0) {
      bytes.push_back({255, 255, 255, 255});
      continue;
    }
    const std::array<float, 4> scaled = {c[0] * scale, c[1] * scale, c[2] * scale, c[3] > 1 ? c[3] : c[3] * 255};
    bool differs = false, clamped = false;
    std::array<std::uint8_t, 4> byte{};
    for (int k = 0; k < 4; ++k) {
      byte[k] = scaled[k] > 0 ? static_cast<std::uint8_t>(std::lround(std::min(scaled[k], 255.0F))) : 0;
      clamped |= !(scaled[k] >= -kTolerance && scaled[k] <= 255 + kTolerance);  // or NaN
      differs |= !(std::abs(scaled[k] - static_cast<float>(byte[k])) <= kTolerance);
    }
    beyond += clamped ? 1 : 0;
    rounded += differs && !clamped ? 1 : 0;
    bytes.push_back(byte);
  }
  losses.Count("colors finer than 8 bits", rounded);
  losses.Count("colors beyond black and white", beyond);
  return bytes;
}

void TakePositions(PolygonMesh& parsed, MeshFile& file) {
  file.mesh.positions.clear();
  file.mesh.positions.reserve(parsed.positions.size());
  for (const Vec3d& p : parsed.positions) {
    file.mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  file.exact.clear();
  if (parsed.wide) file.exact = std::move(parsed.positions);
  file.not_finite = std::move(parsed.not_finite);
}

Status FinishMesh(PolygonMesh& parsed, const ReadSettings& settings, MeshFile& file) {
  SAC_RETURN_IF_ERROR(CheckFaces(parsed));
  Triangulation cut;
  if (settings.first != nullptr && settings.first->faces == parsed.faces) {
    cut.corners = settings.first->corners;
  } else {
    cut = Triangulate(parsed.faces, parsed.positions);
  }
  file = {};
  Mesh& mesh = file.mesh;
  mesh.triangles.reserve(cut.corners.size());
  for (const auto& [a, b, c] : cut.corners) {
    mesh.triangles.push_back({parsed.faces.vertices[a], parsed.faces.vertices[b], parsed.faces.vertices[c]});
  }
  FinishUvs(parsed, cut.corners, mesh);
  FinishNormals(parsed, cut.corners, mesh);
  TellLosses(parsed, cut, file.warnings);
  if (settings.weld && settings.first == nullptr) TellLooseParts(parsed.positions, mesh.triangles, file.warnings);
  file.warnings.insert(file.warnings.end(), parsed.warnings.begin(), parsed.warnings.end());

  TakePositions(parsed, file);
  mesh.colors = std::move(parsed.colors);
  file.faces = std::move(parsed.faces);
  file.corners = std::move(cut.corners);
  return Status::Ok();
}

}  // namespace sac
