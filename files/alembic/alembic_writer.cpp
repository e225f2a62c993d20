// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_writer.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <utility>

#include "files/byte_order.h"
#include "sac/version.h"

namespace sac {
namespace {

// Both schemas as their metadata name them.
const std::string kXform = "schema=AbcGeom_Xform_v3";
const std::string kXformObject = kXform + ";schemaObjTitle=AbcGeom_Xform_v3:.xform";
const std::string kPolyMesh = "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1";
const std::string kPolyMeshObject = kPolyMesh + ";schemaObjTitle=AbcGeom_PolyMesh_v1:.geom";

constexpr std::uint32_t kFrames = 1;  // the time sampling of frames; 0 is the one of what does not move
constexpr char kTranslate = 1 << 4;   // an operation of a transform
using Kind = AlembicProperty::Kind;

std::string AttributeMetadata(const std::string& scope, const std::string& interpretation, int extent) {
  return "arrayExtent=1;geoScope=" + scope + ";interpretation=" + interpretation +
         ";isGeomParam=true;podExtent=" + std::to_string(extent) + ";podName=float32_t";
}

void Append32(std::uint32_t value, std::string& bytes) {
  char text[4];
  StoreLittle32(value, text);
  bytes.append(text, sizeof text);
}

void AppendDouble(double value, std::string& bytes) {
  char text[8];
  StoreLittle64(std::bit_cast<std::uint64_t>(value), text);
  bytes.append(text, sizeof text);
}

template <std::size_t N>
std::string Floats(const std::vector<std::array<float, N>>& values) {
  std::string bytes(4 * N * values.size(), '\0');
  char* out = bytes.data();
  for (const auto& value : values) {
    for (const float x : value) {
      StoreLittleFloat(x, out);
      out += 4;
    }
  }
  return bytes;
}

// The corners of triangles, turned round: Alembic's faces go the other way.
std::string Corners(const std::vector<Triangle>& triangles) {
  std::string bytes;
  bytes.reserve(12 * triangles.size());
  for (const auto& [a, b, c] : triangles) {
    for (const std::uint32_t corner : {c, b, a}) Append32(corner, bytes);
  }
  return bytes;
}

std::string BoxOf(const Positions& positions) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  std::array<double, 3> low = {kLargest, kLargest, kLargest}, high = {-kLargest, -kLargest, -kLargest};
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], static_cast<double>(p[a]));
      high[a] = std::max(high[a], static_cast<double>(p[a]));
    }
  }
  std::string bytes;
  for (const auto& corner : {low, high}) {
    for (const double x : corner) AppendDouble(x, bytes);
  }
  return bytes;
}

AlembicPropertyTree Scalar(const std::string& name, AlembicPod pod, std::uint32_t extent,
                           const AlembicSampleList& samples, std::uint32_t times = 0,
                           const std::string& metadata = {}) {
  return {name, metadata, Kind::kScalar, pod, extent, times, &samples};
}

AlembicPropertyTree Array(const std::string& name, AlembicPod pod, std::uint32_t extent,
                          const AlembicSampleList& samples, std::uint32_t times = 0, const std::string& metadata = {}) {
  return {name, metadata, Kind::kArray, pod, extent, times, &samples};
}

AlembicPropertyTree Compound(const std::string& name, const std::string& metadata,
                             std::vector<AlembicPropertyTree> properties) {
  AlembicPropertyTree compound;
  compound.name = name;
  compound.metadata = metadata;
  compound.properties = std::move(properties);
  return compound;
}

}  // namespace

Status AlembicWriter::Open(const std::string& path, const Mesh& mesh, const Settings& settings) {
  settings_ = settings;
  name_ = std::filesystem::path(path).stem().string();
  if (name_.empty()) name_ = "mesh";
  SAC_RETURN_IF_ERROR(file_.Open(path));
  SAC_RETURN_IF_ERROR(WriteTransform());
  return WriteFaces(mesh);
}

Status AlembicWriter::WriteTransform() {
  // Without operations the transform is the identity.
  if (settings_.offset == std::array<double, 3>{}) return Status::Ok();
  const std::string yes(1, '\1');
  SAC_RETURN_IF_ERROR(inherits_.Write(file_, yes));
  SAC_RETURN_IF_ERROR(operations_.Write(file_, std::string(1, kTranslate)));
  SAC_RETURN_IF_ERROR(not_identity_.Write(file_, yes));
  std::string numbers;
  for (const double x : settings_.offset) AppendDouble(x, numbers);
  return numbers_.Write(file_, numbers);
}

Status AlembicWriter::WriteFaces(const Mesh& mesh) {
  SAC_RETURN_IF_ERROR(face_indices_.Write(file_, Corners(mesh.triangles)));
  std::string counts;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) Append32(3, counts);
  SAC_RETURN_IF_ERROR(face_counts_.Write(file_, counts));
  if (!mesh.uvs.empty()) {
    SAC_RETURN_IF_ERROR(uvs_.Write(file_, Floats(mesh.uvs)));
    SAC_RETURN_IF_ERROR(uv_indices_.Write(file_, Corners(mesh.uv_triangles)));
  }
  if (!mesh.normals.empty() && !mesh.normal_triangles.empty()) {
    SAC_RETURN_IF_ERROR(normal_indices_.Write(file_, Corners(mesh.normal_triangles)));
  }
  if (mesh.colors.empty()) return Status::Ok();
  std::vector<std::array<float, 4>> colors;
  for (const auto& color : mesh.colors) {
    std::array<float, 4>& c = colors.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) c[k] = static_cast<float>(color[k]) / 255;
  }
  return colors_.Write(file_, Floats(colors));
}

Status AlembicWriter::Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) {
  if (points_.size() == 0) start_ = static_cast<double>(number) / settings_.fps;
  if (points_.size() == std::numeric_limits<std::uint32_t>::max())
    return Status::Limit(file_.path() + ": too many frames");
  SAC_RETURN_IF_ERROR(points_.Write(file_, Floats(positions)));
  SAC_RETURN_IF_ERROR(box_.Write(file_, BoxOf(positions)));
  return normals.empty() ? Status::Ok() : normals_.Write(file_, Floats(normals));
}

AlembicPropertyTree AlembicWriter::Transform() const {
  std::vector<AlembicPropertyTree> properties;
  if (numbers_.size() > 0) {
    properties = {Scalar(".inherits", AlembicPod::kBool, 1, inherits_),
                  Scalar(".ops", AlembicPod::kUint8, 1, operations_),
                  Scalar(".vals", AlembicPod::kFloat64, 3, numbers_),
                  Scalar("isNotConstantIdentity", AlembicPod::kBool, 1, not_identity_)};
  }
  return Compound("", "", {Compound(".xform", kXform, std::move(properties))});
}

AlembicPropertyTree AlembicWriter::Geometry() const {
  std::vector<AlembicPropertyTree> properties = {
      Scalar(".selfBnds", AlembicPod::kFloat64, 6, box_, kFrames, "interpretation=box"),
      Array("P", AlembicPod::kFloat32, 3, points_, kFrames, "geoScope=vtx;interpretation=point"),
      Array(".faceIndices", AlembicPod::kInt32, 1, face_indices_),
      Array(".faceCounts", AlembicPod::kInt32, 1, face_counts_),
  };
  if (uvs_.size() > 0) {
    const std::string metadata = AttributeMetadata("fvr", "vector", 2);
    properties.push_back(Compound("uv", metadata,
                                  {Array(".vals", AlembicPod::kFloat32, 2, uvs_, 0, metadata),
                                   Array(".indices", AlembicPod::kUint32, 1, uv_indices_)}));
  }
  if (normal_indices_.size() > 0) {
    const std::string metadata = AttributeMetadata("fvr", "normal", 3);
    properties.push_back(Compound("N", metadata,
                                  {Array(".vals", AlembicPod::kFloat32, 3, normals_, kFrames, metadata),
                                   Array(".indices", AlembicPod::kUint32, 1, normal_indices_)}));
  } else if (normals_.size() > 0) {
    properties.push_back(Array("N", AlembicPod::kFloat32, 3, normals_, kFrames, AttributeMetadata("vtx", "normal", 3)));
  }
  if (colors_.size() > 0) {
    properties.push_back(Compound(
        ".arbGeomParams", "", {Array("Cd", AlembicPod::kFloat32, 4, colors_, 0, AttributeMetadata("vtx", "rgba", 4))}));
  }
  return Compound("", "", {Compound(".geom", kPolyMesh, std::move(properties))});
}

std::string AlembicWriter::TimeSamplings() const {
  std::string bytes;
  const auto add = [&bytes](std::uint32_t samples, double period, double start) {
    Append32(samples, bytes);
    AppendDouble(period, bytes);
    Append32(1, bytes);
    AppendDouble(start, bytes);
  };
  add(1, 1, 0);
  add(points_.size(), 1 / settings_.fps, start_);
  return bytes;
}

Status AlembicWriter::Commit() {
  if (points_.size() == 0) return Status::InvalidArgument(file_.path() + ": no frames");
  std::string count;
  Append32(points_.size(), count);
  SAC_RETURN_IF_ERROR(sample_count_.Write(file_, count));
  AlembicObjectTree top;
  // The number of samples of a time sampling, where programs look for the length of a clip.
  top.properties =
      Compound("", "", {Scalar(std::to_string(kFrames) + ".samples", AlembicPod::kUint32, 1, sample_count_)});
  top.children.push_back({name_, kXformObject, Transform(), {{name_ + "Shape", kPolyMeshObject, Geometry()}}});
  SAC_RETURN_IF_ERROR(WriteAlembicTree(file_, top,
                                       "_ai_AlembicVersion=Alembic 1.7.5;_ai_Application=sac " SAC_VERSION_STRING
                                       ";_ai_Description=decoded from a stream",
                                       TimeSamplings()));
  return file_.Commit();
}

}  // namespace sac
