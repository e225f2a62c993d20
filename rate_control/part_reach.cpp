// SPDX-License-Identifier: Apache-2.0
#include "rate_control/part_reach.h"

#include <algorithm>

#include "codec/encode/joined_mesh.h"
#include "codec/encode/part_scales.h"
#include "geometry/rigid_fit.h"

namespace sac {
namespace {

PositionMatrix Matrix(std::span<const Vec3f> positions) {
  PositionMatrix matrix(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3f& p = positions[v];
    matrix.row(static_cast<Eigen::Index>(v)) << static_cast<double>(p[0]), static_cast<double>(p[1]),
        static_cast<double>(p[2]);
  }
  return matrix;
}

}  // namespace

PartReach::PartReach(const Mesh& mesh, std::span<const std::uint32_t> lowest) {
  const JoinedMesh joined = JoinVertices(mesh, lowest);
  const MeshParts parts = FindParts(joined.mesh, RmsRadius(joined.mesh.positions), 1, {});
  for (std::uint32_t v = 0; v < mesh.positions.size() && !parts.scales.empty(); ++v) {
    if (parts.scales[parts.of_vertex[joined.vertex_of_author[v]]].exponent > 0) small_.push_back(v);
  }
  if (small_.empty()) return;
  reach_.resize(mesh.positions.size());
  mesh_ = Matrix(mesh.positions);
  centre_ = VertexMasses(mesh_, mesh.triangles).transpose() * mesh_;
}

void PartReach::Add(std::span<const Vec3f> positions) {
  const PositionMatrix frame = Matrix(positions);
  const RigidFit fit = FitRigid(mesh_, frame, centre_);
  for (const std::uint32_t v : small_) {
    const Eigen::RowVector3d back =
        (frame.row(v) - centre_ - fit.translation.transpose()) * fit.rotation + centre_ - mesh_.row(v);
    reach_[v] = std::max(reach_[v], static_cast<float>(back.norm()));
  }
}

}  // namespace sac
