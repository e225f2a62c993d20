// SPDX-License-Identifier: Apache-2.0
#include "decomposition/rest_alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/triangle_fields.h"

namespace sac {

PositionMatrix MatrixOf(const Positions& positions) {
  PositionMatrix matrix(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)) = static_cast<double>(positions[v][a]);
    }
  }
  return matrix;
}

Positions PositionsOf(const PositionMatrix& matrix) {
  Positions positions(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      positions[v][a] = static_cast<float>(matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)));
    }
  }
  return positions;
}

RestAlignment::RestAlignment(const PositionMatrix& rest, std::span<const Triangle> triangles) : rest_(rest) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d a = rest.row(t[1]) - rest.row(t[0]), b = rest.row(t[2]) - rest.row(t[0]);
    area += a.cross(b).norm() / 2;
  }
  if (area > 0) {
    mass_ = VertexMasses(rest, triangles);
    extent_ = std::sqrt(area);
  } else {
    mass_ = Eigen::VectorXd::Constant(rest.rows(), 1 / static_cast<double>(rest.rows()));
    extent_ = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  }
  if (!(extent_ > 0)) extent_ = 1;
}

PositionMatrix RestAlignment::AlignOnto(const PositionMatrix& shape, const PositionMatrix& frame,
                                        RigidPose& pose) const {
  const Eigen::RowVector3d centre = mass_.transpose() * frame, shape_centre = mass_.transpose() * shape;
  const PositionMatrix about = frame.rowwise() - centre;
  const Eigen::Matrix3d covariance = about.transpose() * mass_.asDiagonal() * (shape.rowwise() - shape_centre);
  const Eigen::Matrix3d r = covariance.norm() > 0 ? PolarRotation(covariance) : Eigen::Matrix3d::Identity();
  const Eigen::RowVector3d move = centre - shape_centre * r.transpose();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.rotation[static_cast<std::size_t>(3 * i + j)] = r(i, j);
    pose.translation[static_cast<std::size_t>(i)] = move[i];
  }
  return (about * r).rowwise() + shape_centre;
}

PositionMatrix Moved(const PositionMatrix& positions, const RigidPose& pose) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(pose.rotation.data());
  const Eigen::Map<const Eigen::RowVector3d> t(pose.translation.data());
  return (positions * r.transpose()).rowwise() + t;
}

std::string AtClip(const ClipReader& clip, const std::string& message) {
  return clip.name().empty() ? message : clip.name() + ": " + message;
}

Status ForEachFrame(ClipReader& clip, std::size_t vertices,
                    const std::function<Status(std::uint32_t frame, const PositionMatrix& positions)>& take) {
  SAC_RETURN_IF_ERROR(clip.Rewind());
  Positions frame;
  bool end = false;
  for (std::uint32_t f = 0;; ++f) {
    SAC_RETURN_IF_ERROR(clip.Next(frame, end));
    if (end) return Status::Ok();
    const auto fails = [&](const std::string& what) {
      const std::string name = clip.name_of(f);
      return Status::InvalidArgument((name.empty() ? "" : name + ": ") + "frame " + std::to_string(f) + ": " + what);
    };
    if (frame.size() != vertices) {
      return fails(std::to_string(frame.size()) + " vertices, not " + std::to_string(vertices));
    }
    const PositionMatrix positions = MatrixOf(frame);
    if (!positions.allFinite()) return fails("a coordinate is not finite");
    SAC_RETURN_IF_ERROR(take(f, positions));
  }
}

}  // namespace sac
