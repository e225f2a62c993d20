// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_mesh.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "files/gltf/draco_primitive.h"
#include "files/gltf/gltf_accessor.h"

namespace sac {
namespace {

enum Mode : std::uint64_t { kTriangles = 4, kTriangleStrip, kTriangleFan };

std::size_t Accessor(const GltfDocument& document, const JsonValue& index) {
  return index.Index(document.root()["accessors"].size());
}

// Where an attribute comes from: an accessor, or the mesh that Draco has decoded.
class Attributes {
 public:
  Attributes(GltfDocument& document, const JsonValue& primitive) : document_(document), json_(primitive["attributes"]) {
    if (const JsonValue draco = primitive["extensions"]["KHR_draco_mesh_compression"]) {
      const std::size_t position = Accessor(document, json_["POSITION"]);
      std::uint64_t corners = document.limits().values;
      if (const auto indices = primitive["indices"].OptionalIndex(document.root()["accessors"].size())) {
        corners = DescribeAccessor(document, *indices).count;
      }
      draco_.emplace(document, draco, DescribeAccessor(document, position).count, corners / 3);
    }
  }

  bool Has(const char* name) const { return json_[name].exists(); }
  const std::optional<DracoPrimitive>& draco() const { return draco_; }

  std::size_t Components(const char* name) const {
    return DescribeAccessor(document_, Accessor(document_, json_[name])).components;
  }

  std::vector<float> Numbers(const char* name, std::size_t components) const {
    const std::size_t accessor = Accessor(document_, json_[name]);
    if (draco_ && draco_->Has(name)) {
      return draco_->Numbers(name, components, DescribeAccessor(document_, accessor).normalized);
    }
    return ReadNumbers(document_, accessor, components);
  }

  std::vector<std::uint32_t> Integers(const char* name, std::size_t components) const {
    if (draco_ && draco_->Has(name)) return draco_->Integers(name, components);
    return ReadIntegers(document_, Accessor(document_, json_[name]), components);
  }

 private:
  GltfDocument& document_;
  JsonValue json_;
  std::optional<DracoPrimitive> draco_;
};

std::vector<Triangle> ReadTriangles(GltfDocument& document, const JsonValue& json, std::uint64_t mode,
                                    std::size_t vertices) {
  std::vector<std::uint32_t> indices;
  if (json["indices"]) {
    indices = ReadIntegers(document, Accessor(document, json["indices"]), 1);
  } else {
    for (std::uint32_t v = 0; v < vertices; ++v) indices.push_back(v);
  }
  for (const std::uint32_t v : indices) {
    if (v >= vertices) {
      ThrowCorrupt(json.place() + ".indices: vertex " + std::to_string(v) + ", but there are " +
                   std::to_string(vertices));
    }
  }
  std::vector<Triangle> triangles;
  if (mode == kTriangles) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    if (mode == kTriangleFan) {
      triangles.push_back({indices[0], indices[i + 1], indices[i + 2]});
    } else {  // every other triangle of a strip goes round the other way
      triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
    // Strips are joined by triangles without area, which draw nothing.
    const Triangle& t = triangles.back();
    if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2]) triangles.pop_back();
  }
  return triangles;
}

void CheckCount(const JsonValue& json, const char* name, std::size_t numbers, std::size_t expected) {
  if (numbers != expected) {
    ThrowCorrupt(json.place() + ".attributes." + name + ": not one value for each of the positions");
  }
}

void ReadInfluences(const JsonValue& json, const Attributes& attributes, GltfPrimitive& primitive) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
  for (std::size_t set = 0; set < 64; ++set) {
    const std::string joint = "JOINTS_" + std::to_string(set), weight = "WEIGHTS_" + std::to_string(set);
    if (!attributes.Has(joint.c_str()) || !attributes.Has(weight.c_str())) break;
    joints.push_back(attributes.Integers(joint.c_str(), 4));
    weights.push_back(attributes.Numbers(weight.c_str(), 4));
    CheckCount(json, joint.c_str(), joints.back().size(), 4 * primitive.vertices);
    CheckCount(json, weight.c_str(), weights.back().size(), 4 * primitive.vertices);
  }
  primitive.influences = 4 * joints.size();
  for (std::size_t v = 0; v < primitive.vertices && !joints.empty(); ++v) {
    double sum = 0;
    for (const auto& set : weights) {
      for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(set[4 * v + k]);
    }
    for (std::size_t i = 0; i < primitive.influences; ++i) {
      primitive.joints.push_back(joints[i / 4][4 * v + i % 4]);
      // Without any weight a vertex follows its first joint, as engines do it.
      const double weight = sum > 0 ? static_cast<double>(weights[i / 4][4 * v + i % 4]) / sum : i == 0 ? 1 : 0;
      primitive.weights.push_back(static_cast<float>(weight));
    }
  }
}

void TellAttributes(const JsonValue& json, Losses& losses) {
  for (const std::string& name : json.keys()) {
    const std::string_view n = name;
    if (n == "TANGENT") losses.Count("tangents of primitives");
    if (n.starts_with("TEXCOORD_") && n != "TEXCOORD_0") losses.List("further texture coordinates", name);
    if (n.starts_with("COLOR_") && n != "COLOR_0") losses.List("further colors", name);
    if (n.starts_with("_")) losses.List("attributes", name);
  }
}

std::vector<float> ReadColors(const Attributes& attributes) {
  const std::size_t components = attributes.Components("COLOR_0");
  if (components == 4) return attributes.Numbers("COLOR_0", 4);
  const std::vector<float> rgb = attributes.Numbers("COLOR_0", 3);
  std::vector<float> rgba;
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    rgba.push_back(rgb[i]);
    if (i % 3 == 2) rgba.push_back(1);
  }
  return rgba;
}

GltfPrimitive ReadPrimitive(GltfDocument& document, const JsonValue& json, std::uint64_t mode, Losses& losses) {
  const Attributes attributes(document, json);
  GltfPrimitive primitive;
  primitive.positions = attributes.Numbers("POSITION", 3);
  primitive.vertices = primitive.positions.size() / 3;
  if (attributes.Has("NORMAL")) primitive.normals = attributes.Numbers("NORMAL", 3);
  if (attributes.Has("TEXCOORD_0")) primitive.uvs = attributes.Numbers("TEXCOORD_0", 2);
  if (attributes.Has("COLOR_0")) primitive.colors = ReadColors(attributes);
  const auto check = [&](const char* name, const std::vector<float>& values, std::size_t components) {
    if (!values.empty()) CheckCount(json, name, values.size(), components * primitive.vertices);
  };
  check("NORMAL", primitive.normals, 3);
  check("TEXCOORD_0", primitive.uvs, 2);
  check("COLOR_0", primitive.colors, 4);
  ReadInfluences(json, attributes, primitive);
  TellAttributes(json["attributes"], losses);
  if (attributes.draco()) {
    primitive.triangles = attributes.draco()->triangles();
  } else {
    primitive.triangles = ReadTriangles(document, json, mode, primitive.vertices);
  }
  const JsonValue targets = json["targets"];
  const std::size_t accessors = document.root()["accessors"].size();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    GltfPrimitive::Target target{targets[i]["POSITION"].OptionalIndex(accessors),
                                 targets[i]["NORMAL"].OptionalIndex(accessors)};
    for (const auto& accessor : {target.positions, target.normals}) {
      if (accessor && DescribeAccessor(document, *accessor).count != primitive.vertices) {
        ThrowCorrupt(targets[i].place() + ": not one value for each of the positions");
      }
    }
    for (const char* name : {"COLOR_0", "TEXCOORD_0"}) {
      if (targets[i][name]) losses.Count("targets that change colors or texture coordinates");
    }
    primitive.targets.push_back(target);
  }
  return primitive;
}

}  // namespace

GltfMesh ReadGltfMesh(GltfDocument& document, std::size_t index, Losses& losses) {
  const JsonValue json = document.root()["meshes"][index];
  GltfMesh mesh;
  mesh.name = json["name"].String();
  std::vector<std::size_t> places;  // of mesh.primitives
  std::optional<std::size_t> targets;
  for (std::size_t i = 0; i < json["primitives"].size(); ++i) {
    const JsonValue primitive = json["primitives"][i];
    const std::uint64_t mode = primitive["mode"].Unsigned(kTriangleFan, kTriangles);
    if (const auto material = primitive["material"].OptionalIndex(document.root()["materials"].size())) {
      const std::string name = document.root()["materials"][*material]["name"].String();
      losses.List("materials", name.empty() ? std::to_string(*material) : name);
    }
    if (mode < kTriangles || !primitive["attributes"]["POSITION"]) {
      losses.Count(mode < kTriangles ? "primitives of points or lines" : "primitives without positions");
      continue;
    }
    if (targets.value_or(primitive["targets"].size()) != primitive["targets"].size()) {
      ThrowCorrupt(primitive.place() + ".targets: not as many as in the primitives before");
    }
    targets = primitive["targets"].size();
    // Primitives of several materials often share their vertices.
    const auto same = std::find_if(places.begin(), places.end(), [&](std::size_t other) {
      const JsonValue before = json["primitives"][other];
      const bool draco =
          primitive["extensions"]["KHR_draco_mesh_compression"] || before["extensions"]["KHR_draco_mesh_compression"];
      return !draco && before["attributes"].json() == primitive["attributes"].json() &&
             (*targets == 0 || before["targets"].json() == primitive["targets"].json());
    });
    if (same != places.end()) {
      GltfPrimitive& before = mesh.primitives[static_cast<std::size_t>(same - places.begin())];
      const auto triangles = ReadTriangles(document, primitive, mode, before.vertices);
      before.triangles.insert(before.triangles.end(), triangles.begin(), triangles.end());
      continue;
    }
    places.push_back(i);
    mesh.primitives.push_back(ReadPrimitive(document, primitive, mode, losses));
  }
  mesh.weights.assign(targets.value_or(0), 0);
  if (json["weights"] && !mesh.primitives.empty()) mesh.weights = json["weights"].Numbers(mesh.weights.size());
  return mesh;
}

}  // namespace sac
