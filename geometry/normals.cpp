// SPDX-License-Identifier: Apache-2.0
#include "geometry/normals.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "geometry/corner_groups.h"
#include "sac/frame_normals.h"

namespace sac {
namespace {

// Adds to sums[targets[j][k]], for each corner k of each triangle j, the normal of the triangle, twice its area long.
void AddTriangleNormals(std::span<const Vec3f> positions, const std::vector<Triangle>& triangles,
                        const std::vector<Triangle>& targets, std::vector<std::array<double, 3>>& sums) {
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    const Triangle& t = triangles[j];
    std::array<double, 3> u, w;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto origin = static_cast<double>(positions[t[0]][a]);
      u[a] = static_cast<double>(positions[t[1]][a]) - origin;
      w[a] = static_cast<double>(positions[t[2]][a]) - origin;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      const double n = u[b] * w[c] - u[c] * w[b];
      for (const std::uint32_t target : targets[j]) sums[target][a] += n;
    }
  }
}

using Vec3d = std::array<double, 3>;

Vec3d ToDouble(const Vec3f& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double Dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3d Cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3d Normalized(const Vec3d& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {v[0] / length, v[1] / length, v[2] / length};
}

// A direction that is perpendicular to `v`, of length 1, always the same one.
Vec3d AnyAcross(const Vec3d& v) {
  std::size_t least = 0;
  for (const std::size_t a : {std::size_t{1}, std::size_t{2}}) {
    if (std::abs(v[a]) < std::abs(v[least])) least = a;
  }
  Vec3d axis = {};
  axis[least] = 1;
  return Normalized(Cross(axis, v));
}

Vec3d Edge(const Vec3f& from, const Vec3f& to) {
  const Vec3d a = ToDouble(from), b = ToDouble(to);
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

// `v` as it lies on the plane of two axes.
template <class Axes>
std::complex<double> OnPlane(const Vec3d& v, const Axes& axes) {
  return {Dot(v, axes.along), Dot(v, axes.across)};
}

}  // namespace

const std::vector<Vec3f>& NormalField::Compute(const Positions& positions, const std::vector<Triangle>& triangles) {
  sums_.assign(positions.size(), {});
  AddTriangleNormals(positions, triangles, triangles, sums_);
  normals_.assign(positions.size(), {});
  for (std::size_t v = 0; v < sums_.size(); ++v) {
    const double length = std::hypot(sums_[v][0], sums_[v][1], sums_[v][2]);
    if (!(length > 0) || !std::isfinite(length)) continue;
    for (std::size_t a = 0; a < 3; ++a) normals_[v][a] = static_cast<float>(sums_[v][a] / length);
  }
  return normals_;
}

std::vector<Vec3f> VertexNormals(const Positions& positions, const std::vector<Triangle>& triangles) {
  NormalField field;
  return field.Compute(positions, triangles);
}

FrameNormals::FrameNormals(const Mesh& reference) : own_(reference.normals) {
  if (own_.empty()) return;
  reference_ = reference.positions;
  triangles_ = reference.triangles;
  if (!reference.normal_triangles.empty()) {
    // An index may serve several vertices, as those of a flat face do; they will not stay parallel.
    CornerGroups groups = GroupCorners(triangles_, reference.normal_triangles);
    own_.clear();
    for (const std::size_t c : groups.first) {
      own_.push_back(reference.normals[reference.normal_triangles[c / 3][c % 3]]);
    }
    normal_triangles_ = std::move(groups.triangles);
  }
  ComputeAxes(reference_);
  reference_axes_ = axes_;
}

void FrameNormals::ComputeAxes(std::span<const Vec3f> positions) {
  sums_.assign(own_.size(), {});
  AddTriangleNormals(positions, triangles_, targets(), sums_);
  axes_.assign(own_.size(), {});
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3d mean = Normalized(sums_[i]);
    if (mean == Vec3d{}) continue;
    const Vec3d along = AnyAcross(mean);
    axes_[i] = {along, Cross(mean, along), mean};
  }
}

void FrameNormals::ComputeTurns(std::span<const Vec3f> positions) {
  turns_.assign(own_.size(), 0);
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Triangle& t = triangles_[j];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = targets()[j][k];
      for (const std::uint32_t other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
        const auto before = OnPlane(Edge(reference_[t[k]], reference_[other]), reference_axes_[i]);
        turns_[i] += std::conj(before) * OnPlane(Edge(positions[t[k]], positions[other]), axes_[i]);
      }
    }
  }
}

const std::vector<Vec3f>& FrameNormals::Compute(std::span<const Vec3f> positions) {
  if (own_.empty()) return own_;
  ComputeAxes(positions);
  ComputeTurns(positions);
  normals_ = own_;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const Axes &from = reference_axes_[i], &to = axes_[i];
    const double length = std::abs(turns_[i]);
    if (from.mean == Vec3d{} || to.mean == Vec3d{} || !std::isfinite(length)) continue;
    const std::complex<double> turn = length > 0 ? turns_[i] / length : 1;
    if (from.mean == to.mean && turn == 1.0) continue;
    const Vec3d own = ToDouble(own_[i]);
    const std::complex<double> plane = turn * OnPlane(own, from);
    const double height = Dot(own, from.mean);
    for (std::size_t a = 0; a < 3; ++a) {
      normals_[i][a] =
          static_cast<float>(plane.real() * to.along[a] + plane.imag() * to.across[a] + height * to.mean[a]);
    }
  }
  return normals_;
}

}  // namespace sac
