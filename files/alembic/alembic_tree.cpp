// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <utility>

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr std::uint32_t kLayoutVersion = 0;
// The layout is that of this version of Alembic, 1.7.5.
constexpr std::uint32_t kAlembicVersion = 10705;

using Hash = std::array<std::uint64_t, 2>;

// 128 bits that differ for other bytes. Readers compare them, and none derives them anew, so any hash will do.
Hash HashOf(std::string_view bytes) {
  Hash hash = {0x9E3779B97F4A7C15U ^ bytes.size(), 0xC2B2AE3D27D4EB4FU + bytes.size()};
  const auto mix = [&hash](std::uint64_t word) {
    hash[0] = std::rotl((hash[0] ^ word) * 0x9FB21C651E98DF25U, 29) + hash[1];
    hash[1] = std::rotl((hash[1] + word) * 0xD6E8FEB86659FD93U, 33) ^ hash[0];
  };
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) mix(LoadLittle64(bytes.data() + at));
  char rest[8] = {};
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), rest);
  mix(LoadLittle64(rest));
  mix(hash[0] >> 32);
  mix(hash[1] >> 32);
  return hash;
}

void Append(std::uint64_t value, std::size_t size, std::string& bytes) {
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::string BytesOf(const Hash& hash) {
  std::string bytes;
  Append(hash[0], 8, bytes);
  Append(hash[1], 8, bytes);
  return bytes;
}

class TreeWriter {
 public:
  explicit TreeWriter(OgawaWriter& file) : file_(file) {}

  Status WriteObject(const AlembicObjectTree& object, OgawaRef& ref, Hash& hash) {
    std::vector<OgawaRef> children(1);
    std::string headers, of_children = object.name;
    Hash own{};
    SAC_RETURN_IF_ERROR(WriteCompound(object.properties, children[0], own));
    for (const AlembicObjectTree& child : object.children) {
      Hash below{};
      SAC_RETURN_IF_ERROR(WriteObject(child, children.emplace_back(), below));
      of_children += BytesOf(below);
      Append(child.name.size(), 4, headers);
      headers += child.name;
      Append(Index(child.metadata), 1, headers);
    }
    hash = HashOf(of_children + BytesOf(own));
    headers += BytesOf(own) + BytesOf(HashOf(of_children));
    SAC_RETURN_IF_ERROR(file_.WriteData(headers, children.emplace_back()));
    return file_.WriteGroup(children, ref);
  }

  // The list of metadata that headers name by index.
  std::string IndexedMetadata() const {
    std::string bytes;
    for (std::size_t i = 1; i < metadata_.size(); ++i) {
      Append(metadata_[i].size(), 1, bytes);
      bytes += metadata_[i];
    }
    return bytes;
  }

 private:
  std::uint32_t Index(const std::string& metadata) {
    const auto found = std::find(metadata_.begin(), metadata_.end(), metadata);
    const auto index = static_cast<std::uint32_t>(found - metadata_.begin());
    if (found == metadata_.end()) metadata_.push_back(metadata);
    assert(index < 0xFF && metadata.size() < 0xFF);
    return index;
  }

  void AppendHeader(const AlembicPropertyTree& property, std::string& headers) {
    using Kind = AlembicProperty::Kind;
    const bool compound = property.kind == Kind::kCompound;
    const std::uint32_t samples = compound ? 0 : property.samples->size();
    const std::size_t largest = std::max<std::size_t>({property.name.size(), samples, property.time_sampling});
    const std::uint32_t size_code = largest < 1 << 8 ? 0 : largest < 1 << 16 ? 1 : 2;
    const std::size_t size = std::size_t{1} << size_code;
    std::uint32_t flags = size_code << 2 | Index(property.metadata) << 20;
    std::string numbers;
    if (!compound) {
      flags |= property.kind == Kind::kScalar ? 1 : 2;
      flags |= static_cast<std::uint32_t>(property.pod) << 4 | property.extent << 12;
      flags |= 0x400;  // all samples have as many numbers
      Append(samples, size, numbers);
      const std::uint32_t first = property.samples->first_changed(), last = property.samples->last_changed();
      if (last == 0) {
        flags |= 0x800;
      } else if (first != 1 || last != samples - 1) {
        flags |= 0x200;
        Append(first, size, numbers);
        Append(last, size, numbers);
      }
      if (property.time_sampling != 0) {
        flags |= 0x100;
        Append(property.time_sampling, size, numbers);
      }
    }
    Append(flags, 4, headers);
    headers += numbers;
    Append(property.name.size(), size, headers);
    headers += property.name;
  }

  Status WriteCompound(const AlembicPropertyTree& compound, OgawaRef& ref, Hash& hash) {
    std::vector<OgawaRef> children;
    std::string headers, contents = compound.name;
    for (const AlembicPropertyTree& property : compound.properties) {
      if (property.kind == AlembicProperty::Kind::kCompound) {
        Hash below{};
        SAC_RETURN_IF_ERROR(WriteCompound(property, children.emplace_back(), below));
        contents += BytesOf(below);
      } else {
        std::vector<OgawaRef> samples;
        for (const OgawaRef sample : property.samples->Stored()) {
          samples.push_back(sample);
          // The dimensions of an array of one dimension are left empty.
          if (property.kind == AlembicProperty::Kind::kArray) samples.push_back({std::uint64_t{1} << 63});
        }
        SAC_RETURN_IF_ERROR(file_.WriteGroup(samples, children.emplace_back()));
        Append(property.samples->hash(), 8, contents);
      }
      AppendHeader(property, headers);
    }
    hash = HashOf(contents + headers);
    if (!children.empty()) SAC_RETURN_IF_ERROR(file_.WriteData(headers, children.emplace_back()));
    return file_.WriteGroup(children, ref);
  }

  OgawaWriter& file_;
  std::vector<std::string> metadata_ = {""};
};

}  // namespace

Status AlembicSampleList::Write(OgawaWriter& file, std::string_view numbers) {
  const std::string hash = BytesOf(HashOf(numbers));
  if (!refs_.empty() && hash == last_hash_) {
    refs_.push_back(refs_.back());
  } else {
    std::string bytes = hash;
    bytes += numbers;
    OgawaRef ref;
    SAC_RETURN_IF_ERROR(file.WriteData(numbers.empty() ? std::string_view() : bytes, ref));
    if (!refs_.empty()) {
      last_changed_ = size();
      if (first_changed_ == 0) first_changed_ = last_changed_;
    }
    refs_.push_back(ref);
  }
  last_hash_ = hash;
  hash_ = HashOf(hash + std::to_string(hash_))[0];
  return Status::Ok();
}

std::vector<OgawaRef> AlembicSampleList::Stored() const {
  if (refs_.empty()) return {};
  if (last_changed_ == 0) return {refs_.front()};
  return {refs_.begin() + first_changed_ - 1, refs_.begin() + last_changed_ + 1};
}

Status WriteAlembicTree(OgawaWriter& file, const AlembicObjectTree& top, const std::string& metadata,
                        const std::string& samplings) {
  TreeWriter tree(file);
  std::vector<OgawaRef> root(6);
  std::string version;
  Append(kLayoutVersion, 4, version);
  SAC_RETURN_IF_ERROR(file.WriteData(version, root[0]));
  version.clear();
  Append(kAlembicVersion, 4, version);
  SAC_RETURN_IF_ERROR(file.WriteData(version, root[1]));
  Hash ignored{};
  SAC_RETURN_IF_ERROR(tree.WriteObject(top, root[2], ignored));
  SAC_RETURN_IF_ERROR(file.WriteData(metadata, root[3]));
  SAC_RETURN_IF_ERROR(file.WriteData(samplings, root[4]));
  SAC_RETURN_IF_ERROR(file.WriteData(tree.IndexedMetadata(), root[5]));
  OgawaRef ref;
  SAC_RETURN_IF_ERROR(file.WriteGroup(root, ref));
  return file.Finish(ref);
}

}  // namespace sac
