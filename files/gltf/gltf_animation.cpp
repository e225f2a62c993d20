// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_animation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "files/gltf/gltf_accessor.h"

namespace sac {
namespace {

// A quaternion of length 1, or as it is if it has no length.
void Normalize(std::vector<double>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0)) return;
  for (double& x : q) x /= length;
}

std::vector<double> Slerp(std::vector<double> a, std::vector<double> b, double t) {
  Normalize(a);
  Normalize(b);
  const Eigen::Quaterniond p(a[3], a[0], a[1], a[2]), q(b[3], b[0], b[1], b[2]);
  const Eigen::Quaterniond r = p.slerp(t, q);
  return {r.x(), r.y(), r.z(), r.w()};
}

}  // namespace

GltfAnimation::GltfAnimation(GltfDocument& document, std::size_t index, const std::vector<std::size_t>& weights,
                             Losses& losses) {
  const JsonValue json = document.root()["animations"][index];
  const JsonValue samplers = json["samplers"], channels = json["channels"];
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const JsonValue target = channels[i]["target"];
    const std::string path = target["path"].String();
    if (!target["node"]) {
      losses.Count("animated properties of others than nodes");
      continue;
    }
    Channel channel;
    channel.node = target["node"].Index(weights.size());
    std::size_t components = 3;
    if (path == "translation") {
      channel.target = &NodePose::translation;
    } else if (path == "rotation") {
      channel.target = &NodePose::rotation;
      components = 4;
    } else if (path == "scale") {
      channel.target = &NodePose::scale;
    } else if (path == "weights") {
      channel.target = &NodePose::weights;
      components = weights[channel.node];
    } else {
      losses.List("animated properties", path);
      continue;
    }
    if (components == 0) continue;
    if (path != "weights" && document.root()["nodes"][channel.node]["matrix"]) {
      ThrowCorrupt(channels[i].place() + ": animates a node that has a matrix");
    }
    channel.curve = ReadCurve(document, samplers[channels[i]["sampler"].Index(samplers.size())], components);
    channels_.push_back(channel);
  }
}

std::size_t GltfAnimation::ReadCurve(GltfDocument& document, const JsonValue& sampler, std::size_t components) {
  const std::size_t accessors = document.root()["accessors"].size();
  Curve curve;
  curve.components = components;
  const std::string interpolation = sampler["interpolation"].String();
  if (interpolation == "STEP") {
    curve.interpolation = Interpolation::kStep;
  } else if (interpolation == "CUBICSPLINE") {
    curve.interpolation = Interpolation::kCubicSpline;
  } else if (!interpolation.empty() && interpolation != "LINEAR") {
    ThrowCorrupt(sampler.place() + ".interpolation: unknown");
  }
  curve.times = ReadNumbers(document, sampler["input"].Index(accessors), 1);
  const std::size_t output = sampler["output"].Index(accessors);
  curve.values = ReadNumbers(document, output, DescribeAccessor(document, output).components);
  const std::size_t values = curve.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  if (curve.times.empty() || curve.times.size() * values * components != curve.values.size()) {
    ThrowCorrupt(sampler.place() + ": has " + std::to_string(curve.times.size()) + " keys, and " +
                 std::to_string(curve.values.size()) + " numbers for them");
  }
  for (std::size_t i = 0; i < curve.times.size(); ++i) {
    const float time = curve.times[i];
    if (!std::isfinite(time) || time < 0 || (i > 0 && time < curve.times[i - 1])) {
      ThrowCorrupt(sampler.place() + ".input: times of keys do not ascend from 0");
    }
  }
  for (const float x : curve.values) {
    if (!std::isfinite(x)) ThrowCorrupt(sampler.place() + ".output: not a finite number");
  }
  duration_ = std::max(duration_, static_cast<double>(curve.times.back()));
  curves_.push_back(std::move(curve));
  return curves_.size() - 1;
}

std::vector<double> GltfAnimation::Evaluate(const Curve& curve, double time, bool rotation) {
  const std::size_t n = curve.components;
  const bool cubic = curve.interpolation == Interpolation::kCubicSpline;
  // Value `part` of a key: with cubic splines 0 is the tangent before, 1 the value, 2 the tangent after.
  const auto at = [&](std::size_t key, std::size_t part) {
    const std::size_t first = (cubic ? 3 * key + part : key) * n;
    return std::vector<double>(curve.values.begin() + static_cast<std::ptrdiff_t>(first),
                               curve.values.begin() + static_cast<std::ptrdiff_t>(first + n));
  };
  const auto after =
      static_cast<std::size_t>(std::upper_bound(curve.times.begin(), curve.times.end(), time,
                                                [](double t, float key) { return t < static_cast<double>(key); }) -
                               curve.times.begin());
  std::vector<double> value;
  if (after == 0 || after == curve.times.size() || curve.interpolation == Interpolation::kStep) {
    value = at(after == 0 ? 0 : after - 1, 1);
    if (rotation) Normalize(value);
    return value;
  }
  const double begin = static_cast<double>(curve.times[after - 1]), end = static_cast<double>(curve.times[after]);
  const double length = end - begin, t = (time - begin) / length;
  value = at(after - 1, 1);
  const std::vector<double> next = at(after, 1);
  if (!cubic) {
    if (rotation) return Slerp(value, next, t);
    for (std::size_t k = 0; k < n; ++k) value[k] += t * (next[k] - value[k]);
    return value;
  }
  // Hermite's polynomials (appendix C.5).
  const std::vector<double> out = at(after - 1, 2), in = at(after, 0);
  const double t2 = t * t, t3 = t2 * t;
  for (std::size_t k = 0; k < n; ++k) {
    value[k] = (2 * t3 - 3 * t2 + 1) * value[k] + length * (t3 - 2 * t2 + t) * out[k] + (3 * t2 - 2 * t3) * next[k] +
               length * (t3 - t2) * in[k];
  }
  if (rotation) Normalize(value);
  return value;
}

void GltfAnimation::Apply(double time, std::vector<NodePose>& poses) const {
  for (const Channel& channel : channels_) {
    poses[channel.node].*channel.target = Evaluate(curves_[channel.curve], time, channel.target == &NodePose::rotation);
  }
}

std::optional<unsigned> GltfAnimation::FrameRateOfKeys() const {
  // A key that is this near to a frame, in frames, is one of it: times have 24 bits.
  constexpr double kTolerance = 0.01;
  for (const unsigned rate : {24U, 25U, 30U, 48U, 50U, 60U, 90U, 100U, 120U}) {
    bool fits = true;
    for (const Curve& curve : curves_) {
      for (const float time : curve.times) {
        const double frame = static_cast<double>(time) * rate;
        fits = fits && std::abs(frame - std::round(frame)) < kTolerance;
      }
    }
    if (fits) return rate;
  }
  return std::nullopt;
}

}  // namespace sac
