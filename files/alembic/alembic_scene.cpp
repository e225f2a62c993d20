// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_scene.h"

#include <string_view>
#include <utility>

namespace sac {
namespace {

constexpr int kMostDepth = 256;    // instances within instances
constexpr unsigned kDeferred = 4;  // beside Visibility: as the parent

Status At(const std::string& path, const Status& status) {
  return status.ok() ? status : Status(status.code(), path + ": " + status.message());
}

// Objects that hold no mesh, and what they are called.
constexpr std::pair<std::string_view, std::string_view> kOthers[] = {
    {"AbcGeom_Curve", "curves"},           {"AbcGeom_Points", "points"},
    {"AbcGeom_NuPatch", "NURBS patches"},  {"AbcGeom_Camera", "cameras"},
    {"AbcGeom_Light", "lights"},           {"AbcGeom_FaceSet", "face sets"},
    {"AbcMaterial_Material", "materials"}, {"AbcCollection_Collections", "collections"},
};

bool IsMesh(std::string_view schema) { return schema == "AbcGeom_PolyMesh" || schema == "AbcGeom_SubD"; }

}  // namespace

Status AlembicScene::Open(RandomAccess bytes, const FrameRate& wanted, const AlembicLimits& limits,
                          std::unique_ptr<AlembicScene>& scene) {
  auto opened = std::make_unique<AlembicScene>();
  opened->limits_ = limits;
  SAC_RETURN_IF_ERROR(AlembicArchive::Open(std::move(bytes), opened->archive_));
  SAC_RETURN_IF_ERROR(opened->Visit(opened->archive_.top(), {}));
  if (opened->meshes_.empty()) {
    const std::string others = opened->losses_.Text();
    return Status::InvalidArgument((opened->hidden_ > 0 ? "all meshes are hidden" : "no meshes with vertices") +
                                   (others.empty() ? "" : "; it has " + others));
  }
  SAC_RETURN_IF_ERROR(opened->ChooseFrames(wanted));
  scene = std::move(opened);
  return Status::Ok();
}

void AlembicScene::ListPaths(const AlembicObject& object, const std::string& path) {
  objects_by_path_.emplace(path, &object);
  for (const AlembicObject& child : object.children) ListPaths(child, path + "/" + child.name);
}

Status AlembicScene::ReadVisibility(const AlembicObject& object, const Place& place, unsigned& visibility) {
  const auto [found, added] = visibilities_.try_emplace(&object, 0U);
  const AlembicProperty* property = object.properties.Find("visible");
  if (added && property != nullptr) {
    AlembicSamples samples;
    SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive_, *property, samples));
    std::vector<std::int64_t> value;
    for (std::uint32_t i = 0; i < samples.stored() && found->second != (kVisible | kHidden | kDeferred); ++i) {
      SAC_RETURN_IF_ERROR(samples.ReadStored(i, value));
      if (!value.empty()) found->second |= value[0] < 0 ? kDeferred : value[0] == 0 ? kHidden : kVisible;
    }
  }
  const unsigned own = found->second;
  visibility = own == 0 ? place.visibility : own & (kVisible | kHidden);
  if ((own & kDeferred) != 0) visibility |= place.visibility;
  return Status::Ok();
}

void AlembicScene::ListLoss(const AlembicObject& object, const Place& place) {
  const std::string_view schema = object.schema();
  if (schema.empty() || schema == "AbcGeom_Xform" || IsMesh(schema)) return;
  for (const auto& [other, name] : kOthers) {
    if (schema == other) return losses_.List(name, schema == "AbcGeom_FaceSet" ? object.name : place.path);
  }
  losses_.List("objects of unknown schemas", place.path);
}

Status AlembicScene::AddNode(const AlembicObject& object, Place& place) {
  std::shared_ptr<const AlembicTransform>& transform = transforms_[&object];
  if (!transform) {
    AlembicTransform read;
    SAC_RETURN_IF_ERROR(AlembicTransform::Open(archive_, object, read));
    transform = std::make_shared<const AlembicTransform>(std::move(read));
    if (const AlembicProperty* xform = object.properties.Find(".xform")) {
      for (const char* compound : {".userProperties", ".arbGeomParams"}) {
        const AlembicProperty* own = xform->Find(compound);
        if (own == nullptr) continue;
        for (const AlembicProperty& property : own->properties) losses_.List("user properties", property.name);
      }
    }
  }
  nodes_.push_back({transform->inherits() ? place.node : std::nullopt, transform});
  place.node = nodes_.size() - 1;
  return Status::Ok();
}

Status AlembicScene::AddMesh(const AlembicObject& object, const Place& place) {
  std::shared_ptr<const AlembicMesh>& mesh = read_meshes_[&object];
  if (!mesh) {
    AlembicMesh read;
    SAC_RETURN_IF_ERROR(AlembicMesh::Open(archive_, object, read, losses_));
    if (object.schema() == "AbcGeom_SubD") losses_.List("subdivisions", place.path);
    mesh = std::make_shared<const AlembicMesh>(std::move(read));
    Losses changing;
    mesh->ListChanges(changing);
    if (const std::string text = changing.Text(); !text.empty()) {
      warnings_.push_back(place.path + ": what changes of " + text + " is not kept; every frame gets the first");
    }
  }
  if (place.visibility == kHidden) {
    ++hidden_;
    losses_.List("hidden meshes", place.path);
    return Status::Ok();
  }
  std::uint64_t first = 0, later = 0, corners = 0;
  if (const AlembicSamples& points = mesh->points(); points.size() > 0) {
    SAC_RETURN_IF_ERROR(points.Count(0, first));
    SAC_RETURN_IF_ERROR(points.Count(points.size() - 1, later));
    SAC_RETURN_IF_ERROR(mesh->Count(points.times().Time(0), first, corners));
  }
  if (first == 0 && later == 0) {
    losses_.List("empty meshes", place.path);
    return Status::Ok();
  }
  if ((place.visibility & kHidden) != 0) {
    warnings_.push_back(place.path + ": is hidden at times, which is not kept; it shows in every frame");
  }
  meshes_.push_back({place.path, place.node, mesh});
  return Status::Ok();
}

Status AlembicScene::FindOriginal(const AlembicProperty& source, const AlembicObject*& original) {
  const auto [found, added] = originals_.try_emplace(&source, nullptr);
  if (added) {
    AlembicSamples samples;
    SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive_, source, samples));
    std::string path;
    if (samples.size() > 0) SAC_RETURN_IF_ERROR(samples.ReadText(0, path));
    if (objects_by_path_.empty()) ListPaths(archive_.top(), "");
    const auto named = objects_by_path_.find(path);
    if (!path.empty() && named != objects_by_path_.end()) found->second = named->second;
  }
  original = found->second;
  return original == nullptr ? Status::Corrupt("an instance of an object that there is not") : Status::Ok();
}

Status AlembicScene::Visit(const AlembicObject& object, Place place) {
  if (++objects_ > limits_.objects) return Status::Limit("more than " + std::to_string(limits_.objects) + " objects");
  if (++place.depth > kMostDepth) return Status::Limit(place.path + ": instances that contain themselves");
  if (const AlembicProperty* source = object.properties.Find(".instanceSource")) {
    const AlembicObject* original = nullptr;
    SAC_RETURN_IF_ERROR(At(place.path, FindOriginal(*source, original)));
    return Visit(*original, std::move(place));
  }
  unsigned visibility = 0;
  SAC_RETURN_IF_ERROR(At(place.path, ReadVisibility(object, place, visibility)));
  place.visibility = visibility;
  const std::string_view schema = object.schema();
  if (schema == "AbcGeom_Xform") SAC_RETURN_IF_ERROR(At(place.path, AddNode(object, place)));
  if (IsMesh(schema)) SAC_RETURN_IF_ERROR(At(place.path, AddMesh(object, place)));
  ListLoss(object, place);
  for (const AlembicObject& child : object.children) {
    Place below = place;
    below.path += "/" + child.name;
    SAC_RETURN_IF_ERROR(Visit(child, std::move(below)));
  }
  return Status::Ok();
}

Status AlembicScene::Matrices(double time, std::vector<Eigen::Affine3d>& matrices) const {
  matrices.clear();
  matrices.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    Eigen::Affine3d matrix;
    SAC_RETURN_IF_ERROR(node.transform->At(time, matrix));
    matrices.push_back(node.parent ? matrices[*node.parent] * matrix : matrix);
  }
  return Status::Ok();
}

Status AlembicScene::CheckCounts(double time) const {
  std::uint64_t vertices = 0, corners = 0;
  for (const SceneMesh& mesh : meshes_) {
    std::uint64_t own_vertices = 0, own_corners = 0;
    SAC_RETURN_IF_ERROR(At(mesh.path, mesh.mesh->Count(time, own_vertices, own_corners)));
    vertices += own_vertices;
    corners += own_corners;
    if (vertices > limits_.vertices || corners > limits_.corners) {
      return Status::Limit("more than " + std::to_string(limits_.vertices) + " vertices or " +
                           std::to_string(limits_.corners) + " corners of faces");
    }
  }
  return Status::Ok();
}

Status AlembicScene::ReadMesh(std::uint32_t frame, PolygonMesh& mesh) const {
  const double time = TimeOf(frame);
  SAC_RETURN_IF_ERROR(CheckCounts(time));
  std::vector<Eigen::Affine3d> matrices;
  SAC_RETURN_IF_ERROR(Matrices(time, matrices));
  MergedMeshes merged;
  for (const SceneMesh& one : meshes_) {
    const Eigen::Affine3d matrix = one.node ? matrices[*one.node] : Eigen::Affine3d::Identity();
    SAC_RETURN_IF_ERROR(At(one.path, one.mesh->Add(time, matrix, one.path, merged)));
  }
  mesh = std::move(merged.mesh);
  Losses losses = losses_;
  if (!merged.colors.empty()) mesh.colors = RoundColors(merged.colors, losses);
  losses.Add(mesh.losses);
  mesh.losses = std::move(losses);
  mesh.warnings.insert(mesh.warnings.end(), warnings_.begin(), warnings_.end());
  mesh.objects = meshes_.size();
  return Status::Ok();
}

Status AlembicScene::ReadPositions(std::uint32_t frame, PolygonMesh& mesh, std::uint32_t first) const {
  mesh = {};
  const double time = TimeOf(frame);
  SAC_RETURN_IF_ERROR(CheckCounts(time));
  std::vector<Eigen::Affine3d> matrices;
  SAC_RETURN_IF_ERROR(Matrices(time, matrices));
  for (const SceneMesh& one : meshes_) {
    bool same = false;
    SAC_RETURN_IF_ERROR(At(one.path, one.mesh->HasSameFaces(TimeOf(first), time, same)));
    if (!same) {
      return Status::Unsupported(one.path + ": frame " + std::to_string(frame) +
                                 ": other vertices or faces than in frame " + std::to_string(first));
    }
    const Eigen::Affine3d matrix = one.node ? matrices[*one.node] : Eigen::Affine3d::Identity();
    SAC_RETURN_IF_ERROR(At(one.path, one.mesh->AddPositions(time, matrix, one.path, mesh)));
  }
  return Status::Ok();
}

}  // namespace sac
