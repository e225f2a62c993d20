// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "synth/random.h"
#include "synth/synth.h"

// Internal: one maker for each SynthKind.
namespace sac::synth {

using Motion = std::function<Positions(double seconds)>;

// A mesh whose positions are set by motion(0) afterwards.
struct Animation {
  Mesh mesh;
  Motion motion;
};

Animation MakeWalker(std::uint32_t vertices, Random random);
Animation MakeFlag(std::uint32_t vertices, Random random);
Animation MakeSphere(std::uint32_t vertices, Random random);
Animation MakeParts(std::uint32_t vertices, Random random);
Animation MakeVase(std::uint32_t vertices, Random random);

inline Vec3f ToFloat(const Eigen::Vector3d& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// 0 up to x = 0, 1 from x = 1 on, in between with two continuous derivatives (Perlin's fade curve).
inline double Fade(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * x * (x * (6 * x - 15) + 10);
}

}  // namespace sac::synth
