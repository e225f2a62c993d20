// SPDX-License-Identifier: Apache-2.0
#include "decomposition/component_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "decomposition/run_parallel.h"

namespace sac {
namespace {

constexpr std::size_t kBlock = 128;       // nodes that stay in the cache
constexpr std::size_t kMostChunks = 32;   // of nodes; their sums are added in order, whatever the threads
constexpr std::size_t kLeastChunk = 256;  // nodes
constexpr int kSweeps = 4;
constexpr float kNodeTolerance = 1e-5f;  // relative change of a node's components at which its sweeps end
constexpr double kNoWeight = 1e-12;      // |w|^2 of a component that is never used

// The range of nodes of chunk `chunk` of `chunks`.
struct Chunks {
  explicit Chunks(std::size_t all) : nodes(all), count(std::clamp<std::size_t>(all / kLeastChunk, 1, kMostChunks)) {}
  std::size_t begin(std::size_t chunk) const { return nodes * chunk / count; }
  std::size_t nodes, count;
};

// What the nodes' descent needs of the weights.
struct GramMatrix {
  Eigen::MatrixXf values;       // W^T W
  std::vector<float> diagonal;  // 0: the component is not to be changed
};

GramMatrix MakeGram(const Alternation& state) {
  GramMatrix gram;
  const Eigen::MatrixXd g = state.weights.transpose() * state.weights;
  gram.values = g.cast<float>();
  gram.diagonal.resize(state.count);
  for (std::size_t k = 0; k < state.count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    gram.diagonal[k] = g(i, i) > kNoWeight && state.sites[k].values.empty() ? gram.values(i, i) : 0;
  }
  return gram;
}

// Scratch of one thread's work on a chunk.
struct Descent {
  explicit Descent(std::size_t count) : square(count), active(count) {}
  std::vector<float> square;
  std::vector<char> active;
  std::vector<std::uint32_t> candidates;
};

// r and c are the channels x count values of one node; r holds W^T X and becomes W^T (X - W C).
template <int kChannels>
void DescendNode(const GramMatrix& gram, const float* cost, std::size_t count, float* r, float* c, Descent& d) {
  std::fill(d.active.begin(), d.active.end(), 0);
  for (int a = 0; a < kChannels; ++a) {
    for (std::size_t k = 0; k < count; ++k) d.active[k] = static_cast<char>(d.active[k] | (c[a * count + k] != 0));
  }
  const auto subtract = [&](std::size_t k, const float(&delta)[kChannels]) {
    const float* g = gram.values.data() + k * count;
    for (int a = 0; a < kChannels; ++a) {
      const float factor = delta[a];
      float* row = r + static_cast<std::size_t>(a) * count;
      for (std::size_t l = 0; l < count; ++l) row[l] -= factor * g[l];
    }
  };
  for (std::size_t k = 0; k < count; ++k) {
    if (d.active[k] == 0) continue;
    float value[kChannels];
    for (int a = 0; a < kChannels; ++a) value[a] = c[a * count + k];
    subtract(k, value);
  }
  const float* diagonal = gram.diagonal.data();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::fill(d.square.begin(), d.square.end(), 0.f);
    for (int a = 0; a < kChannels; ++a) {
      for (std::size_t k = 0; k < count; ++k) {
        const float t = r[a * count + k] + diagonal[k] * c[a * count + k];
        d.square[k] += t * t;
      }
    }
    d.candidates.clear();
    for (std::size_t k = 0; k < count; ++k) {
      if (diagonal[k] > 0 && (d.active[k] != 0 || d.square[k] > cost[k] * cost[k])) {
        d.candidates.push_back(static_cast<std::uint32_t>(k));
      }
    }
    float change = 0, size = 0;
    for (const std::uint32_t k : d.candidates) {
      float t[kChannels], length2 = 0;
      for (int a = 0; a < kChannels; ++a) {
        t[a] = r[a * count + k] + diagonal[k] * c[a * count + k];
        length2 += t[a] * t[a];
      }
      const float length = std::sqrt(length2);
      const float shrink = length > cost[k] ? (1 - cost[k] / length) / diagonal[k] : 0;
      float delta[kChannels], moved = 0, now = 0;
      for (int a = 0; a < kChannels; ++a) {
        const float value = shrink * t[a];
        delta[a] = value - c[a * count + k];
        c[a * count + k] = value;
        moved += delta[a] * delta[a];
        now += value * value;
      }
      d.active[k] = now > 0 ? 1 : 0;
      if (moved > 0) subtract(k, delta);
      change += diagonal[k] * moved;
      size += diagonal[k] * now;
    }
    if (change <= kNodeTolerance * size) break;
  }
}

void DescendBlock(const NodeField& field, const GramMatrix& gram, const Eigen::MatrixXf& weights, std::size_t first,
                  std::size_t nodes, RowMatrixF& r, Alternation& state, Descent& descent) {
  const std::size_t rows = nodes * field.channels, count = state.count;
  const Eigen::Map<const RowMatrixF> x(field.row(first), static_cast<Eigen::Index>(rows),
                                       static_cast<Eigen::Index>(field.columns));
  r.noalias() = x * weights;
  for (std::size_t i = 0; i < nodes; ++i) {
    const std::size_t node = first + i;
    if (field.mass[node] == 0) continue;
    float* residual = r.data() + i * field.channels * count;
    float* c = state.components.data() + node * field.channels * count;
    const float* cost = state.cost.data() + node * count;
    if (field.channels == 3) {
      DescendNode<3>(gram, cost, count, residual, c, descent);
    } else {
      DescendNode<9>(gram, cost, count, residual, c, descent);
    }
  }
}

// The sums of a range of nodes; P is still in the field's columns.
void AddBlock(const NodeField& field, const Alternation& state, std::size_t first, std::size_t nodes,
              RowMatrixF& scaled, std::vector<float>& square, PassSums& sums) {
  const std::size_t count = state.count, channels = field.channels;
  const auto rows = static_cast<Eigen::Index>(nodes * channels);
  const Eigen::Map<const RowMatrixF> x(field.row(first), rows, static_cast<Eigen::Index>(field.columns));
  const Eigen::Map<const RowMatrixF> c(state.components.data() + first * channels * count, rows,
                                       static_cast<Eigen::Index>(count));
  scaled = c;
  for (std::size_t i = 0; i < nodes; ++i) {
    const float mass = field.mass[first + i];
    scaled.middleRows(static_cast<Eigen::Index>(i * channels), static_cast<Eigen::Index>(channels)) *= mass;
    std::fill(square.begin(), square.end(), 0.f);
    const float* values = c.data() + i * channels * count;
    for (std::size_t a = 0; a < channels; ++a) {
      for (std::size_t k = 0; k < count; ++k) square[k] += values[a * count + k] * values[a * count + k];
    }
    const float* cost = state.cost.data() + (first + i) * count;
    for (std::size_t k = 0; k < count; ++k) {
      if (square[k] == 0) continue;
      const auto price = static_cast<double>(mass * cost[k] * std::sqrt(square[k]));
      if (std::isfinite(price)) sums.penalty[static_cast<Eigen::Index>(k)] += price;
      if (square[k] > sums.peak_square[k]) {
        sums.peak_square[k] = square[k];
        sums.peak[k] = static_cast<std::uint32_t>(first + i);
      }
    }
  }
  sums.p += (x.transpose() * scaled).cast<double>();
  sums.h += (c.transpose() * scaled).cast<double>();
}

PassSums EmptySums(std::size_t rows, std::size_t count) {
  const auto k = static_cast<Eigen::Index>(count);
  return {Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), k), Eigen::MatrixXd::Zero(k, k),
          Eigen::VectorXd::Zero(k), std::vector<std::uint32_t>(count, 0), std::vector<float>(count, 0)};
}

}  // namespace

void RunPass(const NodeField& field, bool update, std::uint32_t threads, Alternation& state, PassSums& sums) {
  const GramMatrix gram = MakeGram(state);
  const Eigen::MatrixXf weights = field.Project(state.weights);
  const Chunks chunks(field.nodes);
  std::vector<PassSums> parts(chunks.count);
  RunParallel(chunks.count, threads, [&](std::size_t chunk) {
    PassSums part = EmptySums(field.columns, state.count);
    RowMatrixF scratch;
    Descent descent(state.count);
    std::vector<float> square(state.count);
    const std::size_t end = chunks.begin(chunk + 1);
    for (std::size_t first = chunks.begin(chunk); first < end; first += kBlock) {
      const std::size_t nodes = std::min(kBlock, end - first);
      if (update) DescendBlock(field, gram, weights, first, nodes, scratch, state, descent);
      AddBlock(field, state, first, nodes, scratch, square, part);
    }
    parts[chunk] = std::move(part);
  });
  sums = std::move(parts[0]);
  for (std::size_t chunk = 1; chunk < chunks.count; ++chunk) {
    const PassSums& part = parts[chunk];
    sums.p += part.p;
    sums.h += part.h;
    sums.penalty += part.penalty;
    for (std::size_t k = 0; k < state.count; ++k) {
      if (part.peak_square[k] <= sums.peak_square[k]) continue;
      sums.peak_square[k] = part.peak_square[k];
      sums.peak[k] = part.peak[k];
    }
  }
  if (field.basis.size() > 0) sums.p = (field.basis.cast<double>() * sums.p).eval();
}

double ResidualSquare(const NodeField& field, const Alternation& state, std::uint32_t threads) {
  const Eigen::MatrixXf weights = state.weights.cast<float>();
  const Chunks chunks(field.nodes);
  std::vector<double> parts(chunks.count, 0);
  RunParallel(chunks.count, threads, [&](std::size_t chunk) {
    RowMatrixF difference;
    const std::size_t end = chunks.begin(chunk + 1);
    for (std::size_t first = chunks.begin(chunk); first < end; first += kBlock) {
      const std::size_t nodes = std::min(kBlock, end - first);
      const auto rows = static_cast<Eigen::Index>(nodes * field.channels);
      const Eigen::Map<const RowMatrixF> x(field.row(first), rows, static_cast<Eigen::Index>(field.columns));
      const Eigen::Map<const RowMatrixF> c(state.components.data() + first * field.channels * state.count, rows,
                                           static_cast<Eigen::Index>(state.count));
      if (field.basis.size() > 0) {
        difference.noalias() = x * field.basis.transpose();
      } else {
        difference = x;
      }
      difference.noalias() -= c * weights.transpose();
      for (std::size_t i = 0; i < nodes; ++i) {
        const auto block = difference.middleRows(static_cast<Eigen::Index>(i * field.channels),
                                                 static_cast<Eigen::Index>(field.channels));
        parts[chunk] += static_cast<double>(field.mass[first + i]) * static_cast<double>(block.squaredNorm());
      }
    }
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

}  // namespace sac
