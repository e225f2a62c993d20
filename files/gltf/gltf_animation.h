// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "files/gltf/gltf_document.h"
#include "files/losses.h"

namespace sac {

// A node's transform and weights, as they are or as they are animated (glTF 2.0, 3.5.3).
struct NodePose {
  std::vector<double> translation = {0, 0, 0}, rotation = {0, 0, 0, 1}, scale = {1, 1, 1};  // rotation x, y, z, w
  std::vector<double> weights;                                                              // of morph targets
};

// The curves of one animation (3.11).
class GltfAnimation {
 public:
  // `weights` holds for each node how many weights it has. Throws GltfError.
  GltfAnimation(GltfDocument& document, std::size_t index, const std::vector<std::size_t>& weights, Losses& losses);

  // Sets what is animated at `time`, in seconds. Before the first and after the last key a curve keeps its value.
  void Apply(double time, std::vector<NodePose>& poses) const;

  // The time of the last key, seconds.
  double duration() const { return duration_; }

  // The lowest usual frame rate whose frames hold all keys; nothing where there is none.
  std::optional<unsigned> FrameRateOfKeys() const;

 private:
  enum class Interpolation { kStep, kLinear, kCubicSpline };
  struct Curve {
    std::vector<float> times, values;
    std::size_t components = 0;  // of a value
    Interpolation interpolation = Interpolation::kLinear;
  };
  struct Channel {
    std::size_t node = 0, curve = 0;
    std::vector<double> NodePose::*target = nullptr;
  };

  std::size_t ReadCurve(GltfDocument& document, const JsonValue& sampler, std::size_t components);
  static std::vector<double> Evaluate(const Curve& curve, double time, bool rotation);

  std::vector<Curve> curves_;
  std::vector<Channel> channels_;
  double duration_ = 0;
};

}  // namespace sac
