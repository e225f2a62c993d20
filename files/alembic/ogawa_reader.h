// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/random_access.h"
#include "sac/status.h"

namespace sac {

// The container of Alembic archives, a tree of groups and data, little endian:
//   file: "Ogawa", a byte 0xFF once the file is whole, version 0x0001 (big endian), u64 offset of the root group
//   group: u64 number of children, and as many u64: the offset of a group, or with the highest bit set that of data;
//          an offset of 0 stands for an empty group or empty data
//   data: u64 size, bytes
// Facts: Alembic's sources, lib/Alembic/Ogawa.

// A child of a group.
struct OgawaRef {
  std::uint64_t bits = 0;

  bool is_data() const { return bits >> 63 != 0; }
  std::uint64_t offset() const { return bits & ~(std::uint64_t{1} << 63); }
  bool operator==(const OgawaRef&) const = default;
};

// Reads groups and data by their references. A hostile file cannot make it read more than a few times its own size of
// structure: no group may be read twice, which excludes circles, and all groups together fit into the file, which
// excludes those that overlap. Messages do not name the file.
class OgawaReader {
 public:
  // Checks the first 16 bytes. kUnsupported: Alembic in HDF5, or another version; kCorrupt: neither, or a file whose
  // program did not close it.
  static Status Open(RandomAccess bytes, OgawaReader& reader);

  OgawaRef root() const { return root_; }
  std::uint64_t size() const { return bytes_.size(); }

  // The children of a group.
  Status ReadGroup(OgawaRef ref, std::vector<OgawaRef>& children);

  // Data that belong to the structure, not to samples; all that are read count together.
  Status ReadStructure(OgawaRef ref, std::string& bytes);

  // The size of data in bytes.
  Status DataSize(OgawaRef ref, std::uint64_t& size) const;

  // `size` bytes of data from `begin` on; kCorrupt where data have fewer.
  Status ReadData(OgawaRef ref, std::uint64_t begin, void* bytes, std::size_t size) const;

 private:
  Status ReadU64(std::uint64_t offset, std::uint64_t& value) const;
  Status Spend(std::uint64_t bytes, std::uint64_t most, std::uint64_t& spent) const;

  RandomAccess bytes_;
  OgawaRef root_;
  std::uint64_t group_bytes_ = 0, structure_bytes_ = 0;  // read so far
};

}  // namespace sac
