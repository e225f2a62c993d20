// SPDX-License-Identifier: Apache-2.0
#include "conformance/vector_clips.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

namespace sac {

Clip Synth(SynthKind kind, std::uint32_t vertices, std::uint32_t frames) {
  SynthClip synth;
  if (const Status status = SynthClip::Create({kind, vertices, frames, 1}, synth); !status.ok()) {
    std::fprintf(stderr, "make_vectors: %s\n", status.message().c_str());
    std::exit(1);
  }
  Clip clip{synth.mesh(), {}};
  for (std::uint32_t f = 0; f < frames; ++f) clip.frames.push_back(synth.Frame(f));
  return clip;
}

Clip Wave(const Mesh& mesh, std::uint32_t frames) {
  Clip clip{mesh, {}};
  for (std::uint32_t f = 0; f < frames; ++f) {
    const double t = 0.2 * f;
    Positions& positions = clip.frames.emplace_back(mesh.positions);
    for (Vec3f& p : positions) {
      const double x = static_cast<double>(p[0]), y = static_cast<double>(p[1]), z = static_cast<double>(p[2]);
      p = {static_cast<float>(x * std::cos(t) - y * std::sin(t)), static_cast<float>(x * std::sin(t) + y * std::cos(t)),
           static_cast<float>(z + 0.3 * std::sin(t) * x * x)};
    }
  }
  return clip;
}

Mesh OddMesh() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0},     {1, 0, 0},    {1, 1, 0},     {0, 1, 0},        {-1, 0, 0},     {-1, -1, 0.5f},
                    {0, -1, 0.5f}, {2, 0.5f, 1}, {2, 0.5f, -1}, {0.5f, 2, 0.25f}, {1.5f, 2, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 6}, {1, 2, 7},   {2, 1, 8},
                    {3, 2, 9}, {3, 3, 2}, {0, 1, 2}, {2, 9, 3}, {10, 10, 10}};
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto i = static_cast<std::uint8_t>(v);
    mesh.normals.push_back(v % 2 ? Vec3f{0, 0, 1} : Vec3f{0.6f, 0, 0.8f});
    mesh.colors.push_back({static_cast<std::uint8_t>(20 * i), 100, static_cast<std::uint8_t>(255 - i), 255});
  }
  for (std::size_t i = 0; i < 12; ++i) mesh.uvs.push_back({static_cast<float>(i) / 11, static_cast<float>(i % 3) / 2});
  for (const Triangle& t : mesh.triangles) mesh.uv_triangles.push_back(t);
  mesh.uv_triangles[1] = {0, 2, 11};  // the seam
  return mesh;
}

Mesh OddHardMesh() {
  Mesh mesh = OddMesh();
  mesh.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 1, 0}, {0, -0.6f, 0.8f}, {0, 0, 1}, {1e-6f, 0, 1}};
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    Triangle& corners = mesh.normal_triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[j][k];
      const auto by_triangle = static_cast<std::uint32_t>(j % 4);
      corners[k] = v % 3 == 0 ? by_triangle : v % 3 == 1 ? 1 : static_cast<std::uint32_t>(4 + j % 2);
    }
  }
  return mesh;
}

Mesh CrowdedMesh() {
  Mesh mesh;
  std::mt19937 random(2);
  const auto jitter = [&] { return static_cast<float>(random() % 1000) / 1000; };
  const auto size = [&] { return static_cast<std::uint32_t>(mesh.positions.size()); };
  for (std::uint32_t ring = 31; ring <= 33; ++ring) {
    const std::uint32_t top = size(), bottom = top + 1, first = top + 2;
    const float x = 3 * static_cast<float>(ring - 31);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 1}, {x, 0, -1}});
    for (std::uint32_t i = 0; i < ring; ++i) {
      const float turn = 6.2831853f * static_cast<float>(i) / static_cast<float>(ring);
      mesh.positions.push_back({x + std::cos(turn), std::sin(turn), 0.1f * jitter()});
      const std::uint32_t a = first + i, b = first + (i + 1) % ring;
      mesh.triangles.insert(mesh.triangles.end(), {{top, a, b}, {bottom, b, a}});
    }
    if (ring > 31) mesh.triangles.push_back({top + 2, top - 1, top - 2});
  }
  const std::uint32_t spine = size();
  mesh.positions.insert(mesh.positions.end(), {{0, 3, 0}, {0, 3, 1}});
  for (std::uint32_t page = 0; page < 25; ++page) {
    const float turn = 0.25f * static_cast<float>(page), length = 1 + jitter();
    mesh.triangles.push_back({spine, spine + 1, size()});
    if (page > 0) mesh.triangles.push_back({size() - 1, size(), spine});
    mesh.positions.push_back({length * std::cos(turn), 3 + length * std::sin(turn), jitter()});
  }
  const std::uint32_t tangle = size();
  for (int i = 0; i < 30; ++i) mesh.positions.push_back({3 + jitter(), 3 + jitter(), jitter()});
  for (int i = 0; i < 120; ++i) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::uint32_t& corner : t) corner = tangle + random() % 30;
  }
  return mesh;
}

Mesh SplitMesh(const Mesh& mesh, std::uint32_t parts) {
  Mesh out;
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> number;
  const auto add = [&](std::uint32_t v, std::uint32_t uv, std::uint32_t normal, std::uint32_t part) {
    const auto [at, is_new] = number.try_emplace({v, uv, normal, part}, static_cast<std::uint32_t>(number.size()));
    if (is_new) {
      out.positions.push_back(mesh.positions[v]);
      if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[uv]);
      if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[normal]);
      if (!mesh.colors.empty()) {
        out.colors.push_back(mesh.colors[v]);
        out.colors.back()[0] = static_cast<std::uint8_t>(out.colors.back()[0] + 50 * part);
      }
    }
    return at->second;
  };
  std::vector<bool> is_corner(mesh.positions.size());
  for (std::uint32_t j = 0; j < mesh.triangles.size(); ++j) {
    Triangle& t = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[j][k];
      is_corner[v] = true;
      t[k] = add(v, mesh.uv_triangles.empty() ? 0 : mesh.uv_triangles[j][k],
                 mesh.normal_triangles.empty() ? v : mesh.normal_triangles[j][k], j % parts);
    }
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (!is_corner[v]) add(v, 0, mesh.normal_triangles.empty() ? v : 0, 0);
  }
  if (!out.uvs.empty()) out.uv_triangles = out.triangles;
  return out;
}

Clip SmallPart() {
  const Clip flag = Synth(SynthKind::kFlag, 80, 6), sphere = Synth(SynthKind::kSphere, 120, 6);
  Clip clip{{}, {}};
  const auto join = [&](const Positions& large, const Positions& small) {
    Positions out;
    for (const Vec3f& p : large) out.push_back({500 * p[0], 500 * p[1], 500 * p[2]});
    for (const Vec3f& p : small) out.push_back({p[0] - 3000, p[1] + 700, p[2] + 20});
    return out;
  };
  clip.mesh.positions = join(sphere.mesh.positions, flag.mesh.positions);
  clip.mesh.triangles = sphere.mesh.triangles;
  const auto count = static_cast<std::uint32_t>(sphere.mesh.positions.size());
  for (const Triangle& t : flag.mesh.triangles)
    clip.mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  for (std::size_t f = 0; f < flag.frames.size(); ++f) clip.frames.push_back(join(sphere.frames[f], flag.frames[f]));
  return clip;
}

Clip StandStill() {
  Clip clip = Synth(SynthKind::kFlag, 120, 12);
  clip.frames.insert(clip.frames.begin(), 9, clip.frames.front());
  clip.frames.insert(clip.frames.end(), 9, clip.frames.back());
  return clip;
}

Clip Cuts() {
  Clip clip = Synth(SynthKind::kParts, 200, 24);
  for (std::size_t f = 8; f < 16; ++f) {
    for (Vec3f& p : clip.frames[f]) p = {p[1] + 3, -p[0], 0.5f * p[2]};
  }
  return clip;
}

}  // namespace sac
