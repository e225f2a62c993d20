// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "synth/kinds.h"

namespace sac::synth {
namespace {

constexpr double kPi = std::numbers::pi;

// The profile as pairs of radius and height in metres: from the middle of the foot up the outside to the lip, and down
// the inside.
constexpr std::array<std::array<double, 2>, 17> kProfile{{{0, 0},
                                                          {0.09, 0},
                                                          {0.1, 0.015},
                                                          {0.07, 0.05},
                                                          {0.12, 0.13},
                                                          {0.16, 0.23},
                                                          {0.14, 0.34},
                                                          {0.08, 0.42},
                                                          {0.065, 0.48},
                                                          {0.1, 0.55},
                                                          {0.095, 0.555},
                                                          {0.055, 0.48},
                                                          {0.07, 0.415},
                                                          {0.13, 0.335},
                                                          {0.15, 0.23},
                                                          {0.105, 0.13},
                                                          {0, 0.08}}};

// The radius and height at `x` in [0, 1] along the profile, by a Catmull-Rom spline through its points.
std::array<double, 2> Profile(double x) {
  const int last = static_cast<int>(kProfile.size()) - 1;
  const int i = std::min(static_cast<int>(x * last), last - 1);
  const double u = x * last - i;
  const auto at = [&](int k) { return kProfile[static_cast<std::size_t>(std::clamp(k, 0, last))]; };
  std::array<double, 2> out{};
  for (std::size_t c = 0; c < 2; ++c) {
    const double a = at(i - 1)[c], b = at(i)[c], d = at(i + 1)[c], e = at(i + 2)[c];
    out[c] = b + u * ((d - a) + u * ((2 * a - 5 * b + 4 * d - e) + u * (3 * (b - d) + e - a))) / 2;
  }
  return out;
}

struct Path {
  Eigen::Vector3d swing, rate, phase, axis, tilt_axis;
  double turn_rate, tilt_rate;

  Positions Move(const std::vector<Eigen::Vector3d>& points, double t) const {
    const Eigen::Vector3d shift = swing.cwiseProduct((rate * t + phase).array().sin().matrix());
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(turn_rate * t, axis) * Eigen::AngleAxisd(std::sin(tilt_rate * t), tilt_axis))
            .toRotationMatrix();
    Positions out;
    out.reserve(points.size());
    for (const Eigen::Vector3d& p : points) out.push_back(ToFloat(turn * p + shift));
    return out;
  }
};

Path RandomPath(Random& random) {
  Path path;
  for (int c = 0; c < 3; ++c) {
    path.swing[c] = random.Uniform(0.2, 0.6);
    path.rate[c] = random.Uniform(0.5, 1.5);
    path.phase[c] = random.Angle();
  }
  path.axis = random.Direction();
  path.tilt_axis = random.Direction();
  path.turn_rate = random.Uniform(0.8, 1.6);
  path.tilt_rate = random.Uniform(0.5, 1.5);
  return path;
}

}  // namespace

// The vase is a closed surface of rings of points between two poles: the middle of the foot and the middle of the inner
// bottom.
Animation MakeVase(std::uint32_t vertices, Random random) {
  // The profile is about 1.35 m long and the middle circumference 0.63 m.
  const auto around = std::max<std::uint32_t>(6, static_cast<std::uint32_t>(std::lround(std::sqrt(vertices * 0.47))));
  const std::uint32_t rings = std::max<std::uint32_t>(2, (vertices - 2 + around / 2) / around);
  const std::uint32_t first_pole = around * rings, last_pole = first_pole + 1;

  Animation animation;
  Mesh& mesh = animation.mesh;
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t r = 0; r < rings; ++r) {
    const double along = (r + 1.0) / (rings + 1.0);
    const auto [radius, height] = Profile(along);
    for (std::uint32_t a = 0; a < around; ++a) {
      const double angle = 2 * kPi * a / around;
      points.emplace_back(radius * std::cos(angle), height - 0.25, radius * std::sin(angle));
    }
    for (std::uint32_t a = 0; a <= around; ++a) {
      mesh.uvs.push_back({static_cast<float>(a) / around, static_cast<float>(along)});
    }
  }
  for (const double end : {0.0, 1.0}) {
    points.emplace_back(0, Profile(end)[1] - 0.25, 0);
    for (std::uint32_t a = 0; a < around; ++a) mesh.uvs.push_back({(a + 0.5f) / around, static_cast<float>(end)});
  }

  // The vertices of a ring are closed; its texture coordinates have one column more, which makes the seam. A pole has
  // one texture coordinate for each of its triangles.
  const auto vertex = [&](std::uint32_t r, std::uint32_t a) { return r * around + a % around; };
  const auto uv = [&](std::uint32_t r, std::uint32_t a) { return r * (around + 1) + a; };
  const std::uint32_t pole_uvs = rings * (around + 1);
  for (std::uint32_t a = 0; a < around; ++a) {
    const std::uint32_t b = a + 1, top = rings - 1;
    mesh.triangles.push_back({first_pole, vertex(0, a), vertex(0, b)});
    mesh.uv_triangles.push_back({pole_uvs + a, uv(0, a), uv(0, b)});
    for (std::uint32_t r = 0; r < top; ++r) {
      mesh.triangles.insert(mesh.triangles.end(), {{vertex(r, a), vertex(r + 1, a), vertex(r + 1, b)},
                                                   {vertex(r, a), vertex(r + 1, b), vertex(r, b)}});
      mesh.uv_triangles.insert(mesh.uv_triangles.end(),
                               {{uv(r, a), uv(r + 1, a), uv(r + 1, b)}, {uv(r, a), uv(r + 1, b), uv(r, b)}});
    }
    mesh.triangles.push_back({vertex(top, a), last_pole, vertex(top, b)});
    mesh.uv_triangles.push_back({uv(top, a), pole_uvs + around + a, uv(top, b)});
  }
  animation.motion = [points = std::move(points), path = RandomPath(random)](double t) { return path.Move(points, t); };
  return animation;
}

}  // namespace sac::synth
