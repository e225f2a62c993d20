// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "codec/shape.h"
#include "geometry/components.h"
#include "geometry/laplacian.h"
#include "sac/mesh.h"
#include "synth/icosphere.h"

namespace sac {

inline PositionMatrix ToMatrix(const Positions& positions) {
  PositionMatrix matrix(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)) = static_cast<double>(positions[v][a]);
    }
  }
  return matrix;
}

inline Vec3f ToVec3f(const Eigen::Vector3d& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// Uniform in [-1, 1).
inline double Signed(std::mt19937& random) { return random() * 0x1p-31 - 1; }

inline Eigen::Vector3d RandomVector(std::mt19937& random) {
  const double x = Signed(random), y = Signed(random), z = Signed(random);
  return {x, y, z};
}

// `count` random vectors.
inline Positions RandomPositions(std::mt19937& random, std::size_t count) {
  Positions positions(count);
  for (Vec3f& p : positions) p = ToVec3f(RandomVector(random));
  return positions;
}

// Any three of `count` vertices, which may be the same.
inline Triangle RandomTriangle(std::mt19937& random, std::size_t count) {
  Triangle t;
  for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random() % count);
  return t;
}

// Rotates rows about the origin, then moves them.
inline PositionMatrix Moved(const PositionMatrix& p, const Eigen::Matrix3d& r, const Eigen::Vector3d& t) {
  return (p * r.transpose()).rowwise() + t.transpose();
}

inline Positions Moved(Positions positions, const Eigen::Matrix3d& r, const Eigen::Vector3d& t) {
  for (Vec3f& p : positions) p = ToVec3f(r * Eigen::Vector3d(p[0], p[1], p[2]) + t);
  return positions;
}

inline Eigen::Matrix3d AxisAngle(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

inline Mesh SphereMesh(std::uint32_t frequency) {
  const synth::Icosphere sphere = synth::MakeIcosphere(frequency);
  Mesh mesh;
  for (const Eigen::Vector3d& p : sphere.points) mesh.positions.push_back(ToVec3f(p));
  mesh.triangles = sphere.triangles;
  return mesh;
}

// A tube along z, open at both ends: `rings` rings of `segments` vertices, radius 1, rings 0.5 apart.
inline Mesh TubeMesh(std::uint32_t rings, std::uint32_t segments) {
  Mesh mesh;
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double angle = 2 * std::numbers::pi * (s + 0.5 * (r % 2)) / segments;
      mesh.positions.push_back(ToVec3f({std::cos(angle), std::sin(angle), 0.5 * r}));
      if (r + 1 == rings) continue;
      const std::uint32_t a = r * segments + s, b = r * segments + (s + 1) % segments;
      mesh.triangles.push_back({a, b, a + segments});
      mesh.triangles.push_back({b, b + segments, a + segments});
    }
  }
  return mesh;
}

// The tube bent about the x axis: ring after ring turns by `angle` in all, with every length kept on its middle line.
inline Positions BentTube(const Mesh& tube, double angle) {
  Positions out;
  double length = 0;
  for (const Vec3f& p : tube.positions) length = std::max(length, static_cast<double>(p[2]));
  for (const Vec3f& p : tube.positions) {
    const double turn = angle * p[2] / length, radius = std::abs(angle) < 1e-9 ? 0 : length / angle;
    const double bow = std::abs(angle) < 1e-9 ? 0 : radius * (1 - std::cos(turn));
    const double along = std::abs(angle) < 1e-9 ? p[2] : radius * std::sin(turn);
    out.push_back(ToVec3f({p[0], bow + p[1] * std::cos(turn), along - p[1] * std::sin(turn)}));
  }
  return out;
}

// Adds `part` as further components, moved by `offset`.
inline void AppendMesh(Mesh& mesh, const Mesh& part, const Eigen::Vector3d& offset) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Positions moved = Moved(part.positions, Eigen::Matrix3d::Identity(), offset);
  mesh.positions.insert(mesh.positions.end(), moved.begin(), moved.end());
  for (const Triangle& t : part.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

// A sphere, a tube, a tetrahedron with a degenerate and a duplicate triangle, and a vertex alone: 4 components.
inline Mesh PartsMesh() {
  Mesh mesh = SphereMesh(3);
  AppendMesh(mesh, TubeMesh(6, 8), {4, 0, 0});
  Mesh tetrahedron;
  tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {2, 0, 3}, {1, 1, 2}, {3, 3, 3}};
  AppendMesh(mesh, tetrahedron, {-3, 1, 0});
  mesh.positions.push_back({0, 5, 0});
  return mesh;
}

// The shape that a decoder would build of `mesh`, whose components have to be runs of vertices, on a grid of `bits`.
// The header's steps are left to the caller.
inline void MakeShape(const Mesh& mesh, const std::vector<std::uint32_t>& counts, std::uint32_t handles_per_harmonic,
                      int bits, SequenceHeader& header, Shape& shape) {
  const PositionMatrix p = ToMatrix(mesh.positions);
  const Eigen::RowVector3d low = p.colwise().minCoeff(), extent = p.colwise().maxCoeff() - low;
  header.position_bits = static_cast<std::uint8_t>(bits);
  header.origin_x = static_cast<float>(low[0]);
  header.origin_y = static_cast<float>(low[1]);
  header.origin_z = static_cast<float>(low[2]);
  header.cell = static_cast<float>(extent.maxCoeff() / ((1 << bits) - 1));
  DecodedMesh decoded;
  for (Eigen::Index v = 0; v < p.rows(); ++v) {
    const Eigen::RowVector3d cells = (p.row(v) - low) / static_cast<double>(header.cell);
    GridPosition& g = decoded.grid.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      g[a] = static_cast<std::uint32_t>(std::lround(cells[static_cast<Eigen::Index>(a)]));
    }
  }
  decoded.triangles = mesh.triangles;
  std::uint32_t components = 0;
  const auto labels = LabelComponents(static_cast<std::uint32_t>(p.rows()), mesh.triangles, components);
  ASSERT_TRUE(std::is_sorted(labels.begin(), labels.end()));
  for (std::uint32_t v = 0; v < labels.size(); ++v) {
    if (v == 0 || labels[v] != labels[v - 1]) decoded.components.push_back({v, 0});
    ++decoded.components.back().count;
  }
  const Status status = BuildShape(header, decoded, counts, handles_per_harmonic, {}, shape);
  ASSERT_TRUE(status.ok()) << status.message();
}

}  // namespace sac
