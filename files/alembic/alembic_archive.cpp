// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_archive.h"

#include <algorithm>
#include <array>
#include <utility>

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr int kMostDepth = 128;  // of objects, and of compounds
constexpr std::size_t kHashBytes = 32;
constexpr std::uint8_t kOwnMetadata = 0xFF;  // in place of an index

Status CutShort() { return Status::Corrupt("a header that is cut short"); }

// Takes numbers and texts from the front of headers; remembers whether there were enough bytes.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  bool ok() const { return ok_; }

  // A number of 1, 2 or 4 bytes.
  std::uint32_t Number(std::size_t size) {
    const std::string_view taken = Text(size);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(taken[i])) << (8 * i);
    }
    return value;
  }

  std::string_view Text(std::size_t size) {
    ok_ = ok_ && size <= bytes_.size();
    if (!ok_) return {};
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

// The metadata of a header: by index, or written out after a size of `size_bytes` bytes.
Status TakeMetadata(std::uint32_t index, std::size_t size_bytes, const std::vector<std::string>& indexed,
                    HeaderBytes& header, std::string& metadata) {
  if (index == kOwnMetadata) {
    metadata = header.Text(header.Number(size_bytes));
    return header.ok() ? Status::Ok() : CutShort();
  }
  if (index >= indexed.size()) return Status::Corrupt("a header names metadata that there are not");
  metadata = indexed[index];
  return Status::Ok();
}

// The header of a property: a word of flags, then what they announce.
Status TakeProperty(const std::vector<std::string>& indexed, std::size_t samplings, HeaderBytes& header,
                    AlembicProperty& property) {
  const std::uint32_t flags = header.Number(4);
  const std::uint32_t kind = flags & 3, size_code = flags >> 2 & 3;
  if (size_code > 2) return Status::Corrupt("a header with an unknown size of numbers");
  const std::size_t size = std::size_t{1} << size_code;
  using Kind = AlembicProperty::Kind;
  property.kind = kind == 0 ? Kind::kCompound : kind == 1 ? Kind::kScalar : Kind::kArray;
  if (kind != 0) {
    const std::uint32_t pod = flags >> 4 & 0xF;
    if (pod > static_cast<std::uint32_t>(AlembicPod::kWideString)) {
      return Status::Corrupt("a property of an unknown type");
    }
    property.pod = static_cast<AlembicPod>(pod);
    property.extent = std::max(flags >> 12 & 0xFF, 1U);  // 0 where there are no numbers
    property.samples = header.Number(size);
    property.first_changed = 1;
    property.last_changed = property.samples > 0 ? property.samples - 1 : 0;
    if ((flags & 0x200) != 0) {
      property.first_changed = header.Number(size);
      property.last_changed = header.Number(size);
    } else if ((flags & 0x800) != 0) {
      property.first_changed = property.last_changed = 0;
    }
    if ((flags & 0x100) != 0) property.time_sampling = header.Number(size);
  }
  property.name = header.Text(header.Number(size));
  SAC_RETURN_IF_ERROR(TakeMetadata(flags >> 20 & 0xFF, size, indexed, header, property.metadata));
  if (!header.ok()) return CutShort();
  if (kind == 0) return Status::Ok();
  const bool ordered = property.first_changed <= property.last_changed || property.last_changed == 0;
  if (!ordered || property.last_changed >= std::max(property.samples, 1U)) {
    return Status::Corrupt("property " + property.name + ": its numbers contradict each other");
  }
  if (property.time_sampling >= samplings) {
    return Status::Corrupt("property " + property.name + ": times that there are not");
  }
  return Status::Ok();
}

Status ParseIndexedMetadata(std::string_view bytes, std::vector<std::string>& indexed) {
  indexed.assign(1, "");
  for (HeaderBytes header(bytes); !header.empty();) {
    indexed.emplace_back(header.Text(header.Number(1)));
    if (!header.ok()) return CutShort();
  }
  return Status::Ok();
}

}  // namespace

std::size_t SizeOf(AlembicPod pod) {
  constexpr std::array<std::size_t, 14> kSizes = {1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 0, 0};
  return kSizes[static_cast<std::size_t>(pod)];
}

std::uint32_t AlembicProperty::Stored(std::uint32_t index) const {
  if (constant() || index < first_changed) return 0;
  return std::min(index, last_changed) - first_changed + 1;
}

const AlembicProperty* AlembicProperty::Find(std::string_view wanted) const {
  const auto found =
      std::find_if(properties.begin(), properties.end(), [wanted](const auto& p) { return p.name == wanted; });
  return found == properties.end() ? nullptr : &*found;
}

std::string_view MetadataValue(std::string_view metadata, std::string_view key) {
  while (!metadata.empty()) {
    const std::size_t end = std::min(metadata.find(';'), metadata.size());
    const std::string_view entry = metadata.substr(0, end);
    if (entry.size() > key.size() && entry.starts_with(key) && entry[key.size()] == '=') {
      return entry.substr(key.size() + 1);
    }
    metadata.remove_prefix(std::min(end + 1, metadata.size()));
  }
  return {};
}

std::string_view AlembicObject::schema() const {
  const std::string_view schema = MetadataValue(metadata, "schema");
  return schema.substr(0, schema.rfind("_v"));
}

Status AlembicArchive::ReadCompound(OgawaRef group, int depth, AlembicProperty& compound) {
  if (depth > kMostDepth) return Status::Limit("properties more than 128 levels deep");
  std::vector<OgawaRef> children;
  SAC_RETURN_IF_ERROR(ogawa_.ReadGroup(group, children));
  if (children.empty()) return Status::Ok();
  std::string bytes;
  SAC_RETURN_IF_ERROR(ogawa_.ReadStructure(children.back(), bytes));
  children.pop_back();
  HeaderBytes header(bytes);
  for (const OgawaRef child : children) {
    AlembicProperty property;
    SAC_RETURN_IF_ERROR(TakeProperty(indexed_metadata_, time_samplings_.size(), header, property));
    property.group = child;
    if (property.kind == AlembicProperty::Kind::kCompound) {
      SAC_RETURN_IF_ERROR(ReadCompound(child, depth + 1, property));
    }
    compound.properties.push_back(std::move(property));
  }
  return header.empty() ? Status::Ok() : Status::Corrupt("headers of more properties than there are");
}

Status AlembicArchive::ReadObject(OgawaRef group, int depth, AlembicObject& object) {
  if (depth > kMostDepth) return Status::Limit("objects more than 128 levels deep");
  std::vector<OgawaRef> children;
  SAC_RETURN_IF_ERROR(ogawa_.ReadGroup(group, children));
  if (children.empty()) return Status::Ok();
  SAC_RETURN_IF_ERROR(ReadCompound(children.front(), 0, object.properties));
  if (children.size() == 1) return Status::Ok();
  std::string bytes;
  SAC_RETURN_IF_ERROR(ogawa_.ReadStructure(children.back(), bytes));
  if (bytes.size() < kHashBytes) return CutShort();
  HeaderBytes header(std::string_view(bytes).substr(0, bytes.size() - kHashBytes));
  for (std::size_t i = 1; i + 1 < children.size(); ++i) {
    AlembicObject& child = object.children.emplace_back();
    child.name = header.Text(header.Number(4));
    SAC_RETURN_IF_ERROR(TakeMetadata(header.Number(1), 4, indexed_metadata_, header, child.metadata));
    if (!header.ok()) return CutShort();
    SAC_RETURN_IF_ERROR(ReadObject(children[i], depth + 1, child));
  }
  return header.empty() ? Status::Ok() : Status::Corrupt("headers of more objects than there are");
}

Status AlembicArchive::Open(RandomAccess bytes, AlembicArchive& archive) {
  archive = {};
  OgawaReader& ogawa = archive.ogawa_;
  SAC_RETURN_IF_ERROR(OgawaReader::Open(std::move(bytes), ogawa));
  std::vector<OgawaRef> root;
  SAC_RETURN_IF_ERROR(ogawa.ReadGroup(ogawa.root(), root));
  if (root.size() < 6) return Status::Corrupt("an Ogawa file, but not of Alembic");
  std::string text;
  SAC_RETURN_IF_ERROR(ogawa.ReadStructure(root[0], text));
  if (text.size() != 4) return Status::Corrupt("an Ogawa file, but not of Alembic");
  if (const std::uint32_t version = LoadLittle32(text.data()); version != 0) {
    return Status::Unsupported("version " + std::to_string(version) + " of Alembic's layout");
  }
  SAC_RETURN_IF_ERROR(ogawa.ReadStructure(root[3], archive.metadata_));
  SAC_RETURN_IF_ERROR(ogawa.ReadStructure(root[4], text));
  SAC_RETURN_IF_ERROR(ParseAlembicTimes(text, archive.time_samplings_));
  SAC_RETURN_IF_ERROR(ogawa.ReadStructure(root[5], text));
  SAC_RETURN_IF_ERROR(ParseIndexedMetadata(text, archive.indexed_metadata_));
  return archive.ReadObject(root[2], 0, archive.top_);
}

}  // namespace sac
