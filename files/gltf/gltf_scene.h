// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "files/faces.h"
#include "files/gltf/gltf_animation.h"
#include "files/gltf/gltf_document.h"
#include "files/gltf/gltf_mesh.h"

namespace sac {

// The nodes of a scene and the meshes on them, which become vertices at any time: morph targets first, then skins or
// the nodes' transforms (glTF 2.0, 3.5 and 3.7).
class GltfScene {
 public:
  // Reads the scene of that number, or, where there are none, all nodes. Throws GltfError.
  GltfScene(GltfDocument& document, std::optional<std::size_t> scene, Losses& losses);

  // A mesh on a node. Its vertices come one after the other, those of all instances in this order.
  struct Instance {
    std::size_t node = 0, mesh = 0;
    std::optional<std::size_t> skin;
  };
  const std::vector<Instance>& instances() const { return instances_; }
  const GltfMesh& mesh(const Instance& instance) const { return meshes_.at(instance.mesh); }
  // The name of its node, else of its mesh, else its number.
  std::string name(const Instance& instance) const;

  std::size_t vertices() const { return vertices_; }
  // How many weights each node has.
  const std::vector<std::size_t>& weights() const { return weights_; }

  // Poses all nodes as `animation`, if there is one, has them at `time`, in seconds.
  void Pose(const GltfAnimation* animation, double time);
  // Positions, and, if `normals` is not null, normals of length 1 or 0, of all vertices in the pose. Normals of
  // primitives that have none are 0.
  void Evaluate(std::vector<Vec3d>& positions, std::vector<Vec3d>* normals);
  // Whether an instance turns its triangles inside out in the pose: they go round the other way then (3.7.4).
  bool IsMirrored(const Instance& instance) const;

 private:
  struct Node {
    std::optional<std::size_t> parent;
    std::optional<Eigen::Matrix4d> matrix;
    NodePose pose;  // at rest
  };
  struct Skin {
    std::vector<std::size_t> joints;
    std::vector<Eigen::Matrix4d> inverse_binds;
  };

  void ReadNode(std::size_t index);
  void AddTree(std::size_t root, std::vector<bool>& visited, Losses& losses);
  void AddInstance(std::size_t node, Losses& losses);
  void ReadSkin(std::size_t index);
  void CheckJoints(const Instance& instance) const;
  const std::vector<float>& Difference(std::size_t accessor);
  void Morph(const GltfPrimitive& primitive, const std::vector<double>& weights, std::vector<Vec3d>& positions,
             std::vector<Vec3d>& normals);

  GltfDocument& document_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> order_;  // parents before their children
  std::vector<std::size_t> weights_;
  std::map<std::size_t, GltfMesh> meshes_;
  std::map<std::size_t, Skin> skins_;
  std::vector<Instance> instances_;
  std::size_t vertices_ = 0;
  std::vector<NodePose> poses_;
  std::vector<Eigen::Matrix4d> globals_;
  std::map<std::size_t, std::vector<float>> differences_;  // of accessors that were used lately
  std::size_t kept_ = 0;                                   // numbers in them
};

}  // namespace sac
