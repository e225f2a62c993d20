// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/component_gltf.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "files/gltf/gltf_builder.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

using Json = nlohmann::json;

constexpr double kShortMax = 32767;

// Positions in the mesh's own space, where all coordinates and displacements are within -32767 to 32767: model units
// are centre + scale * x. Displacements are integers there, and not normalized ones, which three.js (r160) reads
// wrongly from sparse accessors.
struct MeshSpace {
  Eigen::Vector3d centre;
  double scale;
};

MeshSpace SpaceOf(const SparseComponents& c) {
  const Box box = BoundingBox(c.rest);
  MeshSpace space{{}, 0};
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    space.centre[a] = (box.low[i] + box.high[i]) / 2;
    space.scale = std::max(space.scale, box.size()[i] / 2);
  }
  for (const SparseComponent& component : c.components) {
    for (const float x : component.values) space.scale = std::max(space.scale, std::abs(static_cast<double>(x)));
  }
  space.scale = space.scale > 0 ? space.scale / kShortMax : 1;
  return space;
}

// Adds a component as an accessor of all vertices; returns its number, and adds the error of each to `errors`.
std::size_t AddTarget(const SparseComponent& component, double scale, GltfBuilder& builder,
                      std::vector<double>& errors) {
  std::vector<std::array<std::int32_t, 3>> values(errors.size());
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double exact = static_cast<double>(component.values[3 * i + a]) / scale;
      const double q = std::clamp(std::nearbyint(exact), -kShortMax, kShortMax);
      values[component.nodes[i]][a] = static_cast<std::int32_t>(q);
      square += (q - exact) * (q - exact);
    }
    errors[component.nodes[i]] += std::sqrt(square) * scale;
  }
  return builder.AddSparse(IntegerValues(values, false, false), true);
}

void AddMesh(const SparseComponents& c, const MeshSpace& space, GltfBuilder& builder, double& error) {
  std::vector<float> positions;
  for (const Vec3f& p : c.rest) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = static_cast<double>(p[a]) - space.centre[static_cast<Eigen::Index>(a)];
      positions.push_back(static_cast<float>(x / space.scale));
    }
  }
  Json primitive = {{"attributes", {{"POSITION", builder.Add(FloatValues(positions, 3), true)}}}};
  if (c.triangles.empty()) {
    primitive["mode"] = 0;  // points
  } else {
    primitive["indices"] = builder.AddTriangles(c.triangles, c.rest.size());
  }
  std::vector<double> errors(c.rest.size(), 0);
  Json names = Json::array(), extras = Json::array();
  for (const SparseComponent& component : c.components) {
    primitive["targets"].push_back({{"POSITION", AddTarget(component, space.scale, builder, errors)}});
    names.push_back(component.name);
    extras.push_back({{"centre", component.centre}, {"vertices", component.nodes.size()}});
  }
  error = *std::max_element(errors.begin(), errors.end());
  builder.json()["meshes"] = Json::array({{{"primitives", Json::array({primitive})},
                                           {"weights", std::vector<float>(c.components.size(), 0)},
                                           {"extras", {{"targetNames", names}, {"components", extras}}}}});
}

void AddAnimation(const SparseComponents& c, double fps, GltfBuilder& builder) {
  std::vector<float> times, rotations, moves;
  Eigen::Quaterniond last(1, 0, 0, 0);
  for (std::size_t f = 0; f < c.frames(); ++f) {
    times.push_back(static_cast<float>(static_cast<double>(f) / fps));
    const RigidPose& pose = c.track[f];
    Eigen::Quaterniond q(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.rotation.data()));
    q.normalize();
    if (q.dot(last) < 0) q.coeffs() *= -1;  // players turn from one to the next the short way
    last = q;
    for (int i = 0; i < 4; ++i) rotations.push_back(static_cast<float>(q.coeffs()[i]));  // x, y, z, w
    for (const double x : pose.translation) moves.push_back(static_cast<float>(x));
  }
  const std::size_t input = builder.Add(FloatValues(times, 1), true);
  const auto sampler = [&](const std::vector<float>& values, std::size_t width) {
    return Json{{"input", input}, {"output", builder.Add(FloatValues(values, width))}, {"interpolation", "LINEAR"}};
  };
  const auto channel = [](int index, int node, const char* path) {
    return Json{{"sampler", index}, {"target", {{"node", node}, {"path", path}}}};
  };
  const Json samplers = Json::array({sampler(c.weights, 1), sampler(rotations, 4), sampler(moves, 3)});
  const Json channels =
      Json::array({channel(0, 1, "weights"), channel(1, 0, "rotation"), channel(2, 0, "translation")});
  builder.json()["animations"] =
      Json::array({{{"name", "performance"}, {"samplers", samplers}, {"channels", channels}}});
}

}  // namespace

Status FormatComponentGltf(const SparseComponents& c, double fps, std::string& bytes, double& error) {
  if (c.domain != ComponentDomain::kDisplacement) {
    return Status::Unsupported(
        "components of gradients are no morph targets: write them as .npz, or decompose displacements");
  }
  GltfBuilder builder(GltfCompression::kNone);
  const MeshSpace space = SpaceOf(c);
  builder.UseExtension("KHR_mesh_quantization");
  Json& json = builder.json();
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", {0}}}});
  const Json root = {{"name", "track"}, {"children", {1}}};
  const Json mesh = {{"name", "components"},
                     {"mesh", 0},
                     {"translation", {space.centre[0], space.centre[1], space.centre[2]}},
                     {"scale", {space.scale, space.scale, space.scale}}};
  json["nodes"] = Json::array({root, mesh});
  AddMesh(c, space, builder, error);
  if (c.frames() > 0) AddAnimation(c, fps, builder);
  return builder.Finish(true, bytes);
}

}  // namespace sac
