// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "synth/icosphere.h"
#include "synth/kinds.h"

namespace sac::synth {
namespace {

// A zonal harmonic: the Legendre polynomial of the cosine of the angle to an axis. The zonal harmonics about all axes
// span the spherical harmonics of a degree.
struct Mode {
  int degree;
  Eigen::Vector3d axis;
  double amplitude, rate;  // rate in radians per second
};

double Legendre(int degree, double x) {
  switch (degree) {
    case 1:
      return x;
    case 2:
      return (3 * x * x - 1) / 2;
    case 3:
      return (5 * x * x - 3) * x / 2;
    default:
      return ((35 * x * x - 30) * x * x + 3) / 8;
  }
}

}  // namespace

// Frame 0 is the exact sphere, because all modes are sines of the time.
Animation MakeSphere(std::uint32_t vertices, Random random) {
  const double frequency = std::round(std::sqrt((vertices - 2.0) / 10));
  Icosphere sphere = MakeIcosphere(static_cast<std::uint32_t>(std::max(frequency, 1.0)));
  Animation animation;
  animation.mesh.triangles = std::move(sphere.triangles);
  for (const Eigen::Vector3d& p : sphere.points) animation.mesh.normals.push_back(ToFloat(p));

  std::array<Mode, 8> modes;
  for (int i = 0; i < 8; ++i) {
    const int degree = 1 + i % 4;
    const Eigen::Vector3d axis = random.Direction();
    const double amplitude = random.Uniform(0.09, 0.18) / degree;
    modes[i] = {degree, axis, amplitude, random.Uniform(2, 4) * std::sqrt(degree)};
  }
  const Eigen::Vector3d axis = random.Direction();
  const double turn_rate = random.Uniform(0.4, 0.8);
  animation.motion = [points = std::move(sphere.points), modes, axis, turn_rate](double t) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(turn_rate * t, axis).toRotationMatrix();
    Positions out;
    out.reserve(points.size());
    for (const Eigen::Vector3d& p : points) {
      double radius = 1;
      for (const Mode& m : modes) radius += m.amplitude * std::sin(m.rate * t) * Legendre(m.degree, p.dot(m.axis));
      out.push_back(ToFloat(turn * p * radius));
    }
    return out;
  };
  return animation;
}

}  // namespace sac::synth
