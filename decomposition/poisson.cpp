// SPDX-License-Identifier: Apache-2.0
#include "decomposition/poisson.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "geometry/components.h"
#include "geometry/deformation.h"

namespace sac {
namespace {

constexpr double kDegenerate = 1e-6;  // double area over longest squared edge, as in geometry/triangle_fields.cpp
constexpr double kPin = 1e-9;         // of the mean diagonal: makes the system regular, centroids are placed after it
constexpr double kHold = 1e8;         // of the mean diagonal: holds vertices that must be still

}  // namespace

void PoissonReconstruction::PrepareTriangles() {
  areas_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(triangles_.size()));
  hats_.assign(triangles_.size(), Eigen::Matrix3d::Zero());
  mass_ = Eigen::VectorXd::Zero(rest_.rows());
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Triangle& t = triangles_[j];
    const Eigen::Vector3d a = rest_.row(t[1]) - rest_.row(t[0]), b = rest_.row(t[2]) - rest_.row(t[0]);
    const Eigen::Vector3d normal = a.cross(b);
    const double twice = normal.norm();
    if (!(twice > kDegenerate * std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()}))) continue;
    Eigen::Matrix3d frame;
    frame << a, b, normal / twice;
    const Eigen::Matrix3d inverse = frame.inverse();  // its first rows are the gradients at corners 1 and 2
    hats_[j].col(1) = inverse.row(0).transpose();
    hats_[j].col(2) = inverse.row(1).transpose();
    hats_[j].col(0) = -hats_[j].col(1) - hats_[j].col(2);
    areas_[static_cast<Eigen::Index>(j)] = twice / 2;
    for (const std::uint32_t v : t) mass_[v] += twice / 6;
  }
}

void PoissonReconstruction::LabelPieces(std::span<const std::uint32_t> still) {
  std::vector<Triangle> good;
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    if (areas_[static_cast<Eigen::Index>(j)] > 0) good.push_back(triangles_[j]);
  }
  piece_ = LabelComponents(static_cast<std::uint32_t>(rest_.rows()), good, pieces_);
  still_.assign(piece_.size(), 0);
  held_.assign(pieces_, 0);
  piece_mass_ = Eigen::VectorXd::Zero(pieces_);
  for (std::size_t v = 0; v < piece_.size(); ++v) piece_mass_[piece_[v]] += mass_[static_cast<Eigen::Index>(v)];
  loose_ = 0;
  const auto hold = [this](std::size_t v) {
    still_[v] = 1;
    held_[piece_[v]] = 1;
  };
  for (const std::uint32_t v : still) hold(v);
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    if (mass_[static_cast<Eigen::Index>(v)] > 0) continue;
    ++loose_;
    hold(v);
  }
}

SparseCholesky::Matrix PoissonReconstruction::System() const {
  std::vector<Eigen::Triplet<double>> entries;
  double trace = 0;
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const double area = areas_[static_cast<Eigen::Index>(j)];
    if (area == 0) continue;
    const Triangle& t = triangles_[j];
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const auto row = static_cast<int>(t[static_cast<std::size_t>(a)]);
        const auto column = static_cast<int>(t[static_cast<std::size_t>(b)]);
        if (row < column) continue;
        const double value = area * hats_[j].col(a).dot(hats_[j].col(b));
        entries.emplace_back(row, column, value);
        if (a == b) trace += value;
      }
    }
  }
  const double mean = trace / static_cast<double>(rest_.rows());
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    const auto i = static_cast<int>(v);
    entries.emplace_back(i, i, mean * (still_[v] != 0 ? kHold : kPin));
  }
  SparseCholesky::Matrix matrix(rest_.rows(), rest_.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Status PoissonReconstruction::Prepare(const PositionMatrix& rest, std::span<const Triangle> triangles,
                                      std::span<const std::uint32_t> still) {
  rest_ = rest;
  triangles_.assign(triangles.begin(), triangles.end());
  PrepareTriangles();
  if (!(areas_.sum() > 0)) return Status::InvalidArgument("no triangle of the rest shape has an area");
  LabelPieces(still);
  const SparseCholesky::Matrix matrix = System();
  if (!factor_.Analyze(matrix)) return Status::Limit("the triangles are no surface: their Poisson system is too large");
  if (!factor_.Factorize(matrix)) return Status::InvalidArgument("the Poisson system of the rest shape is singular");
  return Status::Ok();
}

void PoissonReconstruction::AddGradient(std::size_t triangle, const Eigen::Matrix3d& j, RowMatrix& b,
                                        Eigen::Index first) const {
  const double area = areas_[static_cast<Eigen::Index>(triangle)];
  if (area == 0) return;
  const Eigen::Matrix3d sides = area * j * hats_[triangle];
  const Triangle& t = triangles_[triangle];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    b.block<1, 3>(t[k], first) += sides.col(column).transpose();
  }
}

// Moves each piece that nothing holds to have its centroid at 0; what is still is put there.
void PoissonReconstruction::Place(RowMatrix& offsets) const {
  RowMatrix sum = RowMatrix::Zero(pieces_, offsets.cols());
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    sum.row(piece_[v]) += mass_[row] * offsets.row(row);
  }
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    if (still_[v] != 0) {
      offsets.row(row).setZero();
    } else if (held_[piece_[v]] == 0) {
      offsets.row(row) -= sum.row(piece_[v]) / piece_mass_[piece_[v]];
    }
  }
}

void PoissonReconstruction::SolveOffsets(RowMatrix& b) const {
  for (std::size_t v = 0; v < still_.size(); ++v) {
    if (still_[v] != 0) b.row(static_cast<Eigen::Index>(v)).setZero();
  }
  factor_.SolveInPlace(b);
  Place(b);
}

// First the transpose of placing the centroids, then the factor, which is symmetric.
void PoissonReconstruction::SolveTransposed(RowMatrix& y) const {
  RowMatrix sum = RowMatrix::Zero(pieces_, y.cols());
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    if (still_[v] != 0) y.row(row).setZero();
    sum.row(piece_[v]) += y.row(row);
  }
  for (std::size_t v = 0; v < piece_.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    if (held_[piece_[v]] == 0) y.row(row) -= mass_[row] / piece_mass_[piece_[v]] * sum.row(piece_[v]);
  }
  factor_.SolveInPlace(y);
  for (std::size_t v = 0; v < still_.size(); ++v) {
    if (still_[v] != 0) y.row(static_cast<Eigen::Index>(v)).setZero();
  }
}

RowMatrix PoissonReconstruction::SolutionRows(std::span<const std::uint32_t> vertices) const {
  RowMatrix rows = RowMatrix::Zero(rest_.rows(), static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) rows(vertices[i], static_cast<Eigen::Index>(i)) = 1;
  SolveTransposed(rows);
  return rows;
}

// Solved for the offset from the rest shape, whose gradient is the identity; this keeps the accuracy of still vertices.
PositionMatrix PoissonReconstruction::ReconstructOffsets(RowMatrix& b) const {
  SolveOffsets(b);
  return rest_ + b;
}

PositionMatrix PoissonReconstruction::Reconstruct(const Eigen::MatrixXd& q) const {
  RowMatrix b = RowMatrix::Zero(rest_.rows(), 3);
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    double channels[9];
    for (int a = 0; a < 9; ++a) channels[a] = q(static_cast<Eigen::Index>(j), a);
    AddGradient(j, DeformationGradient(channels) - Eigen::Matrix3d::Identity(), b, 0);
  }
  return ReconstructOffsets(b);
}

}  // namespace sac
