// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "synth/implicit_surface.h"
#include "synth/random.h"

namespace sac::synth {

inline constexpr int kLimbs = 4;   // left arm, right arm, left leg, right leg; left is at positive x
inline constexpr int kJoints = 3;  // shoulder, elbow, wrist or hip, knee, ankle

// How the joints move one point of the body. A joint of angle a turns the point by weight * a, so that the surface
// bends evenly around a joint and neither tears nor collapses however far the joint turns.
struct Skin {
  int limb = -1;  // -1: none
  std::array<double, kJoints> limb_weight{};
  double spine = 0, head = 0;
};

// A standing figure of blended rounded capsules, about 1.75 m high, facing positive z, arms held out.
class WalkerBody {
 public:
  // No part is thinner than twice `least_radius`, in metres.
  WalkerBody(Random random, double least_radius);

  // The body's surface; it refers to this body.
  Field field() const;

  Skin SkinAt(const Eigen::Vector3d& p) const;

  std::array<std::array<Eigen::Vector3d, kJoints>, kLimbs> joints;
  Eigen::Vector3d waist, neck;

 private:
  // The points within a radius of a segment; the radius changes along it.
  struct Capsule {
    Eigen::Vector3d from, to;
    double from_radius, to_radius;
    int limb;  // -1: trunk and head
  };
  struct Nearest {
    double distance;           // signed
    Eigen::Vector3d gradient;  // nearly: the change of the radius is left out
  };
  static Nearest To(const Capsule& capsule, const Eigen::Vector3d& p);
  double Value(const Eigen::Vector3d& p) const;
  FieldSample Sample(const Eigen::Vector3d& p) const;

  void Add(int limb, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double from_radius, double to_radius);
  void AddArm(int limb, double side);
  void AddLeg(int limb, double side);

  std::vector<Capsule> capsules_;
  double stoutness_, least_radius_;
};

}  // namespace sac::synth
