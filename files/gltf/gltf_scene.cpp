// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_scene.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "files/gltf/gltf_accessor.h"

namespace sac {
namespace {

// Numbers of morph targets that are kept for the next frames.
constexpr std::size_t kKeptNumbers = std::size_t{1} << 25;

Eigen::Matrix4d MatrixOf(const NodePose& pose) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.translate(Eigen::Vector3d(pose.translation[0], pose.translation[1], pose.translation[2]));
  Eigen::Quaterniond rotation(pose.rotation[3], pose.rotation[0], pose.rotation[1], pose.rotation[2]);
  if (rotation.squaredNorm() > 0) rotation.normalize();
  transform.rotate(rotation);
  transform.scale(Eigen::Vector3d(pose.scale[0], pose.scale[1], pose.scale[2]));
  return transform.matrix();
}

Eigen::Matrix4d MatrixFrom(const std::vector<double>& columns) {
  return Eigen::Map<const Eigen::Matrix4d>(columns.data());
}

}  // namespace

GltfScene::GltfScene(GltfDocument& document, std::optional<std::size_t> scene, Losses& losses) : document_(document) {
  const JsonValue nodes = document.root()["nodes"];
  if (nodes.size() > document.limits().nodes) ThrowLimit(std::to_string(nodes.size()) + " nodes");
  nodes_.resize(nodes.size());
  weights_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) ReadNode(i);
  std::vector<bool> visited(nodes_.size());
  if (scene) {
    const JsonValue roots = document.root()["scenes"][*scene]["nodes"];
    for (std::size_t i = 0; i < roots.size(); ++i) AddTree(roots[i].Index(nodes_.size()), visited, losses);
  } else {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!nodes_[i].parent) AddTree(i, visited, losses);
    }
  }
  // Joints may stand outside the scene; they still move.
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!visited[i] && !nodes_[i].parent) {
      std::vector<std::size_t> stack = {i};
      while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        if (visited[node]) continue;
        visited[node] = true;
        order_.push_back(node);
        const JsonValue children = nodes[node]["children"];
        for (std::size_t k = 0; k < children.size(); ++k) stack.push_back(children[k].Index(nodes_.size()));
      }
    }
  }
  for (const Instance& instance : instances_) CheckJoints(instance);
}

void GltfScene::ReadNode(std::size_t index) {
  const JsonValue json = document_.root()["nodes"][index];
  Node& node = nodes_[index];
  if (json["matrix"]) node.matrix = MatrixFrom(json["matrix"].Numbers(16));
  if (json["translation"]) node.pose.translation = json["translation"].Numbers(3);
  if (json["rotation"]) node.pose.rotation = json["rotation"].Numbers(4);
  if (json["scale"]) node.pose.scale = json["scale"].Numbers(3);
  const JsonValue children = json["children"];
  for (std::size_t i = 0; i < children.size(); ++i) {
    Node& child = nodes_[children[i].Index(nodes_.size())];
    if (child.parent) ThrowCorrupt(children[i].place() + ": has another parent as well");
    child.parent = index;
  }
  if (const auto mesh = json["mesh"].OptionalIndex(document_.root()["meshes"].size())) {
    const JsonValue primitives = document_.root()["meshes"][*mesh]["primitives"];
    if (primitives.size() > 0) weights_[index] = primitives[std::size_t{0}]["targets"].size();
  }
  if (json["weights"]) node.pose.weights = json["weights"].Numbers(weights_[index]);
}

void GltfScene::AddTree(std::size_t root, std::vector<bool>& visited, Losses& losses) {
  const JsonValue nodes = document_.root()["nodes"];
  if (nodes_[root].parent) ThrowCorrupt("nodes[" + std::to_string(root) + "]: a root of the scene has a parent");
  std::vector<std::size_t> stack = {root};
  while (!stack.empty()) {
    const std::size_t index = stack.back();
    stack.pop_back();
    // A node has one parent and the root none: no node is met twice but a root that is named twice.
    if (visited[index]) continue;
    visited[index] = true;
    order_.push_back(index);
    const JsonValue node = nodes[index];
    if (node["mesh"]) AddInstance(index, losses);
    if (node["camera"]) losses.Count("cameras");
    if (node["extensions"]["KHR_lights_punctual"]) losses.Count("lights");
    const JsonValue children = node["children"];
    for (std::size_t i = children.size(); i-- > 0;) stack.push_back(children[i].Index(nodes_.size()));
  }
}

void GltfScene::AddInstance(std::size_t node, Losses& losses) {
  const JsonValue json = document_.root()["nodes"][node];
  Instance instance;
  instance.node = node;
  instance.mesh = json["mesh"].Index(document_.root()["meshes"].size());
  instance.skin = json["skin"].OptionalIndex(document_.root()["skins"].size());
  if (!meshes_.contains(instance.mesh)) {
    meshes_.emplace(instance.mesh, ReadGltfMesh(document_, instance.mesh, losses));
  }
  if (instance.skin && !skins_.contains(*instance.skin)) ReadSkin(*instance.skin);
  const GltfMesh& mesh = meshes_.at(instance.mesh);
  for (const GltfPrimitive& primitive : mesh.primitives) vertices_ += primitive.vertices;
  if (vertices_ > document_.limits().vertices) ThrowLimit("more than " + std::to_string(vertices_) + " vertices");
  if (nodes_[node].pose.weights.empty()) nodes_[node].pose.weights = mesh.weights;
  instances_.push_back(instance);
}

void GltfScene::ReadSkin(std::size_t index) {
  const JsonValue json = document_.root()["skins"][index], joints = json["joints"];
  Skin skin;
  for (std::size_t i = 0; i < joints.size(); ++i) skin.joints.push_back(joints[i].Index(nodes_.size()));
  skin.inverse_binds.resize(skin.joints.size(), Eigen::Matrix4d::Identity());
  if (const auto accessor = json["inverseBindMatrices"].OptionalIndex(document_.root()["accessors"].size())) {
    const std::vector<float> numbers = ReadNumbers(document_, *accessor, 16);
    if (numbers.size() < 16 * skin.joints.size()) {
      ThrowCorrupt(json.place() + ".inverseBindMatrices: fewer than joints");
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      skin.inverse_binds[i] = Eigen::Map<const Eigen::Matrix4f>(numbers.data() + 16 * i).cast<double>();
    }
  }
  skins_.emplace(index, std::move(skin));
}

void GltfScene::CheckJoints(const Instance& instance) const {
  if (!instance.skin) return;
  const std::size_t joints = skins_.at(*instance.skin).joints.size();
  for (const GltfPrimitive& primitive : meshes_.at(instance.mesh).primitives) {
    for (const std::uint32_t joint : primitive.joints) {
      if (joint >= joints) {
        ThrowCorrupt("skins[" + std::to_string(*instance.skin) + "]: joint " + std::to_string(joint) +
                     " of a vertex, but there are " + std::to_string(joints));
      }
    }
  }
}

std::string GltfScene::name(const Instance& instance) const {
  const std::string node = document_.root()["nodes"][instance.node]["name"].String();
  if (!node.empty()) return node;
  const std::string& mesh = meshes_.at(instance.mesh).name;
  return mesh.empty() ? std::to_string(instance.node) : mesh;
}

void GltfScene::Pose(const GltfAnimation* animation, double time) {
  poses_.clear();
  for (const Node& node : nodes_) poses_.push_back(node.pose);
  if (animation != nullptr) animation->Apply(time, poses_);
  globals_.assign(nodes_.size(), Eigen::Matrix4d::Identity());
  for (const std::size_t i : order_) {
    globals_[i] = nodes_[i].matrix ? *nodes_[i].matrix : MatrixOf(poses_[i]);
    if (nodes_[i].parent) globals_[i] = globals_[*nodes_[i].parent] * globals_[i];
  }
}

bool GltfScene::IsMirrored(const Instance& instance) const {
  return !instance.skin && globals_[instance.node].topLeftCorner<3, 3>().determinant() < 0;
}

const std::vector<float>& GltfScene::Difference(std::size_t accessor) {
  const auto found = differences_.find(accessor);
  if (found != differences_.end()) return found->second;
  std::vector<float> numbers = ReadNumbers(document_, accessor, 3);
  if (kept_ + numbers.size() > kKeptNumbers) {
    differences_.clear();
    kept_ = 0;
  }
  kept_ += numbers.size();
  return differences_.emplace(accessor, std::move(numbers)).first->second;
}

void GltfScene::Morph(const GltfPrimitive& primitive, const std::vector<double>& weights, std::vector<Vec3d>& positions,
                      std::vector<Vec3d>& normals) {
  const auto take = [&primitive](const std::vector<float>& from, std::vector<Vec3d>& to) {
    to.assign(primitive.vertices, {});
    for (std::size_t i = 0; i < from.size(); ++i) to[i / 3][i % 3] = static_cast<double>(from[i]);
  };
  take(primitive.positions, positions);
  take(primitive.normals, normals);
  for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    const auto add = [&](const std::optional<std::size_t>& accessor, std::vector<Vec3d>& to) {
      if (!accessor) return;
      const std::vector<float>& difference = Difference(*accessor);
      for (std::size_t i = 0; i < difference.size(); ++i) {
        to[i / 3][i % 3] += weights[t] * static_cast<double>(difference[i]);
      }
    };
    add(primitive.targets[t].positions, positions);
    if (!primitive.normals.empty()) add(primitive.targets[t].normals, normals);
  }
}

void GltfScene::Evaluate(std::vector<Vec3d>& positions, std::vector<Vec3d>* normals) {
  positions.clear();
  positions.reserve(vertices_);
  if (normals != nullptr) normals->clear();
  std::vector<Vec3d> points, directions;
  for (const Instance& instance : instances_) {
    std::vector<Eigen::Matrix4d> joints;
    if (instance.skin) {
      const Skin& skin = skins_.at(*instance.skin);
      for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        joints.push_back(globals_[skin.joints[j]] * skin.inverse_binds[j]);
      }
    }
    for (const GltfPrimitive& primitive : meshes_.at(instance.mesh).primitives) {
      Morph(primitive, poses_[instance.node].weights, points, directions);
      for (std::size_t v = 0; v < primitive.vertices; ++v) {
        Eigen::Matrix4d matrix = globals_[instance.node];
        if (instance.skin && primitive.influences > 0) {
          matrix.setZero();
          for (std::size_t i = v * primitive.influences; i < (v + 1) * primitive.influences; ++i) {
            if (primitive.weights[i] == 0) continue;
            matrix += static_cast<double>(primitive.weights[i]) * joints[primitive.joints[i]];
          }
        }
        const Eigen::Vector3d p = Eigen::Vector3d(points[v].data());
        const Eigen::Vector3d moved = matrix.topLeftCorner<3, 3>() * p + matrix.topRightCorner<3, 1>();
        positions.push_back({moved[0], moved[1], moved[2]});
        if (normals == nullptr) continue;
        // Cofactors are the inverse transpose but for a factor, and exist for any matrix.
        const Eigen::Matrix3d a = matrix.topLeftCorner<3, 3>();
        Eigen::Matrix3d cofactors;
        cofactors << a.col(1).cross(a.col(2)), a.col(2).cross(a.col(0)), a.col(0).cross(a.col(1));
        const Eigen::Vector3d n = (cofactors * Eigen::Vector3d(directions[v].data())).normalized();
        normals->push_back(n.allFinite() ? Vec3d{n[0], n[1], n[2]} : Vec3d{});
      }
    }
  }
}

}  // namespace sac
