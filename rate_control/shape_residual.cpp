// SPDX-License-Identifier: Apache-2.0
#include "rate_control/shape_residual.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/components.h"
#include "geometry/triangle_fields.h"

namespace sac {
namespace {

Eigen::Vector3d Point(const Vec3f& p) { return Eigen::Vector3f(p.data()).cast<double>(); }

// Sets `frame` to two edges and the unit normal of a triangle as columns. Returns its area, 0 for a triangle that is
// degenerate.
double Frame(const Positions& p, const Triangle& t, Eigen::Matrix3d& frame) {
  constexpr double kDegenerate = 1e-6;  // double area over the longest squared edge
  const Eigen::Vector3d a = Point(p[t[1]]) - Point(p[t[0]]), b = Point(p[t[2]]) - Point(p[t[0]]);
  const Eigen::Vector3d normal = a.cross(b);
  const double double_area = normal.norm();
  if (!(double_area > kDegenerate * std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()}))) return 0;
  frame << a, b, normal / double_area;
  return double_area / 2;
}

}  // namespace

ShapeResidual::ShapeResidual(std::vector<Triangle> triangles, std::size_t vertices, std::uint32_t stride)
    : triangles_(std::move(triangles)), stride_(stride), at_vertex_(vertices) {
  std::uint32_t components = 0;
  component_of_ = LabelComponents(static_cast<std::uint32_t>(vertices), triangles_, components);
  in_component_.resize(components + 1);
}

void ShapeResidual::Begin(Positions shape) {
  shape_ = std::move(shape);
  sums_.assign(shape_.size(), Eigen::Vector3d::Zero());
  given_ = frames_ = 0;
}

void ShapeResidual::SumGradients(const Positions& decoded) {
  std::fill(at_vertex_.begin(), at_vertex_.end(), Eigen::Matrix3d::Zero());
  std::fill(in_component_.begin(), in_component_.end(), Eigen::Matrix3d::Zero());
  Eigen::Matrix3d from, to;
  for (const Triangle& t : triangles_) {
    const double area = Frame(shape_, t, from);
    if (area == 0 || Frame(decoded, t, to) == 0) continue;
    const Eigen::Matrix3d gradient = area * to * from.inverse();
    for (const std::uint32_t v : t) at_vertex_[v] += gradient;
    in_component_[component_of_[t[0]]] += gradient;
  }
  in_component_.back() =
      std::accumulate(in_component_.begin(), in_component_.end() - 1, Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  // From here on they are rotations, where there is area.
  for (Eigen::Matrix3d& sum : in_component_) {
    if (!sum.isZero(0)) sum = PolarRotation(sum);
  }
}

void ShapeResidual::Add(const Positions& original, const Positions& decoded) {
  if (given_++ % stride_ != 0) return;
  SumGradients(decoded);
  for (std::size_t v = 0; v < sums_.size(); ++v) {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (!at_vertex_[v].isZero(0)) {
      rotation = PolarRotation(at_vertex_[v]);
    } else if (const Eigen::Matrix3d& of_component = in_component_[component_of_[v]]; !of_component.isZero(0)) {
      rotation = of_component;
    } else if (!in_component_.back().isZero(0)) {
      rotation = in_component_.back();
    }
    sums_[v] += rotation.transpose() * (Point(original[v]) - Point(decoded[v]));
  }
  ++frames_;
}

Positions ShapeResidual::Corrected(double gain, const Positions& first) const {
  std::vector<Eigen::Vector3d> corrected(shape_.size());
  for (std::size_t v = 0; v < shape_.size(); ++v) corrected[v] = Point(shape_[v]) + gain / frames_ * sums_[v];
  std::vector<std::uint32_t> order(first.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return first[a] != first[b] ? first[a] < first[b] : a < b; });
  Positions positions(shape_.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (; end < order.size() && first[order[end]] == first[order[begin]]; ++end) sum += corrected[order[end]];
    const Eigen::Vector3f mean = (sum / static_cast<double>(end - begin)).cast<float>();
    for (std::size_t i = begin; i < end; ++i) positions[order[i]] = {mean[0], mean[1], mean[2]};
  }
  return positions;
}

}  // namespace sac
