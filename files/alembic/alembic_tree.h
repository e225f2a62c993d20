// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/alembic/alembic_archive.h"
#include "files/alembic/ogawa_writer.h"
#include "sac/status.h"

namespace sac {

// The samples of a property as they are written: each at once, those that repeat the one before only as a reference.
class AlembicSampleList {
 public:
  // `numbers`: the bytes of the sample's numbers, little endian.
  Status Write(OgawaWriter& file, std::string_view numbers);

  std::uint32_t size() const { return static_cast<std::uint32_t>(refs_.size()); }
  // The first and the last sample that is not the one before; both 0 where all are one.
  std::uint32_t first_changed() const { return first_changed_; }
  std::uint32_t last_changed() const { return last_changed_; }
  // The samples to store: the first alone, or from the one before the first changed to the last changed.
  std::vector<OgawaRef> Stored() const;
  // A hash of all that was written.
  std::uint64_t hash() const { return hash_; }

 private:
  std::vector<OgawaRef> refs_;
  std::string last_hash_;
  std::uint32_t first_changed_ = 0, last_changed_ = 0;
  std::uint64_t hash_ = 0;
};

// A property to write: the header as AlembicArchive reads it, and the samples, or the properties of a compound.
struct AlembicPropertyTree {
  std::string name, metadata;
  AlembicProperty::Kind kind = AlembicProperty::Kind::kCompound;
  AlembicPod pod = AlembicPod::kBool;
  std::uint32_t extent = 1, time_sampling = 0;
  const AlembicSampleList* samples = nullptr;
  std::vector<AlembicPropertyTree> properties = {};
};

// An object to write.
struct AlembicObjectTree {
  std::string name, metadata;
  AlembicPropertyTree properties = {};
  std::vector<AlembicObjectTree> children = {};
};

// Writes groups and headers of an archive whose samples have been written, and the archive's root. `samplings` is the
// list of time samplings as it stands in the file. Metadata have at most 254 bytes, and there are at most 250 of them.
Status WriteAlembicTree(OgawaWriter& file, const AlembicObjectTree& top, const std::string& metadata,
                        const std::string& samplings);

}  // namespace sac
