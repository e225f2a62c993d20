// SPDX-License-Identifier: Apache-2.0
#include "synth/walker_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "synth/kinds.h"

namespace sac::synth {
namespace {

using Eigen::Vector3d;

// Capsules that are closer to each other than about this distance (metres) blend.
constexpr double kBlend = 0.014;
// A capsule that is farther away than the closest one by this distance changes the sum by less than rounding.
constexpr double kNegligible = 40 * kBlend;

constexpr std::size_t kMostCapsules = 24;

// The radius of a capsule changes by less than a quarter of its length, so its distance grows by at most this factor
// per unit of length.
constexpr double kSteepest = 1.04;

}  // namespace

WalkerBody::WalkerBody(Random random, double least_radius)
    : stoutness_(random.Uniform(0.9, 1.12)), least_radius_(least_radius) {
  Add(-1, {-0.07, 0.97, -0.01}, {0.07, 0.97, -0.01}, 0.105, 0.105);  // hips
  Add(-1, {0, 1.02, 0}, {0, 1.28, 0.01}, 0.105, 0.12);               // belly
  Add(-1, {-0.08, 1.32, 0.01}, {0.08, 1.32, 0.01}, 0.105, 0.105);    // chest
  Add(-1, {-0.15, 1.41, 0}, {0.15, 1.41, 0}, 0.062, 0.062);          // shoulders
  Add(-1, {0, 1.4, 0}, {0, 1.56, 0.01}, 0.058, 0.05);                // neck
  Add(-1, {0, 1.62, 0.02}, {0, 1.69, 0.005}, 0.078, 0.092);          // head
  Add(-1, {0, 1.62, 0.1}, {0, 1.645, 0.095}, 0.016, 0.012);          // nose
  waist = {0, 1.08, 0};
  neck = {0, 1.5, 0};
  AddArm(0, 1);
  AddArm(1, -1);
  AddLeg(2, 1);
  AddLeg(3, -1);
}

void WalkerBody::Add(int limb, const Vector3d& from, const Vector3d& to, double from_radius, double to_radius) {
  const auto radius = [this](double r) { return std::max(stoutness_ * r, least_radius_); };
  capsules_.push_back({from, to, radius(from_radius), radius(to_radius), limb});
}

void WalkerBody::AddArm(int limb, double side) {
  const Vector3d down(side * 0.64, -0.768, 0);
  const Vector3d shoulder(side * 0.19, 1.41, 0), elbow = shoulder + 0.28 * down, wrist = elbow + 0.25 * down;
  const Vector3d fingers = wrist + 0.11 * down + Vector3d(0, 0, 0.01),
                 thumb = wrist + 0.05 * down + Vector3d(0, 0, 0.055);
  Add(limb, shoulder, elbow, 0.055, 0.043);
  Add(limb, elbow, wrist, 0.043, 0.031);
  Add(limb, wrist, fingers, 0.033, 0.028);
  Add(limb, wrist, thumb, 0.022, 0.017);
  joints[limb] = {shoulder, elbow, wrist};
}

void WalkerBody::AddLeg(int limb, double side) {
  const Vector3d hip(side * 0.105, 0.9, 0), knee(side * 0.14, 0.5, 0.01), ankle(side * 0.17, 0.09, -0.01);
  const Vector3d heel(side * 0.17, 0.045, -0.035), toes(side * 0.19, 0.035, 0.15);
  Add(limb, hip, knee, 0.085, 0.056);
  Add(limb, knee, ankle, 0.058, 0.038);
  Add(limb, heel, toes, 0.042, 0.034);
  joints[limb] = {hip, knee, ankle};
}

WalkerBody::Nearest WalkerBody::To(const Capsule& capsule, const Vector3d& p) {
  const Vector3d axis = capsule.to - capsule.from;
  const double x = std::clamp((p - capsule.from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  const Vector3d d = p - (capsule.from + x * axis);
  const double norm = d.norm();
  return {norm - (capsule.from_radius + x * (capsule.to_radius - capsule.from_radius)),
          norm > 0 ? Vector3d(d / norm) : d};
}

// The smooth minimum of the distances to the capsules: -k log(sum exp(-distance / k)).
double WalkerBody::Value(const Vector3d& p) const {
  std::array<double, kMostCapsules> distance;
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    distance[i] = To(capsules_[i], p).distance;
    least = std::min(least, distance[i]);
  }
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    if (distance[i] < least + kNegligible) sum += std::exp((least - distance[i]) / kBlend);
  }
  return (least - kBlend * std::log(sum)) / kSteepest;
}

FieldSample WalkerBody::Sample(const Vector3d& p) const {
  std::array<Nearest, kMostCapsules> nearest;
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    nearest[i] = To(capsules_[i], p);
    least = std::min(least, nearest[i].distance);
  }
  Vector3d gradient = Vector3d::Zero();
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    if (nearest[i].distance >= least + kNegligible) continue;
    const double weight = std::exp((least - nearest[i].distance) / kBlend);
    gradient += weight * nearest[i].gradient;
    sum += weight;
  }
  return {(least - kBlend * std::log(sum)) / kSteepest, gradient / (sum * kSteepest)};
}

Field WalkerBody::field() const {
  Field field{[this](const Vector3d& p) { return Value(p); }, [this](const Vector3d& p) { return Sample(p); }, {}, {}};
  field.low = field.high = capsules_[0].from;
  for (const Capsule& c : capsules_) {
    // Where k capsules meet, the blend lies up to kBlend log k farther out.
    const Vector3d margin = Vector3d::Constant(std::max(c.from_radius, c.to_radius) + 3 * kBlend);
    for (const Vector3d& end : {c.from, c.to}) {
      field.low = field.low.cwiseMin(end - margin);
      field.high = field.high.cwiseMax(end + margin);
    }
  }
  return field;
}

Skin WalkerBody::SkinAt(const Vector3d& p) const {
  std::array<double, kLimbs + 1> distance;  // the trunk's at the end
  distance.fill(std::numeric_limits<double>::infinity());
  for (const Capsule& c : capsules_) {
    double& d = distance[static_cast<std::size_t>(c.limb < 0 ? kLimbs : c.limb)];
    d = std::min(d, To(c, p).distance);
  }
  const auto closest = std::min_element(distance.begin(), distance.end());
  const int limb = static_cast<int>(closest - distance.begin());
  Skin skin;
  skin.spine = Fade((p[1] - 0.98) / 0.4);
  if (limb == kLimbs) {
    skin.head = Fade((p[1] - 1.46) / 0.13);
    return skin;
  }

  // The weight of a limb is 0 where the rest of the body is as close, and 1 where the limb is clearly closer.
  double others = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kLimbs; ++i) {
    if (i != limb) others = std::min(others, distance[i]);
  }
  const auto& [first, second, third] = joints[limb];
  skin.limb = limb;
  skin.limb_weight[0] = Fade((others - *closest) / 0.16);
  skin.limb_weight[1] = skin.limb_weight[0] * Fade((p - second).dot((second - first).normalized()) / 0.12 + 0.5);
  skin.limb_weight[2] = skin.limb_weight[0] * Fade((p - third).dot((third - second).normalized()) / 0.08 + 0.5);
  if (limb < 2) skin.spine += (1 - skin.spine) * skin.limb_weight[0];
  if (limb >= 2) skin.spine *= 1 - skin.limb_weight[0];
  return skin;
}

}  // namespace sac::synth
