// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "synth/kinds.h"
#include "synth/walker_body.h"

namespace sac::synth {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kStoutness = 0.75;  // smallest radius of a part of the body, in lattice spacings

// The numbers that vary from walker to walker.
struct Gait {
  double stride, swing, step_rate, lap_rate, lap_phase, course;  // rad, rad, rad/s, rad/s, rad, m
};

struct Pose {
  std::array<std::array<double, kJoints>, kLimbs> angle;  // about +x; positive moves what hangs down backwards
  double spine, head;                                     // about +y
  double rise;
  Vector3d place;
  double heading;
};

// The angle of an arm, radians, while x goes from `a` to `b`: the arm rises in front until it is over the head, turns
// back through a full circle until it is over the head from behind, and comes down again.
double ArmCircle(double x, double a, double b) {
  const double y = (x - a) / (b - a);
  return y > 0 && y < 1 ? -1.05 * kPi * std::sin(2 * kPi * y) * Fade(3 * y) * Fade(3 - 3 * y) : 0;
}

// The pose at time `t` (seconds) of a walk along a figure of eight. In every fourth double step the arms begin their
// circles, first the left, then the right.
Pose PoseAt(const Gait& gait, double t) {
  Pose pose{};
  const double beat = gait.step_rate * t;
  const double cycle = std::fmod(beat / (2 * kPi) + 3.5, 4);  // in double steps
  for (int side = 0; side < 2; ++side) {
    const double phase = beat + (side == 0 ? 0 : kPi);
    auto& arm = pose.angle[side];
    const double start = side == 0 ? 0.2 : 0.9;
    arm[0] = gait.swing * std::sin(phase) + ArmCircle(cycle, start, start + 2.8);
    arm[1] = -0.35 - 0.3 * gait.swing * (1 - std::sin(phase));
    arm[2] = 0.15 * std::sin(phase + 1);

    auto& leg = pose.angle[2 + side];
    leg[0] = -gait.stride * std::sin(phase) - 0.1;
    const double lift = 0.5 + 0.5 * std::cos(phase + 0.6);  // most when the leg comes forward
    leg[1] = 0.1 + 0.9 * lift * lift;
    leg[2] = -0.25 * std::sin(phase + 0.4) - 0.1;
  }
  pose.spine = 0.16 * std::sin(beat);
  pose.head = 0.5 * std::sin(0.31 * beat) - pose.spine;
  pose.rise = -0.03 + 0.02 * std::cos(2 * beat);
  const double u = gait.lap_rate * t + gait.lap_phase;
  pose.place = {gait.course * std::sin(u), 0, gait.course * std::sin(u) * std::cos(u)};
  pose.heading = std::atan2(std::cos(u), std::cos(2 * u));
  return pose;
}

Vector3d Turn(const Vector3d& p, const Vector3d& centre, double angle, const Vector3d& axis) {
  return centre + AngleAxisd(angle, axis) * (p - centre);
}

Vector3d Place(const WalkerBody& body, const Pose& pose, const Skin& skin, Vector3d p) {
  if (skin.limb >= 0) {
    for (int j = kJoints; j-- > 0;) {
      p = Turn(p, body.joints[skin.limb][j], skin.limb_weight[j] * pose.angle[skin.limb][j], Vector3d::UnitX());
    }
  }
  if (skin.head > 0) p = Turn(p, body.neck, skin.head * pose.head, Vector3d::UnitY());
  p = Turn(p, body.waist, skin.spine * pose.spine, Vector3d::UnitY());
  p[1] += pose.rise;
  return pose.place + AngleAxisd(pose.heading, Vector3d::UnitY()) * p;
}

struct Walker {
  std::shared_ptr<const WalkerBody> body;
  Surface surface;
};

// Makes the body's surface with about `vertices` points. The number of points grows with the inverse square of the
// lattice spacing, so a coarse trial shows which spacing is needed. The body is made thick enough that no thin part is
// lost or torn off at that spacing.
Walker Build(std::uint32_t vertices, const Random& random) {
  Walker walker;
  double spacing = vertices < 5000 ? 0.03 : 0.02;
  for (int trial = 0; trial < 5; ++trial) {
    walker.body = std::make_shared<const WalkerBody>(random, kStoutness * spacing);
    walker.surface = Polygonize(walker.body->field(), spacing);
    const double ratio = static_cast<double>(walker.surface.points.size()) / vertices;
    if (ratio > 0.95 && ratio < 1.05) break;
    spacing *= std::sqrt(ratio);
  }
  return walker;
}

}  // namespace

Animation MakeWalker(std::uint32_t vertices, Random random) {
  const Random body_random(random.Next());
  Gait gait;
  gait.stride = random.Uniform(0.36, 0.46);
  gait.swing = random.Uniform(0.4, 0.7);
  gait.step_rate = 2 * kPi / random.Uniform(0.95, 1.15);
  gait.course = random.Uniform(1.6, 2.4);
  gait.lap_rate = 2 * kPi * 1.25 / (6.1 * gait.course);  // the course is about 6.1 times as long: 1.25 m/s
  gait.lap_phase = random.Angle();

  auto [body, surface] = Build(vertices, body_random);
  std::vector<Skin> skin;
  skin.reserve(surface.points.size());
  for (const Vector3d& p : surface.points) skin.push_back(body->SkinAt(p));
  Animation animation;
  animation.mesh.triangles = std::move(surface.triangles);
  animation.motion = [solid = body, gait, points = std::move(surface.points), skin = std::move(skin)](double t) {
    const Pose pose = PoseAt(gait, t);
    Positions out;
    out.reserve(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) out.push_back(ToFloat(Place(*solid, pose, skin[v], points[v])));
    return out;
  };
  return animation;
}

}  // namespace sac::synth
