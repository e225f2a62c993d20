// SPDX-License-Identifier: Apache-2.0
#include "player/camera.h"

#include <algorithm>
#include <cmath>

namespace sac {
namespace {

using Vec3d = std::array<double, 3>;

constexpr double kFieldOfView = 0.6;  // radians, from bottom to top

double Dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3d Cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

void Camera::Fit(const Box& box) {
  for (int k = 0; k < 3; ++k) point[k] = (box.low[k] + box.high[k]) / 2;
  const double diagonal = box.diagonal();
  distance = diagonal > 0 ? 0.5 * diagonal / std::sin(kFieldOfView / 2) : 1;
}

void Camera::Orbit(double across, double up_) {
  turn += across;
  rise = std::clamp(rise + up_, -1.57, 1.57);
}

void Camera::Pan(double right_, double up_) {
  const double height = 2 * distance * std::tan(kFieldOfView / 2);
  for (int k = 0; k < 3; ++k) point[k] += height * (right_ * right()[k] + up_ * up()[k]);
}

void Camera::Zoom(double factor) { distance *= std::clamp(factor, 0.1, 10.0); }

std::array<double, 3> Camera::backward() const {
  const double across = std::cos(rise), a = std::sin(turn) * across, b = std::cos(turn) * across, h = std::sin(rise);
  return z_up ? Vec3d{a, -b, h} : Vec3d{a, h, b};
}

std::array<double, 3> Camera::right() const {
  const double a = std::cos(turn), b = -std::sin(turn);
  return z_up ? Vec3d{a, -b, 0} : Vec3d{a, 0, b};
}

std::array<double, 3> Camera::up() const { return Cross(backward(), right()); }

Matrix4 Camera::View() const {
  const Vec3d r = right(), u = up(), b = backward();
  Matrix4 m{};
  for (int k = 0; k < 3; ++k) {
    m[4 * k] = static_cast<float>(r[k]);
    m[4 * k + 1] = static_cast<float>(u[k]);
    m[4 * k + 2] = static_cast<float>(b[k]);
  }
  m[12] = static_cast<float>(-Dot(r, point));
  m[13] = static_cast<float>(-Dot(u, point));
  m[14] = static_cast<float>(-Dot(b, point) - distance);
  m[15] = 1;
  return m;
}

Matrix4 Camera::Projection(double aspect) const {
  const double near = distance / 100, far = distance * 100, f = 1 / std::tan(kFieldOfView / 2);
  Matrix4 m{};
  m[0] = static_cast<float>(f / aspect);
  m[5] = static_cast<float>(f);
  m[10] = static_cast<float>((far + near) / (near - far));
  m[11] = -1;
  m[14] = static_cast<float>(2 * far * near / (near - far));
  return m;
}

}  // namespace sac
