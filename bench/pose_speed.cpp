// SPDX-License-Identifier: Apache-2.0
// How fast components are posed, fitted and dragged, on one thread: 50 components of a synthetic walker. The first
// argument of a benchmark is the domain (0: displacements, 1: gradients), the second the number of vertices asked for.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sac/component_poser.h"
#include "sac/sparse_components.h"
#include "synth/synth.h"

namespace sac::bench {
namespace {

constexpr std::uint32_t kFrames = 40, kComponents = 50;

void Require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "pose_speed: %s\n", status.message().c_str());
  std::exit(1);
}

struct Posed {
  std::vector<Positions> frames;
  std::unique_ptr<ComponentPoser> poser;

  std::span<const float> weights(std::uint32_t f) const {
    return std::span(poser->components().weights).subspan(std::size_t{f} * kComponents, kComponents);
  }
};

Posed MakePosed(ComponentDomain domain, std::uint32_t vertices) {
  SynthClip clip;
  Require(SynthClip::Create({.kind = SynthKind::kWalker, .vertices = vertices, .frames = kFrames}, clip));
  DecompositionSettings settings;
  settings.domain = domain;
  settings.count = kComponents;
  settings.iterations = 20;
  SparseComponents components;
  DecompositionReport report;
  Require(DecomposeClip(clip, settings, components, report));
  Posed posed;
  for (std::uint32_t f = 0; f < kFrames; ++f) posed.frames.push_back(clip.Frame(f));
  Require(ComponentPoser::Create(std::move(components), posed.poser));
  return posed;
}

const Posed& PosedWalker(const benchmark::State& state) {
  static std::map<std::pair<std::int64_t, std::int64_t>, Posed> made;
  const auto key = std::pair(state.range(0), state.range(1));
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  const auto domain = key.first == 0 ? ComponentDomain::kDisplacement : ComponentDomain::kGradient;
  return made.emplace(key, MakePosed(domain, static_cast<std::uint32_t>(key.second))).first->second;
}

// The root mean square distance of two shapes, in thousandths of the longest side of the second one's box.
double Distance(const Positions& a, const Positions& b) {
  double square = 0, side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t v = 0; v < a.size(); ++v) {
      const auto x = static_cast<double>(a[v][axis]), y = static_cast<double>(b[v][axis]);
      square += (x - y) * (x - y);
      low = std::min(low, y);
      high = std::max(high, y);
    }
    side = std::max(side, high - low);
  }
  return 1000 * std::sqrt(square / (3 * static_cast<double>(a.size()))) / side;
}

void Compose(benchmark::State& state) {
  const Posed& posed = PosedWalker(state);
  Positions shape;
  std::uint32_t f = 0;
  for ([[maybe_unused]] auto step : state) {
    f = (f + 7) % kFrames;
    Require(posed.poser->Compose(posed.weights(f), posed.poser->components().track[f], shape));
  }
  state.counters["vertices"] = static_cast<double>(shape.size());
}

void Fit(benchmark::State& state) {
  const Posed& posed = PosedWalker(state);
  std::vector<float> weights;
  RigidPose pose;
  std::uint32_t f = 0;
  for ([[maybe_unused]] auto step : state) {
    f = (f + 7) % kFrames;
    Require(posed.poser->Fit(posed.frames[f], weights, pose));
  }
  double error = 0;
  Positions shape;
  for (f = 0; f < kFrames; ++f) {
    Require(posed.poser->Fit(posed.frames[f], weights, pose));
    Require(posed.poser->Compose(weights, pose, shape));
    error += Distance(shape, posed.frames[f]) / kFrames;
  }
  state.counters["Erms"] = error;
}

// The third argument is the number of vertices that are dragged. They go along their own way in the clip, ahead of the
// rest by five frames.
void Drag(benchmark::State& state) {
  const Posed& posed = PosedWalker(state);
  const auto count = static_cast<std::size_t>(state.range(2));
  std::vector<float> weights;
  std::vector<DragTarget> targets(count);
  DragSettings settings;
  std::uint32_t f = 0;
  double left = 0, all = 0;
  Positions shape;
  for ([[maybe_unused]] auto step : state) {
    state.PauseTiming();
    f = (f + 7) % (kFrames - 5);
    settings.start.assign(posed.weights(f).begin(), posed.weights(f).end());
    settings.pose = posed.poser->components().track[f];
    for (std::size_t i = 0; i < count; ++i) {
      const auto v = static_cast<std::uint32_t>((2 * i + 1) * posed.frames[f].size() / (2 * count));
      targets[i] = {v, posed.frames[f + 5][v]};
    }
    state.ResumeTiming();
    Require(posed.poser->Drag(targets, settings, weights));
    state.PauseTiming();
    const auto add = [&](std::span<const float> w, double& sum) {
      Require(posed.poser->Compose(w, settings.pose, shape));
      for (const DragTarget& t : targets) {
        for (std::size_t a = 0; a < 3; ++a) {
          sum += std::pow(static_cast<double>(shape[t.vertex][a]) - static_cast<double>(t.position[a]), 2);
        }
      }
    };
    add(weights, left);
    add(settings.start, all);
    state.ResumeTiming();
  }
  state.counters["missed"] = std::sqrt(left / all);  // share of the way
}

void Clips(benchmark::internal::Benchmark* b) {
  for (const std::int64_t domain : {0, 1}) b->Args({domain, 10000});
  b->Unit(benchmark::kMillisecond);
}

void Drags(benchmark::internal::Benchmark* b) {
  for (const std::int64_t domain : {0, 1}) {
    for (const std::int64_t count : {1, 4}) b->Args({domain, 10000, count});
  }
  b->Unit(benchmark::kMillisecond);
}

BENCHMARK(Compose)->Apply(Clips);
BENCHMARK(Fit)->Apply(Clips);
BENCHMARK(Drag)->Apply(Drags);

}  // namespace
}  // namespace sac::bench
