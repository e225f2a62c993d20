// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/alembic/alembic_time.h"
#include "files/alembic/ogawa_reader.h"
#include "sac/status.h"

namespace sac {

// The types of numbers, as Alembic counts them.
enum class AlembicPod : std::uint8_t {
  kBool = 0,
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat16,
  kFloat32,
  kFloat64,
  kString,
  kWideString,
};

// The size in bytes of a number, 0 for strings.
std::size_t SizeOf(AlembicPod pod);

// A property: a compound of others, or samples of numbers, of which those that repeat the one before may be stored
// once.
struct AlembicProperty {
  enum class Kind { kCompound, kScalar, kArray };

  std::string name, metadata;  // metadata: "key=value;key=value"
  Kind kind = Kind::kCompound;
  OgawaRef group;

  std::vector<AlembicProperty> properties;  // of a compound

  // Of samples.
  AlembicPod pod = AlembicPod::kBool;
  std::uint32_t extent = 1;   // numbers in an element, as 3 of a position
  std::uint32_t samples = 0;  // also those that repeat others
  std::uint32_t first_changed = 0, last_changed = 0;
  std::uint32_t time_sampling = 0;  // index of AlembicArchive::time_samplings()

  // Where among the stored samples sample `index` is.
  std::uint32_t Stored(std::uint32_t index) const;
  // Whether all samples are one.
  bool constant() const { return samples <= 1 || last_changed == 0; }

  // The property of this name in a compound; null where there is none.
  const AlembicProperty* Find(std::string_view wanted) const;
};

// An object of the scene.
struct AlembicObject {
  std::string name, metadata;
  AlembicProperty properties;  // a compound
  std::vector<AlembicObject> children;

  // Its schema without the version, such as "AbcGeom_PolyMesh"; empty where it has none.
  std::string_view schema() const;
};

// The value of `key` in metadata, empty where there is none.
std::string_view MetadataValue(std::string_view metadata, std::string_view key);

// The objects and properties of an Alembic archive in Ogawa's container. Samples are read when they are asked for
// (files/alembic/alembic_samples.h).
//
//   root group: data i32 version of Alembic's layout (0); data i32 version of Alembic; group of the top object; data
//     metadata; data time samplings; data metadata that headers name by index
//   object: group of its properties; a group for each child; data with the children's headers and 32 bytes of hashes
//   compound: a group for each property; data with their headers
//   samples: data for each; an array has two of them, numbers and dimensions. Numbers come after 16 bytes of a hash.
//
// Facts: Alembic's sources, lib/Alembic/AbcCoreOgawa. Depth, counts and sizes are bounded by constants and by the size
// of the file (OgawaReader). Messages do not name the file.
class AlembicArchive {
 public:
  // kCorrupt, kUnsupported, kLimit: as OgawaReader::Open, and a tree that breaks the rules above.
  static Status Open(RandomAccess bytes, AlembicArchive& archive);

  OgawaReader& ogawa() { return ogawa_; }
  const std::vector<AlembicTimeSampling>& time_samplings() const { return time_samplings_; }
  const AlembicObject& top() const { return top_; }
  // That of the whole archive, such as the program that wrote it.
  const std::string& metadata() const { return metadata_; }

 private:
  Status ReadCompound(OgawaRef group, int depth, AlembicProperty& compound);
  Status ReadObject(OgawaRef group, int depth, AlembicObject& object);

  OgawaReader ogawa_;
  std::vector<AlembicTimeSampling> time_samplings_;
  std::vector<std::string> indexed_metadata_;
  std::string metadata_;
  AlembicObject top_;
};

}  // namespace sac
