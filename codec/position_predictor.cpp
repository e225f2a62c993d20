// SPDX-License-Identifier: Apache-2.0
#include "codec/position_predictor.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sac {
namespace {

using Vector = PositionPredictor::Vector;

constexpr std::size_t kMaxParallelograms = 16;
constexpr int kSweeps = 8;
constexpr std::int64_t kMembrane = 39322;                 // 0.3 * 2 in 1/65536
constexpr std::int64_t kFlat = 307;                       // 0.3 in 1/1024
constexpr std::int64_t kOutside = std::int64_t{1} << 30;  // largest magnitude of a guess
constexpr std::int64_t kFar = std::int64_t{1} << 20;      // largest magnitude of an error or feature to learn from

std::int64_t FloorDivide(std::int64_t a, std::int64_t b) {  // b > 0
  const std::int64_t q = a / b;
  return q * b > a ? q - 1 : q;
}

std::int64_t SquareRoot(std::uint64_t x) {  // rounded down
  auto r = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(x)));
  while (r * r > x) --r;
  while ((r + 1) * (r + 1) <= x) ++r;
  return static_cast<std::int64_t>(r);
}

Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator*(std::int64_t s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
std::int64_t Dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
std::int64_t Sum(const Vector& a) { return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]); }
Vector Quotient(const Vector& a, std::int64_t b) {
  return {FloorDivide(a[0], b), FloorDivide(a[1], b), FloorDivide(a[2], b)};
}
std::int64_t Bounded(std::int64_t x) { return std::clamp(x, -kFar, kFar); }

// The cross product of two vectors in cells, halved as a whole until all its components are below 2^15.
Vector ReducedCross(const Vector& a, const Vector& b) {
  Vector n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  while (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) >= 1 << 15) n = {n[0] / 2, n[1] / 2, n[2] / 2};
  return n;
}

}  // namespace

PositionPredictor::PositionPredictor(const PositionGraph& graph, const PositionSteps& steps, int bits)
    : graph_(graph),
      steps_(steps),
      positions_(graph.vertices()),
      known_(graph.vertices(), false),
      slot_(graph.vertices()),
      misses_(graph.vertices(), 0),
      last_cell_((std::int64_t{1} << bits) - 1) {
  last_.fill(std::int64_t{16} << (bits - 1));
  weights_.fill({1 << 15, 0, 0});
}

// Averages the parallelograms of the vertex (spec.md 5.5.3). Each needs an edge opposite the vertex in a triangle, and
// a known vertex on the other side of that edge.
void PositionPredictor::AddParallelograms() {
  std::array<Vector, kMaxParallelograms> corners;
  std::size_t count = 0;
  Vector sum = {};
  normal_ = {};
  for (std::size_t i = 0; i < known_neighbors_.size(); ++i) {
    for (std::size_t j = i + 1; j < known_neighbors_.size(); ++j) {
      const std::uint32_t a = known_neighbors_[i], b = known_neighbors_[j];
      const auto across = graph_.Across(a, b);
      if (!std::binary_search(across.begin(), across.end(), now_.vertex)) continue;
      for (const std::uint32_t c : across) {
        if (c == now_.vertex || !known_[c] || count == kMaxParallelograms) continue;
        corners[count] = positions_[a] + positions_[b] - positions_[c];
        sum = sum + corners[count++];
        const Vector u = positions_[a] - positions_[c], w = positions_[b] - positions_[c];
        const Vector n = ReducedCross({u[0] / 16, u[1] / 16, u[2] / 16}, {w[0] / 16, w[1] / 16, w[2] / 16});
        normal_ = Dot(n, normal_) < 0 ? normal_ - n : normal_ + n;
      }
    }
  }
  now_.support = std::min(count, kSupports - 1);
  parallelogram_ = count > 0 ? Quotient(sum, static_cast<std::int64_t>(count)) : mean_;
  if (count == 0) return;
  for (std::size_t i = 0; i < count; ++i) now_.disagreement += Sum(corners[i] - parallelogram_);
  now_.disagreement /= 3 * static_cast<std::int64_t>(count);
  const std::int64_t length = SquareRoot(static_cast<std::uint64_t>(Dot(normal_, normal_)));
  if (length > 0) {
    for (std::int64_t& x : normal_) x = x * 1024 / length;
  }
}

// Computes the means of positions, prediction errors and edge lengths over the known neighbours and over the known
// neighbours of these (spec.md 5.5.3).
void PositionPredictor::AverageNeighbors() {
  Vector sum = {}, wide_sum = {};
  std::int64_t wide = 0, lengths = 0, misses = 0, wide_misses = 0;
  for (const std::uint32_t b : known_neighbors_) {
    sum = sum + positions_[b];
    misses += misses_[b];
    for (const std::uint32_t w : graph_.Neighbors(b)) {
      if (!known_[w]) continue;
      wide_sum = wide_sum + positions_[w];
      wide_misses += misses_[w];
      const Vector edge = positions_[b] - positions_[w];
      lengths += SquareRoot(static_cast<std::uint64_t>(Dot(edge, edge)));
      ++wide;
    }
  }
  const auto count = static_cast<std::int64_t>(known_neighbors_.size());
  mean_ = Quotient(sum, count);
  wide_mean_ = wide > 0 ? Quotient(wide_sum, wide) : mean_;
  now_.near_miss = misses / count;
  now_.far_miss = wide > 0 ? wide_misses / wide : 0;
  if (wide > 0) length_ = lengths / wide;
}

// Lists the vertex and the unknown vertices up to two edges away in breadth-first order, at most kMaxGuesses.
void PositionPredictor::GatherUnknown() {
  unknown_.clear();
  const auto add = [&](std::uint32_t v) {
    slot_[v] = {now_.vertex + 1, static_cast<std::uint32_t>(unknown_.size())};
    unknown_.push_back(v);
  };
  add(now_.vertex);
  std::size_t at = 0;
  for (int ring = 0; ring < 2; ++ring) {
    for (const std::size_t end = unknown_.size(); at < end; ++at) {
      for (const std::uint32_t w : graph_.Neighbors(unknown_[at])) {
        if (!Given(w) && unknown_.size() < kMaxGuesses) add(w);
      }
    }
  }
}

// The position of the unknown vertex `u` that minimizes the sum of squares of spec.md 5.5.4 while the others stay.
PositionPredictor::Equation PositionPredictor::EquationOf(std::uint32_t u) const {
  Equation e;
  const auto add = [&](std::uint32_t v, std::int64_t factor) {
    e.denominator += v == u ? factor : 0;
    if (v == u) return;
    if (known_[v]) {
      e.constant = e.constant + factor * positions_[v];
    } else {
      e.factors[slot_[v].index] += factor;
    }
  };
  // Adds the term that pulls `c` to the mean of its neighbours.
  const auto bending = [&](std::uint32_t c) {
    const auto around = graph_.Neighbors(c);
    if (!std::all_of(around.begin(), around.end(), [&](std::uint32_t w) { return Given(w); })) return;
    const auto d = static_cast<std::int64_t>(around.size());
    const std::int64_t weight = 65536 / (d * d), own = c == u ? d : -1;
    // The derivative of |d c - sum(around)|^2 / 2 with respect to u is own * (d c - sum(around)).
    add(c, c == u ? weight * d * d : weight * d);
    for (const std::uint32_t w : around) add(w, w == u ? weight : weight * own);
  };
  bending(u);
  for (const std::uint32_t c : graph_.Neighbors(u)) {
    if (!Given(c)) continue;
    bending(c);
    const auto valences = static_cast<std::int64_t>(graph_.Neighbors(u).size() + graph_.Neighbors(c).size());
    add(c, kMembrane / valences);
    e.denominator += kMembrane / valences;
  }
  return e;
}

// The position of the vertex that, together with the unknown vertices around it, bends the surface least
// (spec.md 5.5.4).
PositionPredictor::Vector PositionPredictor::Relax() {
  GatherUnknown();
  std::array<Equation, kMaxGuesses> equations;
  std::array<Vector, kMaxGuesses> guesses;
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    equations[i] = EquationOf(unknown_[i]);
    Vector sum = {};
    std::int64_t count = 0;
    for (const std::uint32_t w : graph_.Neighbors(unknown_[i])) {
      if (!known_[w]) continue;
      sum = sum + positions_[w];
      ++count;
    }
    guesses[i] = parallelogram_;
    if (i > 0 && count > 0) guesses[i] = Quotient(parallelogram_ + Quotient(sum, count), 2);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < unknown_.size(); ++i) {
      Vector sum = equations[i].constant;
      for (std::size_t j = 0; j < unknown_.size(); ++j) sum = sum + equations[i].factors[j] * guesses[j];
      guesses[i] = Quotient(sum, equations[i].denominator);
      for (std::int64_t& x : guesses[i]) x = std::clamp(x, -kOutside, kOutside);
    }
  }
  return guesses[0];
}

void PositionPredictor::Predict(std::uint32_t vertex) {
  now_ = {};
  now_.vertex = vertex;
  now_.axes = {0, 1, 2};
  known_neighbors_.clear();
  for (const std::uint32_t w : graph_.Neighbors(vertex)) {
    if (known_[w]) known_neighbors_.push_back(w);
  }
  now_.neighbours = known_neighbors_.size();
  if (now_.neighbours == 0) {
    now_.centre = now_.relaxed = parallelogram_ = mean_ = wide_mean_ = last_;
    normal_ = {};
  } else {
    AverageNeighbors();
    AddParallelograms();
    now_.relaxed = Relax();
    weights_now_ = &weights_[now_.support];
    for (std::size_t a = 0; a < 3; ++a) {
      features_[a] = {Bounded(now_.relaxed[a] - parallelogram_[a]), Bounded(mean_[a] - parallelogram_[a]),
                      Bounded(wide_mean_[a] - parallelogram_[a])};
      now_.centre[a] = parallelogram_[a] + (Dot(*weights_now_, features_[a]) >> 16);
    }
    std::stable_sort(now_.axes.begin(), now_.axes.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(normal_[a]) < std::abs(normal_[b]); });
  }
  const std::int64_t sixteenths = steps_.base + ((static_cast<std::int64_t>(steps_.slope) * length_) >> 12);
  now_.step = std::clamp<std::int64_t>(sixteenths >> 4, 1, last_cell_ / 2 + 1);
}

// The offset on the last axis at which the plane through `centre` with the predicted normal meets the offsets of the
// first two axes. Zero where that plane is too steep.
std::int64_t PositionPredictor::Along(const Vector& offset) const {
  const std::int64_t n = normal_[now_.axes[2]];
  if (std::abs(n) <= kFlat) return 0;
  const std::int64_t dot = normal_[now_.axes[0]] * offset[0] + normal_[now_.axes[1]] * offset[1];
  return Bounded(FloorDivide(n > 0 ? -dot : dot, std::abs(n)));
}

std::int64_t PositionPredictor::Expected(std::size_t j, const Vector& offset) const {
  std::int64_t at = now_.centre[now_.axes[j]];
  if (j == 2) at += (tangent_weight_ * Along(offset)) >> 16;
  return std::clamp<std::int64_t>((at + 8) >> 4, 0, last_cell_);
}

void PositionPredictor::Learn(const GridPosition& position) {
  const std::uint32_t v = now_.vertex;
  for (std::size_t a = 0; a < 3; ++a) positions_[v][a] = std::int64_t{16} * position[a];
  Vector offset;
  for (std::size_t j = 0; j < 3; ++j) offset[j] = positions_[v][now_.axes[j]] - now_.centre[now_.axes[j]];
  misses_[v] = Sum(offset) / 3;
  last_ = positions_[v];
  known_[v] = true;
  if (now_.neighbours == 0) return;

  const std::int64_t unit = Bounded(16 * now_.step);
  if (std::abs(normal_[now_.axes[2]]) > kFlat) {
    const std::int64_t f = Along(offset);
    const std::int64_t error = Bounded(offset[2] - ((tangent_weight_ * f) >> 16));
    tangent_weight_ += error * f * 655 / (unit * unit + f * f);
    tangent_weight_ = std::clamp<std::int64_t>(tangent_weight_, -(1 << 17), 1 << 17);
  }
  Vector& w = *weights_now_;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vector& f = features_[a];
    const std::int64_t error = Bounded(positions_[v][a] - parallelogram_[a] - (Dot(w, f) >> 16));
    const std::int64_t norm = unit * unit + Dot(f, f);
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = std::clamp<std::int64_t>(w[k] + error * f[k] * 655 / norm, -(1 << 18), 1 << 18);
    }
  }
}

}  // namespace sac
