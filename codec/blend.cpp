// SPDX-License-Identifier: Apache-2.0
#include "codec/blend.h"

#include <algorithm>
#include <utility>

namespace sac {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

int Index(std::size_t i) { return static_cast<int>(i); }

}  // namespace

// A sparse row over the handles of a component, kWidth values each.
template <int kWidth>
class Blend::Row {
 public:
  using Values = Eigen::Matrix<double, 1, kWidth>;
  explicit Row(const Component& handles) : first_(handles.first), place_(handles.count, kNone) {}
  Values& operator[](std::uint32_t handle) {
    std::uint32_t& place = place_[handle - first_];
    if (place == kNone) {
      place = static_cast<std::uint32_t>(handles_.size());
      handles_.push_back(handle - first_);
      values_.push_back(Values::Zero());
    }
    return values_[place];
  }
  void Clear() {
    for (const std::uint32_t h : handles_) place_[h] = kNone;
    handles_.clear();
    values_.clear();
  }
  const std::vector<std::uint32_t>& handles() const { return handles_; }  // numbered within the component
  const std::vector<Values>& values() const { return values_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t first_;
  std::vector<std::uint32_t> place_, handles_;
  std::vector<Values> values_;
};

Blend::Blend(Handles handles, std::vector<Component> components, const EdgeGraph& graph,
             const PositionMatrix& positions, const Eigen::RowVector3d& centre)
    : handles_(std::move(handles)), components_(std::move(components)), offsets_(positions.rowwise() - centre) {
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const std::uint32_t count = handles_.components[c].count, width = count == components_[c].count ? 1 : 4;
    functions_.push_back({columns_, width * count});
    columns_ += width * count;
    pairs_.push_back(IsAffine(c) ? PairsOf(c, graph) : Pairs());
  }
}

void Blend::MoveToOrigin(RowMatrix& z) const {
  for (std::size_t c = 0; c < components_.size(); ++c) {
    if (!IsAffine(c)) continue;
    const Component& run = handles_.components[c];
    for (std::uint32_t h = run.first; h < run.first + run.count; ++h) {
      const Eigen::Index t = Translation(c, h);
      for (Eigen::Index a = 0; a < 3; ++a) z.row(t) -= offsets_(handles_.vertices[h], a) * z.row(t - 3 + a);
    }
  }
}

void Blend::Translate(const Eigen::RowVector3d& by, RowMatrix& about_origin) const {
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const Component& run = functions_[c];
    const std::uint32_t width = Width(c);
    for (std::uint32_t t = run.first + width - 1; t < run.first + run.count; t += width) about_origin.row(t) += by;
  }
}

void Blend::Apply(const RowMatrix& about_origin, PositionMatrix& out) const {
  using Affine = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;
  out.resize(offsets_.rows(), 3);
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const Component& run = components_[c];
    if (!IsAffine(c)) {
      out.middleRows(run.first, run.count) = about_origin.middleRows(functions_[c].first, run.count);
      continue;
    }
    const double* const first = about_origin.row(functions_[c].first).data();
    const std::uint32_t first_handle = handles_.components[c].first;
    for (std::uint32_t v = run.first; v < run.first + run.count; ++v) {
      const std::span<const std::uint32_t> followed = handles_.FollowedBy(v);
      const double* const weights = handles_.WeightsOf(v);
      Affine blend = Affine::Zero();
      for (std::size_t i = 0; i < followed.size(); ++i) {
        blend += weights[i] * Eigen::Map<const Affine>(first + std::ptrdiff_t{12} * (followed[i] - first_handle));
      }
      out.row(v) =
          offsets_(v, 0) * blend.row(0) + offsets_(v, 1) * blend.row(1) + offsets_(v, 2) * blend.row(2) + blend.row(3);
    }
  }
}

Blend::Functions Blend::At(std::uint32_t vertex, std::uint32_t handle, double weight) const {
  Functions f;
  f << weight * (offsets_.row(vertex) - offsets_.row(handles_.vertices[handle])).transpose(), weight;
  return f;
}

Eigen::MatrixXd Blend::TransposeTimes(const Eigen::MatrixXd& field) const {
  RowMatrix out = RowMatrix::Zero(columns_, field.cols());
  const RowMatrix rows = field;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const Component& run = components_[c];
    if (!IsAffine(c)) {
      out.middleRows(functions_[c].first, run.count) = rows.middleRows(run.first, run.count);
      continue;
    }
    for (std::uint32_t v = run.first; v < run.first + run.count; ++v) {
      const std::span<const std::uint32_t> followed = handles_.FollowedBy(v);
      for (std::size_t i = 0; i < followed.size(); ++i) {
        const Functions f = At(v, followed[i], handles_.WeightsOf(v)[i]);
        const Eigen::Index t = Translation(c, followed[i]);
        for (Eigen::Index k = 0; k < 4; ++k) out.row(t - 3 + k) += f[k] * rows.row(v);
      }
    }
  }
  return out;
}

Eigen::MatrixXd Blend::AtHandles(std::size_t c, const Eigen::MatrixXd& z) const {
  if (!IsAffine(c)) return z;
  const Component& run = handles_.components[c];
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(run.count, z.cols());
  for (std::uint32_t h = 0; h < run.count; ++h) {
    const std::uint32_t v = handles_.vertices[run.first + h];
    const std::span<const std::uint32_t> followed = handles_.FollowedBy(v);
    for (std::size_t i = 0; i < followed.size(); ++i) {
      const Functions f = At(v, followed[i], handles_.WeightsOf(v)[i]);
      out.row(h) += f.transpose() * z.middleRows(4 * static_cast<Eigen::Index>(followed[i] - run.first), 4);
    }
  }
  return out;
}

Blend::Pairs Blend::PairsOf(std::size_t c, const EdgeGraph& graph) const {
  const Component &run = handles_.components[c], &vertices = components_[c];
  // The vertices that follow each handle.
  std::vector<std::uint32_t> offsets(run.count + std::size_t{1}, 0), moved;
  for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
    for (const std::uint32_t h : handles_.FollowedBy(v)) ++offsets[h - run.first + 1];
  }
  for (std::uint32_t h = 0; h < run.count; ++h) offsets[h + 1] += offsets[h];
  moved.resize(offsets[run.count]);
  std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
    for (const std::uint32_t h : handles_.FollowedBy(v)) moved[next[h - run.first]++] = v;
  }

  Pairs pairs;
  pairs.offsets = {0};
  std::vector<std::uint32_t> seen(run.count, run.count);
  for (std::uint32_t i = 0; i < run.count; ++i) {
    const std::size_t begin = pairs.columns.size();
    const auto add = [&](std::uint32_t v) {
      for (const std::uint32_t h : handles_.FollowedBy(v)) {
        if (std::exchange(seen[h - run.first], i) != i) pairs.columns.push_back(h - run.first);
      }
    };
    for (std::uint32_t m = offsets[i]; m < offsets[i + 1]; ++m) {
      add(moved[m]);
      for (std::uint32_t e = graph.offsets[moved[m]]; e < graph.offsets[moved[m] + 1]; ++e) add(graph.neighbours[e]);
    }
    std::sort(pairs.columns.begin() + static_cast<std::ptrdiff_t>(begin), pairs.columns.end());
    pairs.offsets.push_back(pairs.columns.size());
  }
  return pairs;
}

// Sums Psi_v^T r_v over the vertices v of component `c`, which is affine; fill_row(v, row) sets the row r_v. Calls
// emit(row, column, value) for each value of the sum: rows are functions, columns those of r.
template <int kWidth, class FillRow, class Emit>
void Blend::SumOverVertices(std::size_t c, FillRow&& fill_row, Emit&& emit) const {
  using Block = Eigen::Matrix<double, 4, kWidth>;
  const Component& run = handles_.components[c];
  const Pairs& pairs = pairs_[c];
  const auto find = [&](std::size_t i, std::uint32_t j) {
    const auto begin = pairs.columns.begin();
    return static_cast<std::size_t>(std::lower_bound(begin + static_cast<std::ptrdiff_t>(pairs.offsets[i]),
                                                     begin + static_cast<std::ptrdiff_t>(pairs.offsets[i + 1]), j) -
                                    begin);
  };
  std::vector<Block> sums(pairs.columns.size(), Block::Zero());
  Row<kWidth> row(run);
  for (std::uint32_t v = components_[c].first; v < components_[c].first + components_[c].count; ++v) {
    row.Clear();
    fill_row(v, row);
    const std::span<const std::uint32_t> followed = handles_.FollowedBy(v);
    for (std::size_t i = 0; i < followed.size(); ++i) {
      const Functions f = At(v, followed[i], handles_.WeightsOf(v)[i]);
      for (std::size_t j = 0; j < row.handles().size(); ++j) {
        sums[find(followed[i] - run.first, row.handles()[j])] += f * row.values()[j];
      }
    }
  }
  for (std::size_t i = 0; i < run.count; ++i) {
    for (std::size_t p = pairs.offsets[i]; p < pairs.offsets[i + 1]; ++p) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < kWidth; ++b) emit(Index(4 * i) + a, Index(kWidth * pairs.columns[p]) + b, sums[p](a, b));
      }
    }
  }
}

Eigen::SparseMatrix<double> Blend::Congruence(std::size_t c, const EdgeGraph& graph, const VertexMatrix& m) const {
  const Component& vertices = components_[c];
  const bool has_edges = !m.off_diagonal.empty();
  Triplets entries;
  const auto emit = [&](int row, int column, double value) {
    if (row >= column) entries.emplace_back(row, column, value);
  };
  if (IsAffine(c)) {
    const auto fill_row = [&](std::uint32_t v, Row<4>& row) {
      const auto add = [&](std::uint32_t u, double value) {
        const std::span<const std::uint32_t> followed = handles_.FollowedBy(u);
        for (std::size_t i = 0; i < followed.size(); ++i) {
          row[followed[i]] += value * At(u, followed[i], handles_.WeightsOf(u)[i]).transpose();
        }
      };
      add(v, m.diagonal[v]);
      if (!has_edges) return;
      for (std::uint32_t e = graph.offsets[v]; e < graph.offsets[v + 1]; ++e) {
        add(graph.neighbours[e], m.off_diagonal[graph.edges[e]]);
      }
    };
    SumOverVertices<4>(c, fill_row, emit);
  } else {
    for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
      emit(Index(v - vertices.first), Index(v - vertices.first), m.diagonal[v]);
      if (!has_edges) continue;
      for (std::uint32_t e = graph.offsets[v]; e < graph.offsets[v + 1]; ++e) {
        emit(Index(v - vertices.first), Index(graph.neighbours[e] - vertices.first), m.off_diagonal[graph.edges[e]]);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(functions_[c].count, functions_[c].count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void Blend::AddPull(std::size_t c, const EdgeGraph& graph, std::span<const double> weights,
                    const PositionMatrix& reference, std::vector<Eigen::Triplet<double>>& entries) const {
  const Component &run = handles_.components[c], &vertices = components_[c];
  // What the gradients of the handles that `v` and its neighbours follow pull at `v`.
  const auto fill_row = [&](std::uint32_t v, Row<3>& row) {
    const auto add = [&](std::uint32_t u, const Eigen::RowVector3d& edges) {
      const std::span<const std::uint32_t> followed = handles_.FollowedBy(u);
      for (std::size_t i = 0; i < followed.size(); ++i) row[followed[i]] += handles_.WeightsOf(u)[i] * edges;
    };
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::uint32_t e = graph.offsets[v]; e < graph.offsets[v + 1]; ++e) {
      const std::uint32_t u = graph.neighbours[e];
      const Eigen::RowVector3d edge = weights[graph.edges[e]] / 2 * (reference.row(v) - reference.row(u));
      add(u, edge);
      sum += edge;
    }
    add(v, sum);
  };
  const auto emit = [&](int row, int column, double value) {
    entries.emplace_back(Index(functions_[c].first) + row, Index(3 * std::size_t{run.first}) + column, value);
  };
  if (IsAffine(c)) {
    SumOverVertices<3>(c, fill_row, emit);
    return;
  }
  Row<3> row(run);
  for (std::uint32_t v = 0; v < vertices.count; ++v) {
    row.Clear();
    fill_row(vertices.first + v, row);
    for (std::size_t j = 0; j < row.handles().size(); ++j) {
      for (int b = 0; b < 3; ++b) emit(Index(v), Index(3 * std::size_t{row.handles()[j]}) + b, row.values()[j][b]);
    }
  }
}

}  // namespace sac
