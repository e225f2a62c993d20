// SPDX-License-Identifier: Apache-2.0
#include "metrics/sted.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "metrics/diameter.h"

namespace sac {
namespace {

double Distance2(const Vec3f& p, const Vec3f& q) {
  const double x = double{p[0]} - q[0], y = double{p[1]} - q[1], z = double{p[2]} - q[2];
  return x * x + y * y + z * z;
}

}  // namespace

SpatialSted::SpatialSted(const std::vector<Triangle>& triangles, std::size_t vertices)
    : graph_(BuildRimGraph(triangles, vertices)),
      length_(graph_.edges.size()),
      change_(graph_.edges.size()),
      spokes_(vertices) {}

void SpatialSted::Add(const Positions& original, const Positions& decoded) {
  assert(original.size() == spokes_.size() && decoded.size() == spokes_.size());
  MeasureEdges(original, decoded);
  for (std::size_t v = 0; v < spokes_.size(); ++v) spokes_[v] = OfSpokes(v);
  double sum = 0;
  for (std::size_t v = 0; v < spokes_.size(); ++v) sum += DeviationNear(v);
  sum_ += sum;
  ++frames_;
}

double SpatialSted::Value() const {
  if (frames_ == 0 || spokes_.empty()) return 0;
  return sum_ / (static_cast<double>(frames_) * static_cast<double>(spokes_.size()));
}

void SpatialSted::MeasureEdges(const Positions& original, const Positions& decoded) {
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const auto [a, b] = graph_.edges[i];
    const double l = std::sqrt(Distance2(original[a], original[b]));
    const double k = std::sqrt(Distance2(decoded[a], decoded[b]));
    length_[i] = l;
    change_[i] = l == 0 ? 0 : (l - k) / l;
  }
}

SpatialSted::Moments SpatialSted::OfSpokes(std::size_t v) const {
  const std::size_t begin = graph_.spoke_start[v], end = graph_.spoke_start[v + 1];
  Moments m{0, 0, 0};
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t e = graph_.spokes[i].edge;
    m.weight += length_[e];
    m.mean += length_[e] * change_[e];
  }
  if (m.weight == 0) return m;
  m.mean /= m.weight;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t e = graph_.spokes[i].edge;
    const double d = change_[e] - m.mean;
    m.squares += length_[e] * d * d;
  }
  return m;
}

// The edges near v are the spokes of its neighbours, where the edges between two neighbours come twice: those are taken
// off once. All moments are about the mean of v's own spokes, which is close to the common mean, so that the difference
// of squares at the end loses nothing even where r is almost the same on all edges.
double SpatialSted::DeviationNear(std::size_t v) const {
  const double about = spokes_[v].mean;
  double weight = 0, first = 0, second = 0;
  for (std::size_t i = graph_.spoke_start[v]; i < graph_.spoke_start[v + 1]; ++i) {
    const Moments& m = spokes_[graph_.spokes[i].vertex];
    const double d = m.mean - about;
    weight += m.weight;
    first += m.weight * d;
    second += m.squares + m.weight * d * d;
  }
  for (std::size_t i = graph_.rim.start[v]; i < graph_.rim.start[v + 1]; ++i) {
    const std::size_t e = graph_.rim.items[i];
    const double d = change_[e] - about;
    weight -= length_[e];
    first -= length_[e] * d;
    second -= length_[e] * d * d;
  }
  if (weight == 0) return 0;
  const double mean = first / weight, variance = second / weight - mean * mean;
  return variance < 0 ? 0 : std::sqrt(variance);
}

TemporalSted::TemporalSted(std::size_t vertices) : history_(vertices) {}

void TemporalSted::Add(const Positions& original, const Positions& decoded) {
  const std::size_t n = history_.size();
  assert(original.size() == n && decoded.size() == n);
  if (frames_ == 0) {
    const double diameter = Diameter(original);
    inverse_diameter2_ = diameter == 0 ? 1 : 1 / (diameter * diameter);
  } else {
    const std::size_t step = frames_ - 1, slot = step % kRing;
    const auto speed = [&](const Vec3f& p, const Vec3f& q) {
      return std::sqrt(Distance2(p, q) * inverse_diameter2_ + kStedTimeStep * kStedTimeStep);
    };
    for (std::size_t v = 0; v < n; ++v) {
      const double s = speed(last_original_[v], original[v]);
      history_[v].speed[slot] = s;
      history_[v].difference[slot] = std::abs(speed(last_decoded_[v], decoded[v]) - s);
    }
    if (step >= kStedWindow) sum_ += StepSum(step - kStedWindow, step + 1);
  }
  last_original_ = original;
  last_decoded_ = decoded;
  ++frames_;
}

double TemporalSted::StepSum(std::size_t i, std::size_t end) const {
  const std::size_t first = i < kStedWindow ? 0 : i - (kStedWindow - 1);
  const std::size_t last = std::min(i + kStedWindow, end - 1);
  const double count = static_cast<double>(last - first + 1);
  double sum = 0;
  for (const History& h : history_) {
    double speed = 0;
    for (std::size_t j = first; j <= last; ++j) speed += h.speed[j % kRing];
    sum += h.difference[i % kRing] * count / speed;
  }
  return sum;
}

double TemporalSted::Value() const {
  if (frames_ < 2 || history_.empty()) return 0;
  const std::size_t steps = frames_ - 1;
  double sum = sum_;
  for (std::size_t i = steps < kStedWindow ? 0 : steps - kStedWindow; i < steps; ++i) sum += StepSum(i, steps);
  return sum / (static_cast<double>(steps) * static_cast<double>(history_.size()));
}

}  // namespace sac
