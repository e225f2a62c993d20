// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "synth/random.h"
#include "synth/synth.h"

// The functions that make the animation of each SynthKind. They are internal to synth/.
namespace sac::synth {

using Motion = std::function<Positions(double seconds)>;

// A mesh, whose positions the caller sets to motion(0), and its motion in metres.
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

// Rises from 0 at x <= 0 to 1 at x >= 1 with two continuous derivatives (the fade curve of Perlin 2002).
inline double Fade(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * x * (x * (6 * x - 15) + 10);
}

}  // namespace sac::synth
