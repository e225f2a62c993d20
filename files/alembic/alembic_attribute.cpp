// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_attribute.h"

#include <string_view>

namespace sac {
namespace {

using Scope = AlembicAttribute::Scope;

std::optional<Scope> ScopeOf(std::string_view metadata) {
  const std::string_view name = MetadataValue(metadata, "geoScope");
  if (name == "fvr") return Scope::kCorner;
  if (name == "vtx" || name == "var") return Scope::kVertex;  // they differ for curves alone
  if (name == "uni") return Scope::kFace;
  if (name == "con") return Scope::kConstant;
  return std::nullopt;
}

// The item of each corner.
std::vector<std::uint32_t> ItemsOfCorners(const Faces& faces, Scope scope) {
  if (scope == Scope::kVertex) return faces.vertices;
  std::vector<std::uint32_t> items(faces.vertices.size());
  if (scope == Scope::kConstant) return items;
  for (std::uint32_t face = 0; face < faces.size(); ++face) {
    for (std::uint32_t k = faces.begin(face); k < faces.ends[face]; ++k) items[k] = scope == Scope::kFace ? face : k;
  }
  return items;
}

std::size_t Items(const Faces& faces, std::size_t vertices, Scope scope) {
  switch (scope) {
    case Scope::kCorner:
      return faces.vertices.size();
    case Scope::kVertex:
      return vertices;
    case Scope::kFace:
      return faces.size();
    default:
      return 1;
  }
}

}  // namespace

Status AlembicAttribute::Open(AlembicArchive& archive, const AlembicProperty& property, AlembicAttribute& attribute) {
  attribute = {};
  const AlembicProperty *values = &property, *indices = nullptr;
  if (property.kind == AlembicProperty::Kind::kCompound) {
    values = property.Find(".vals");
    indices = property.Find(".indices");
  }
  if (values == nullptr) return Status::Corrupt(property.name + ": has no values");
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *values, attribute.values_));
  if (indices != nullptr) SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *indices, attribute.indices_));
  attribute.components_ = values->extent;
  attribute.scope_ = ScopeOf(property.metadata);
  if (!attribute.scope_) attribute.scope_ = ScopeOf(values->metadata);
  return Status::Ok();
}

Status AlembicAttribute::Read(double time, const Faces& faces, std::size_t vertices, std::vector<float>& values,
                              std::vector<std::uint32_t>& of_corners, bool& fits) const {
  fits = false;
  SAC_RETURN_IF_ERROR(values_.Read(values_.At(time).low, values));
  const std::size_t count = values.size() / components_;
  std::vector<std::int64_t> indices;
  if (indices_.size() > 0) SAC_RETURN_IF_ERROR(indices_.Read(indices_.At(time).low, indices));
  const std::size_t items = indices_.size() > 0 ? indices.size() : count;
  std::optional<Scope> scope = scope_;
  if (!scope) scope = items == faces.vertices.size() ? Scope::kCorner : Scope::kVertex;
  if (items != Items(faces, vertices, *scope)) return Status::Ok();
  of_corners = ItemsOfCorners(faces, *scope);
  if (indices_.size() > 0) {
    for (std::uint32_t& item : of_corners) {
      const std::int64_t index = indices[item];
      if (index < 0 || static_cast<std::uint64_t>(index) >= count) return Status::Corrupt("an index out of range");
      item = static_cast<std::uint32_t>(index);
    }
  }
  fits = true;
  return Status::Ok();
}

}  // namespace sac
