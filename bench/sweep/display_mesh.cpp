// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/display_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "files/cache_file.h"

namespace sac {
namespace {

constexpr std::uint32_t kFrames = 4;

Vec3f LowCorner(const Positions& positions) {
  Vec3f low = positions.front();
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]);
  }
  return low;
}

// For each vertex the first vertex in its cell. The cells are cubes of edge length `cell`.
std::vector<std::uint32_t> Cluster(const Positions& positions, double cell, std::size_t& clusters) {
  const Vec3f low = LowCorner(positions);
  std::unordered_map<std::uint64_t, std::uint32_t> first;
  std::vector<std::uint32_t> representative(positions.size());
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    std::uint64_t index = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double at = (static_cast<double>(positions[v][a]) - static_cast<double>(low[a])) / cell;
      index = index << 21 | static_cast<std::uint64_t>(std::min(at, 2097151.0));
    }
    representative[v] = first.emplace(index, v).first->second;
  }
  clusters = first.size();
  return representative;
}

std::vector<std::uint32_t> Representatives(const Positions& positions) {
  std::vector<std::uint32_t> representative(positions.size());
  for (std::uint32_t v = 0; v < positions.size(); ++v) representative[v] = v;
  if (positions.size() <= kMostDisplayVertices) return representative;
  const Vec3f low = LowCorner(positions);
  double extent = 1e-30;
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a)
      extent = std::max(extent, static_cast<double>(p[a]) - static_cast<double>(low[a]));
  }
  std::size_t clusters = 0;
  double cell = extent / 256;
  do {
    representative = Cluster(positions, cell, clusters);
    cell *= 1.1;
  } while (clusters > kMostDisplayVertices);
  return representative;
}

void Append16(double value, std::string& bytes) {
  const auto rounded = static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 65535.0)));
  bytes += static_cast<char>(rounded & 255);
  bytes += static_cast<char>(rounded >> 8);
}

}  // namespace

DisplayMesh MakeDisplayMesh(const Mesh& mesh, std::uint32_t frame_count) {
  DisplayMesh display;
  const std::vector<std::uint32_t> representative = Representatives(mesh.positions);
  std::vector<std::uint16_t> index(mesh.positions.size());
  for (std::uint32_t v = 0; v < representative.size(); ++v) {
    if (representative[v] != v) continue;
    index[v] = static_cast<std::uint16_t>(display.vertices.size());
    display.vertices.push_back(v);
  }
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t a = representative[t[0]], b = representative[t[1]], c = representative[t[2]];
    if (a != b && b != c && c != a) display.triangles.push_back({index[a], index[b], index[c]});
  }
  // The frames are spread over the inside of the clip, since most codecs have the smallest error in the first frame.
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    const auto frame = static_cast<std::uint32_t>((2 * std::uint64_t{k} + 1) * frame_count / (2 * kFrames));
    if (display.frames.empty() || display.frames.back() != frame) display.frames.push_back(frame);
  }
  return display;
}

Status MeasureDisplayBox(const std::string& cache_path, const DisplayMesh& mesh, DisplayBox& box) {
  std::unique_ptr<CacheReader> cache;
  SAC_RETURN_IF_ERROR(CacheReader::Open(cache_path, cache));
  Positions positions;
  bool first = true;
  for (const std::uint32_t frame : mesh.frames) {
    SAC_RETURN_IF_ERROR(cache->Read(frame, positions));
    for (const std::uint32_t v : mesh.vertices) {
      if (first) box.low = box.high = positions[v];
      first = false;
      for (std::size_t a = 0; a < 3; ++a) {
        box.low[a] = std::min(box.low[a], positions[v][a]);
        box.high[a] = std::max(box.high[a], positions[v][a]);
      }
    }
  }
  return Status::Ok();
}

Status SampleShapes(const std::string& cache_path, const DisplayMesh& mesh, const DisplayBox& box, std::string& bytes) {
  std::unique_ptr<CacheReader> cache;
  SAC_RETURN_IF_ERROR(CacheReader::Open(cache_path, cache));
  Positions positions;
  for (const std::uint32_t frame : mesh.frames) {
    SAC_RETURN_IF_ERROR(cache->Read(frame, positions));
    for (const std::uint32_t v : mesh.vertices) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double low = box.low[a], high = box.high[a];
        const double at = high > low ? (static_cast<double>(positions[v][a]) - low) / (high - low) : 0.5;
        Append16(65535 * (at + 0.5) / 2, bytes);
      }
    }
  }
  return Status::Ok();
}

Status SampleErrors(const std::string& original_path, const std::string& decoded_path, const DisplayMesh& mesh,
                    double diagonal, std::string& bytes) {
  std::unique_ptr<CacheReader> original, decoded;
  SAC_RETURN_IF_ERROR(CacheReader::Open(original_path, original));
  SAC_RETURN_IF_ERROR(CacheReader::Open(decoded_path, decoded));
  Positions a, b;
  for (const std::uint32_t frame : mesh.frames) {
    SAC_RETURN_IF_ERROR(original->Read(frame, a));
    SAC_RETURN_IF_ERROR(decoded->Read(frame, b));
    for (const std::uint32_t v : mesh.vertices) {
      const double error = std::hypot(static_cast<double>(a[v][0]) - static_cast<double>(b[v][0]),
                                      static_cast<double>(a[v][1]) - static_cast<double>(b[v][1]),
                                      static_cast<double>(a[v][2]) - static_cast<double>(b[v][2]));
      const double level = error > 0 && diagonal > 0 ? (std::log10(error / diagonal) + 6) / 5 : 0;
      bytes += static_cast<char>(std::lround(255 * std::clamp(level, 0.0, 1.0)));
    }
  }
  return Status::Ok();
}

}  // namespace sac
