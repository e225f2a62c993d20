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

// The weights by which the joints move one point of the body. A joint that turns by an angle turns the point by the
// angle times the point's weight. The surface then bends evenly around the joint, and it neither tears nor collapses
// however far the joint turns.
struct Skin {
  int limb = -1;  // the limb that the point belongs to; -1: none
  std::array<double, kJoints> limb_weight{};
  double spine = 0, head = 0;
};

// A standing figure of blended rounded capsules, about 1.75 m high, facing positive z, arms held out.
class WalkerBody {
 public:
  // No part of the body has a radius below `least_radius` (metres).
  WalkerBody(Random random, double least_radius);

  // The field whose zero set is the body's surface. It refers to this object.
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
    Eigen::Vector3d gradient;  // approximate, without the change of the radius along the segment
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
