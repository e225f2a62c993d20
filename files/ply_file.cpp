// SPDX-License-Identifier: Apache-2.0
#include "files/ply_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/ply_header.h"
#include "files/ply_values.h"
#include "files/text_scan.h"

namespace sac {
namespace {

// What a value of a vertex is for.
enum Slot : std::size_t { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV, kRed, kGreen, kBlue, kAlpha, kSlots };

struct SlotName {
  std::string_view name;
  Slot slot;
};

constexpr SlotName kSlotNames[] = {
    {"x", kX},
    {"y", kY},
    {"z", kZ},
    {"nx", kNormalX},
    {"ny", kNormalY},
    {"nz", kNormalZ},
    {"s", kU},
    {"t", kV},
    {"u", kU},
    {"v", kV},
    {"texture_u", kU},
    {"texture_v", kV},
    {"red", kRed},
    {"green", kGreen},
    {"blue", kBlue},
    {"alpha", kAlpha},
    {"diffuse_red", kRed},
    {"diffuse_green", kGreen},
    {"diffuse_blue", kBlue},
    {"diffuse_alpha", kAlpha},
    {"r", kRed},
    {"g", kGreen},
    {"b", kBlue},
    {"a", kAlpha},
};

// The properties of a vertex and what each is for; the first of a kind counts.
struct VertexLayout {
  std::vector<std::optional<Slot>> slots;  // one per property
  std::array<std::optional<PlyType>, kSlots> types;

  bool Has(Slot first, std::size_t count) const {
    return std::all_of(types.begin() + first, types.begin() + first + count,
                       [](const auto& type) { return type.has_value(); });
  }
};

VertexLayout LayOut(const PlyElement& element, Losses& losses) {
  VertexLayout layout;
  for (const PlyProperty& property : element.properties) {
    const auto* known = std::find_if(std::begin(kSlotNames), std::end(kSlotNames),
                                     [&](const SlotName& slot) { return slot.name == property.name; });
    const bool taken = known != std::end(kSlotNames) && !property.count && !layout.types[known->slot];
    layout.slots.push_back(taken ? std::optional(known->slot) : std::nullopt);
    if (taken) layout.types[known->slot] = property.type;
  }
  // Half of a pair or of three is no normal, and no colour.
  const auto drop = [&](Slot first, std::size_t count) {
    if (layout.Has(first, count)) return;
    for (std::size_t slot = first; slot < first + count; ++slot) layout.types[slot].reset();
    for (auto& slot : layout.slots) {
      if (slot && *slot >= first && *slot < first + count) slot.reset();
    }
  };
  drop(kNormalX, 3);
  drop(kU, 2);
  if (!layout.Has(kRed, 3)) drop(kRed, 4);  // with alpha
  for (std::size_t i = 0; i < layout.slots.size(); ++i) {
    if (!layout.slots[i]) losses.List("vertex properties", element.properties[i].name);
  }
  return layout;
}

// The largest value of a colour as an integer of `type`; 0 for float, whose range the values tell.
float ColorScale(PlyType type) {
  constexpr float kScales[] = {255, 255, 65535, 65535, 255, 255, 0, 0};
  return kScales[static_cast<std::size_t>(type)];
}

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const PlyHeader& header, PolygonMesh& parsed)
      : header_(header), values_(bytes, header), mesh_(parsed) {}

  Status Parse();

 private:
  Status ParseVertices(const PlyElement& element);
  Status ParseFaces(const PlyElement& element);
  Status ParseFace(const PlyElement& element, std::size_t indices, std::size_t texcoord);
  Status Skip(const PlyProperty& property);
  void TakeRow(const VertexLayout& layout, const std::array<double, kSlots>& row);

  const PlyHeader& header_;
  PlyValues values_;
  PolygonMesh& mesh_;
  std::vector<std::array<float, 2>> vertex_uvs_;
  std::vector<std::array<float, 4>> colors_;
  std::uint64_t odd_texcoords_ = 0;  // faces whose texture coordinates are not two a corner
};

Status PlyParser::Skip(const PlyProperty& property) {
  std::size_t count = 1;
  double ignored = 0;
  if (property.count) SAC_RETURN_IF_ERROR(values_.TakeCount(*property.count, property.type, count));
  for (; count > 0; --count) SAC_RETURN_IF_ERROR(values_.Take(property.type, ignored));
  return Status::Ok();
}

void PlyParser::TakeRow(const VertexLayout& layout, const std::array<double, kSlots>& row) {
  const auto real = [&row](Slot slot) { return static_cast<float>(row[slot]); };
  if (layout.types[kNormalX]) mesh_.normals.push_back({real(kNormalX), real(kNormalY), real(kNormalZ)});
  if (layout.types[kU]) vertex_uvs_.push_back({real(kU), real(kV)});
  if (!layout.types[kRed]) return;
  std::array<float, 4> color = {0, 0, 0, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!layout.types[kRed + k]) continue;
    const float scale = ColorScale(*layout.types[kRed + k]);
    color[k] = static_cast<float>(row[kRed + k]) / (scale > 0 ? scale : 1);
  }
  color[3] = std::max(color[3], 0.0F);
  colors_.push_back(color);
}

Status PlyParser::ParseVertices(const PlyElement& element) {
  const VertexLayout layout = LayOut(element, mesh_.losses);
  if (!layout.Has(kX, 3)) return Status::Corrupt("header: the vertices need x, y and z");
  for (std::size_t slot = kX; slot <= kZ; ++slot) {
    const PlyType type = *layout.types[slot];
    mesh_.wide |= type == PlyType::kFloat64 || type == PlyType::kInt32 || type == PlyType::kUint32;
  }
  mesh_.wide |= header_.format == PlyHeader::Format::kAscii;
  for (std::uint64_t vertex = 0; vertex < element.count; ++vertex) {
    std::array<double, kSlots> row{};
    std::string not_finite;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const std::optional<Slot> slot = layout.slots[i];
      double value = 0;
      Status status = slot ? values_.Take(element.properties[i].type, value) : Skip(element.properties[i]);
      if (!status.ok()) return Status(status.code(), "vertex " + std::to_string(vertex) + ": " + status.message());
      if (!slot) continue;
      row[*slot] = value;
      if (*slot <= kZ && !std::isfinite(static_cast<float>(value)) && mesh_.not_finite.empty() && not_finite.empty()) {
        not_finite = values_.Where() + "vertex " + std::to_string(vertex);
        if (!values_.word().empty()) not_finite += ": " + std::string(values_.word());
      }
    }
    mesh_.AddPosition({row[kX], row[kY], row[kZ]}, [&] { return not_finite; });
    TakeRow(layout, row);
  }
  return Status::Ok();
}

Status PlyParser::ParseFace(const PlyElement& element, std::size_t indices, std::size_t texcoord) {
  std::vector<float> uvs;
  std::size_t corners = 0;
  double value = 0;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (i != indices && i != texcoord) {
      SAC_RETURN_IF_ERROR(Skip(property));
      continue;
    }
    std::size_t count = 0;
    SAC_RETURN_IF_ERROR(values_.TakeCount(*property.count, property.type, count));
    if (i == indices) corners = count;
    for (; count > 0; --count) {
      SAC_RETURN_IF_ERROR(values_.Take(property.type, value));
      if (i == texcoord) {
        uvs.push_back(static_cast<float>(value));
      } else if (value >= 0 && value < PolygonMesh::kNone && value == std::floor(value)) {
        mesh_.faces.vertices.push_back(static_cast<std::uint32_t>(value));
      } else {
        const std::string number = std::to_string(value);
        return Status::Corrupt("no vertex " + number.substr(0, number.find_last_not_of(".0") + 1));
      }
    }
  }
  if (texcoord < element.properties.size()) {
    odd_texcoords_ += uvs.size() != 2 * corners && !uvs.empty() ? 1 : 0;
    for (std::size_t k = 0; k < corners; ++k) {
      const bool has = uvs.size() == 2 * corners;
      mesh_.corner_uvs.push_back(has ? static_cast<std::uint32_t>(mesh_.uvs.size()) : PolygonMesh::kNone);
      if (has) mesh_.uvs.push_back({uvs[2 * k], uvs[2 * k + 1]});
    }
  }
  return mesh_.EndFace();
}

Status PlyParser::ParseFaces(const PlyElement& element) {
  const std::vector<PlyProperty>& properties = element.properties;
  std::size_t indices = properties.size(), texcoord = properties.size();
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const std::string& name = properties[i].name;
    const bool list = properties[i].count.has_value();
    if (list && (name == "vertex_indices" || name == "vertex_index") && indices == properties.size()) {
      indices = i;
    } else if (list && name == "texcoord" && texcoord == properties.size()) {
      texcoord = i;
    } else {
      mesh_.losses.List("face properties", name);
    }
  }
  if (indices == properties.size()) {
    return element.count == 0 ? Status::Ok() : Status::Corrupt("header: the faces have no vertex_indices");
  }
  for (std::uint64_t face = 0; face < element.count; ++face) {
    const Status status = ParseFace(element, indices, texcoord);
    if (!status.ok()) return Status(status.code(), "face " + std::to_string(face) + ": " + status.message());
  }
  return Status::Ok();
}

Status PlyParser::Parse() {
  for (const PlyElement& element : header_.elements) {
    if (element.name == "vertex") {
      SAC_RETURN_IF_ERROR(ParseVertices(element));
    } else if (element.name == "face") {
      SAC_RETURN_IF_ERROR(ParseFaces(element));
    } else if (element.count > 0 && !element.properties.empty()) {
      mesh_.losses.List("elements", element.name);
      for (std::uint64_t row = 0; row < element.count; ++row) {
        for (const PlyProperty& property : element.properties) {
          const Status status = Skip(property);
          if (!status.ok()) {
            return Status(status.code(), element.name + " " + std::to_string(row) + ": " + status.message());
          }
        }
      }
    }
  }
  if (mesh_.corner_uvs.empty() && !vertex_uvs_.empty()) {
    mesh_.corner_uvs = mesh_.faces.vertices;
    mesh_.uvs = std::move(vertex_uvs_);
  } else {
    mesh_.losses.Count("texture coordinates of vertices beside those of corners", vertex_uvs_.size());
  }
  mesh_.losses.Count("faces' texture coordinates that are not two a corner", odd_texcoords_);
  mesh_.colors = RoundColors(colors_, mesh_.losses);
  return Status::Ok();
}

}  // namespace

Status ParsePly(std::string& bytes, PolygonMesh& parsed) {
  parsed = {};
  if (bytes.compare(0, 3, "\xEF\xBB\xBF") == 0) bytes.erase(0, 3);
  PlyHeader header;
  Status status = ParsePlyHeader(bytes, header);
  if (!status.ok() || header.format == PlyHeader::Format::kAscii) {
    // Of text in UTF-16, or lines with another end, the header is only now to be read.
    SAC_RETURN_IF_ERROR(NormalizeText(bytes));
    status = ParsePlyHeader(bytes, header);
  }
  SAC_RETURN_IF_ERROR(status);
  return PlyParser(bytes, header, parsed).Parse();
}

}  // namespace sac
