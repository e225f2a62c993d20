// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>

namespace sac::synth {

// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014): the same numbers
// on every machine, which the distributions of the standard library do not promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  // A number that is evenly distributed in [low, high).
  double Uniform(double low, double high) { return low + (high - low) * (static_cast<double>(Next() >> 11) * 0x1p-53); }

  double Angle() { return Uniform(0, 2 * std::numbers::pi); }

  // A unit vector that is evenly distributed over the unit sphere.
  Eigen::Vector3d Direction() {
    for (;;) {
      const double x = Uniform(-1, 1), y = Uniform(-1, 1), z = Uniform(-1, 1);
      const Eigen::Vector3d d(x, y, z);
      if (const double norm = d.norm(); norm > 0.1 && norm < 1) return d / norm;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace sac::synth
