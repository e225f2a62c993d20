// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "synth/kinds.h"

namespace sac::synth {
namespace {

constexpr double kWidth = 1.5, kHeight = 1;  // metres
constexpr double kDroop = 0.12;              // how far the free end sinks

// A wave that travels away from the pole. It bends the cloth by an angle (radians) of
// amplitude sin(along x + across y - rate t + phase).
struct Wave {
  double amplitude, along, across, rate, phase;
};

using Waves = std::array<Wave, 14>;

// Wavelengths fall from 1.4 m to 6 cm; the slopes fall more slowly than the wavelengths, so that fine wrinkles show.
// Waves that a grid of the given step would not resolve are left out.
Waves RandomWaves(double step, Random& random) {
  Waves waves;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double wavelength = 1.4 * std::pow(0.06 / 1.4, static_cast<double>(i) / (waves.size() - 1.0));
    Wave& w = waves[i];
    const double number = 2 * std::numbers::pi / wavelength;
    w.along = number * random.Uniform(0.85, 1.1);
    w.across = number * random.Uniform(-0.45, 0.45);
    w.amplitude = 0.55 * std::pow(wavelength / 1.4, 0.5) * random.Uniform(0.6, 1);
    w.rate = 7 * std::sqrt(1.4 / wavelength) * random.Uniform(0.8, 1.2);  // short waves travel slower, as on water
    w.phase = random.Angle();
    if (wavelength < 5 * step) w.amplitude = 0;
  }
  return waves;
}

// The positions of the cloth at time `t` (seconds). Each row runs from the pole in steps of constant length whose
// directions are given by the waves, so that the cloth bends but does not stretch along its rows.
Positions Blow(const Waves& waves, std::uint32_t columns, std::uint32_t rows, double t) {
  const double gust = 1 + 0.35 * std::sin(1.3 * t) * std::sin(0.7 * t + 1);
  const double step = kWidth / (columns - 1);
  Positions out;
  out.reserve(std::size_t{columns} * rows);
  for (std::uint32_t r = 0; r < rows; ++r) {
    const double y = kHeight * r / (rows - 1);
    double px = 0, pz = 0;
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double x = step * c;
      const double free = x / kWidth, droop = kDroop * free * free;
      out.push_back({static_cast<float>(px), static_cast<float>(y - droop), static_cast<float>(pz)});
      double slope = 0;
      const double s = x + step / 2;
      for (const auto& w : waves) slope += w.amplitude * std::sin(w.along * s + w.across * y - w.rate * t + w.phase);
      slope *= gust * Fade(0.25 + 1.5 * free);
      const double sink = 2 * kDroop * s / (kWidth * kWidth), run = std::sqrt(1 - sink * sink);
      px += step * run * std::cos(slope);
      pz += step * run * std::sin(slope);
    }
  }
  return out;
}

}  // namespace

Animation MakeFlag(std::uint32_t vertices, Random random) {
  const double wanted_rows = std::sqrt(vertices * kHeight / kWidth);
  const auto rows = std::max<std::uint32_t>(2, static_cast<std::uint32_t>(std::lround(wanted_rows)));
  const auto columns = std::max<std::uint32_t>(2, (vertices + rows / 2) / rows);
  Animation animation;
  Mesh& mesh = animation.mesh;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      mesh.uvs.push_back({static_cast<float>(c) / (columns - 1), static_cast<float>(r) / (rows - 1)});
      if (r + 1 == rows || c + 1 == columns) continue;
      const std::uint32_t a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      // The diagonals alternate, so that the cloth has no preferred direction.
      if ((r + c) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, e}, {a, e, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, e, d}});
      }
    }
  }
  mesh.uv_triangles = mesh.triangles;
  animation.motion = [waves = RandomWaves(kWidth / (columns - 1), random), columns, rows](double t) {
    return Blow(waves, columns, rows, t);
  };
  return animation;
}

}  // namespace sac::synth
