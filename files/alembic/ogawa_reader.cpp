// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/ogawa_reader.h"

#include <cstring>
#include <string_view>
#include <utility>

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr std::size_t kHeaderBytes = 16;
constexpr std::string_view kMagic = "Ogawa", kHdf5Magic = "\x89HDF\r\n\x1a\n";

}  // namespace

Status OgawaReader::Open(RandomAccess bytes, OgawaReader& reader) {
  reader = {};
  reader.bytes_ = std::move(bytes);
  char header[kHeaderBytes] = {};
  const std::size_t size = reader.size() < kHeaderBytes ? static_cast<std::size_t>(reader.size()) : kHeaderBytes;
  SAC_RETURN_IF_ERROR(reader.bytes_.ReadAt(0, header, size));
  const std::string_view text(header, size);
  if (size == 0) return Status::InvalidArgument("the file is empty");
  if (text.starts_with(kHdf5Magic)) {
    return Status::Unsupported(
        "Alembic in HDF5, the older of its two forms; convert it to Ogawa with Alembic's own program: "
        "abcconvert -toOgawa OLD.abc NEW.abc");
  }
  if (!text.starts_with(kMagic)) return Status::Corrupt("not an Alembic file");
  if (size < kHeaderBytes) return Status::Corrupt("truncated in the header");
  if (header[5] != '\xFF') return Status::Corrupt("the program that wrote it did not finish it");
  if (header[6] != 0 || header[7] != 1) {
    return Status::Unsupported("Ogawa version " + std::to_string(static_cast<unsigned char>(header[6]) << 8 |
                                                                 static_cast<unsigned char>(header[7])));
  }
  reader.root_.bits = LoadLittle64(header + 8);
  return Status::Ok();
}

Status OgawaReader::ReadU64(std::uint64_t offset, std::uint64_t& value) const {
  if (offset > size() || size() - offset < 8) return Status::Corrupt("truncated, or an offset beyond its end");
  char bytes[8];
  SAC_RETURN_IF_ERROR(bytes_.ReadAt(offset, bytes, sizeof bytes));
  value = LoadLittle64(bytes);
  return Status::Ok();
}

Status OgawaReader::Spend(std::uint64_t bytes, std::uint64_t most, std::uint64_t& spent) const {
  spent += bytes;  // at most the size of the file each time
  return spent > most ? Status::Corrupt("groups that overlap or contain themselves") : Status::Ok();
}

Status OgawaReader::ReadGroup(OgawaRef ref, std::vector<OgawaRef>& children) {
  children.clear();
  if (ref.is_data()) return Status::Corrupt("data in place of a group");
  if (ref.offset() == 0) return Status::Ok();
  std::uint64_t count = 0;
  SAC_RETURN_IF_ERROR(ReadU64(ref.offset(), count));
  const std::uint64_t first = ref.offset() + 8;
  if (count > (size() - first) / 8) return Status::Corrupt("a group of more children than the file can have");
  SAC_RETURN_IF_ERROR(Spend(8 + 8 * count, size(), group_bytes_));
  std::string bytes(static_cast<std::size_t>(8 * count), '\0');
  SAC_RETURN_IF_ERROR(bytes_.ReadAt(first, bytes.data(), bytes.size()));
  children.reserve(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < bytes.size(); i += 8) children.push_back({LoadLittle64(bytes.data() + i)});
  return Status::Ok();
}

Status OgawaReader::DataSize(OgawaRef ref, std::uint64_t& bytes) const {
  bytes = 0;
  if (!ref.is_data()) return Status::Corrupt("a group in place of data");
  if (ref.offset() == 0) return Status::Ok();
  SAC_RETURN_IF_ERROR(ReadU64(ref.offset(), bytes));
  if (bytes > size() - ref.offset() - 8) return Status::Corrupt("data beyond its end; is it truncated?");
  return Status::Ok();
}

Status OgawaReader::ReadStructure(OgawaRef ref, std::string& bytes) {
  std::uint64_t data = 0;
  SAC_RETURN_IF_ERROR(DataSize(ref, data));
  // Programs may let equal headers be one.
  SAC_RETURN_IF_ERROR(Spend(data, 4 * size(), structure_bytes_));
  bytes.resize(static_cast<std::size_t>(data));
  return ReadData(ref, 0, bytes.data(), bytes.size());
}

Status OgawaReader::ReadData(OgawaRef ref, std::uint64_t begin, void* bytes, std::size_t count) const {
  std::uint64_t data = 0;
  SAC_RETURN_IF_ERROR(DataSize(ref, data));
  if (begin > data || count > data - begin) return Status::Corrupt("data that are too short");
  if (count == 0) return Status::Ok();
  return bytes_.ReadAt(ref.offset() + 8 + begin, bytes, count);
}

}  // namespace sac
