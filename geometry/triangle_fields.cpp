// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangle_fields.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace sac {
namespace {

constexpr double kDegenerate = 1e-6;  // double area over longest squared edge

// Two edges and the unit normal as columns; false for a degenerate triangle, whose normal is left zero.
bool Frame(const PositionMatrix& p, const Triangle& t, Eigen::Matrix3d& frame, double& double_area) {
  const Eigen::Vector3d a = p.row(t[1]) - p.row(t[0]), b = p.row(t[2]) - p.row(t[0]);
  const Eigen::Vector3d normal = a.cross(b);
  double_area = normal.norm();
  const bool good = double_area > kDegenerate * std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
  frame << a, b, good ? Eigen::Vector3d(normal / double_area) : Eigen::Vector3d::Zero();
  return good;
}

}  // namespace

Eigen::Matrix3d PolarRotation(const Eigen::Matrix3d& j) {
  const double scale = j.norm();
  if (j.determinant() > 1e-6 * scale * scale * scale) {
    // Higham's Newton iteration, quadratic where J is far from singular.
    Eigen::Matrix3d r = j;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Matrix3d inverse = r.inverse().transpose();
      const double balance = std::sqrt(inverse.norm() / r.norm());
      const Eigen::Matrix3d next = (balance * r + inverse / balance) / 2;
      const double change = (next - r).squaredNorm();
      r = next;
      if (change < 1e-20) break;
    }
    return r;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(j, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

Eigen::Vector3d UnwrappedLog(const Eigen::Matrix3d& r, const Eigen::Vector3d& previous) {
  const Eigen::AngleAxisd rotation(r);
  return NearestTurn(rotation.axis(), rotation.angle(), previous);
}

TriangleFields::TriangleFields(std::span<const Triangle> triangles)
    : triangles_(triangles),
      fields_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(triangles.size()), 9)),
      areas_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(triangles.size()))) {}

const Eigen::MatrixXd& TriangleFields::Measure(const PositionMatrix& reference, const PositionMatrix& deformed) {
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Eigen::Matrix3d from, to;
    double from_area = 0, to_area = 0;
    if (!Frame(reference, triangles_[i], from, from_area)) {
      areas_[row] = 0;
      continue;
    }
    areas_[row] = from_area / 2;
    Frame(deformed, triangles_[i], to, to_area);
    const Eigen::Matrix3d j = to * from.inverse();
    const Eigen::Matrix3d r = PolarRotation(j);
    const Eigen::Matrix3d p = r.transpose() * j;
    const Eigen::Vector3d u = UnwrappedLog(r, fields_.row(row).head<3>());
    fields_.row(row) << u[0], u[1], u[2], p(0, 0) - 1, p(1, 1) - 1, p(2, 2) - 1, (p(0, 1) + p(1, 0)) / 2,
        (p(0, 2) + p(2, 0)) / 2, (p(1, 2) + p(2, 1)) / 2;
  }
  if (std::exchange(restarted_, false)) UnwrapOverSurface();
  return fields_;
}

void TriangleFields::Restart() {
  restarted_ = true;
  fields_.setZero();
}

void TriangleFields::UnwrapOverSurface() {
  // Below this angle no two neighbours of a surface lie on different branches, but for triangles that are turned
  // against each other by a quarter or more, of which nothing can be said.
  constexpr double kSafe = 0.75 * std::numbers::pi;
  if (fields_.rows() == 0 || fields_.leftCols<3>().rowwise().norm().maxCoeff() < kSafe) return;
  if (!surface_) surface_ = std::make_unique<SurfaceUnwrapping>(triangles_);
  std::vector<std::uint8_t> left_out(triangles_.size());
  for (std::size_t j = 0; j < left_out.size(); ++j) left_out[j] = areas_[static_cast<Eigen::Index>(j)] == 0 ? 1 : 0;
  surface_->Unwrap(left_out, fields_.leftCols<3>());
}

}  // namespace sac
