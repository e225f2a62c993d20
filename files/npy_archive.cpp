// SPDX-License-Identifier: Apache-2.0
#include "files/npy_archive.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <regex>
#include <string_view>
#include <utility>

namespace sac {
namespace {

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);  // version 1.0
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostDimensions = 8;
constexpr std::array<std::string_view, 4> kTypes{"<f4", "<f8", "<u4", "|u1"};

std::uint64_t SizeOfType(std::string_view type) { return static_cast<std::uint64_t>(type[2] - '0'); }

std::string FormatNpy(const NpyArray& array) {
  std::string shape;
  for (const std::uint64_t n : array.shape) shape += std::to_string(n) + ", ";
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  std::string header = "{'descr': '" + array.type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  const std::size_t used = kMagic.size() + 2 + header.size() + 1;
  header.append((kAlignment - used % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string out(kMagic);
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  return out + header + array.bytes;
}

// What is wrong with the .npy file `bytes`; empty where it became `array`.
std::string ParseNpy(const std::string& bytes, NpyArray& array) {
  if (bytes.size() < 10 || bytes.compare(0, 6, kMagic.substr(0, 6)) != 0) return "no array of numpy";
  const auto at = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
  const std::size_t major = at(6), begin = major == 1 ? 10 : 12;
  if (bytes.size() < begin || major < 1 || major > 3) return "an array of an unknown version";
  const std::size_t length = major == 1 ? at(8) | at(9) << 8 : at(8) | at(9) << 8 | at(10) << 16 | at(11) << 24;
  if (length > bytes.size() - begin) return "an array that is cut short";
  const std::string header = bytes.substr(begin, length);
  std::smatch found;
  if (!std::regex_search(header, found, std::regex("'descr': *'([^']*)'"))) return "an array without a type";
  array.type = found[1];
  if (std::find(kTypes.begin(), kTypes.end(), array.type) == kTypes.end()) {
    return "an array of the type " + array.type + ", not <f4, <f8, <u4 or |u1";
  }
  if (!std::regex_search(header, std::regex("'fortran_order': *False"))) return "an array in Fortran's order";
  if (!std::regex_search(header, found, std::regex("'shape': *\\(([0-9, ]*)\\)"))) return "an array without a shape";
  const std::string shape = found[1];
  array.shape.clear();
  std::uint64_t size = SizeOfType(array.type);
  const std::regex number("[0-9]+");
  for (std::sregex_iterator it(shape.begin(), shape.end(), number), end; it != end; ++it) {
    const std::string digits = it->str();
    if (digits.size() > 18 || array.shape.size() == kMostDimensions) return "an array of an impossible shape";
    array.shape.push_back(std::stoull(digits));
    const std::uint64_t n = array.shape.back();
    if (n > 0 && size > std::numeric_limits<std::uint64_t>::max() / n) return "an array of an impossible shape";
    size *= n;
  }
  if (size != bytes.size() - begin - length) return "an array whose size is not that of its shape";
  array.bytes = bytes.substr(begin + length);
  return {};
}

struct CloseZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

// Adds all arrays to `zip`, whose data must live until it is closed.
bool AddArrays(zip_t* zip, const std::map<std::string, std::string>& files) {
  for (const auto& [name, data] : files) {
    zip_source_t* source = zip_source_buffer(zip, data.data(), data.size(), 0);
    if (source == nullptr) return false;
    const zip_int64_t index = zip_file_add(zip, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      return false;
    }
    const auto i = static_cast<zip_uint64_t>(index);
    // Of the year 1980, where zip's calendar begins: bytes must not depend on the clock.
    zip_file_set_dostime(zip, i, 0, (1 << 5) | 1, 0);
    zip_set_file_compression(zip, i, ZIP_CM_DEFLATE, 6);
  }
  return true;
}

Status ReadArray(zip_t* zip, zip_uint64_t index, const std::string& path, std::uint64_t& left, NpyArchive& archive) {
  zip_stat_t stat;
  zip_stat_init(&stat);
  const auto corrupt = [&](const std::string& what) { return Status::Corrupt(path + ": " + what); };
  if (zip_stat_index(zip, index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0 ||
      (stat.valid & ZIP_STAT_NAME) == 0) {
    return corrupt("a damaged zip file");
  }
  const std::string name = stat.name;
  if (!name.ends_with(".npy")) return Status::Ok();  // not ours
  if (stat.size > left) return Status::Limit(path + ": " + name + " holds more than is allowed");
  left -= stat.size;
  const std::unique_ptr<zip_file_t, CloseFile> file(zip_fopen_index(zip, index, 0));
  std::string bytes(stat.size, '\0');
  if (!file || zip_fread(file.get(), bytes.data(), stat.size) != static_cast<zip_int64_t>(stat.size)) {
    return corrupt(name + " is damaged");
  }
  NpyArray array;
  const std::string fault = ParseNpy(bytes, array);
  if (!fault.empty()) return corrupt(name + " is " + fault);
  archive[name.substr(0, name.size() - 4)] = std::move(array);
  return Status::Ok();
}

}  // namespace

Status FormatNpz(const NpyArchive& archive, std::string& bytes) {
  std::map<std::string, std::string> files;
  for (const auto& [name, array] : archive) files[name + ".npy"] = FormatNpy(array);
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
  if (target == nullptr) return Status::Limit("not enough memory for an archive");
  zip_source_keep(target);  // beyond the archive's closing, to read what was written
  const auto free_source = [](zip_source_t* source) { zip_source_free(source); };
  const std::unique_ptr<zip_source_t, decltype(free_source)> held(target, free_source);
  zip_t* zip = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  if (zip == nullptr) return Status::Limit("the archive cannot be made");
  if (!AddArrays(zip, files) || zip_close(zip) != 0) {
    const std::string what = zip_strerror(zip);
    zip_discard(zip);
    return Status::Limit("the archive cannot be made: " + what);
  }
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_source_open(target) != 0 || zip_source_stat(target, &stat) != 0) {
    return Status::Limit("the archive cannot be made");
  }
  bytes.resize(stat.size);
  const zip_int64_t read = zip_source_read(target, bytes.data(), bytes.size());
  zip_source_close(target);
  return read == static_cast<zip_int64_t>(bytes.size()) ? Status::Ok() : Status::Limit("the archive cannot be made");
}

Status ReadNpz(const std::string& path, std::uint64_t most_bytes, NpyArchive& archive) {
  archive.clear();
  if (!std::ifstream(path)) return Status::IoError(path + ": " + std::strerror(errno));
  int code = 0;
  const std::unique_ptr<zip_t, CloseZip> zip(zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code));
  if (!zip) return Status::Corrupt(path + ": no .npz archive");
  const zip_int64_t count = zip_get_num_entries(zip.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    SAC_RETURN_IF_ERROR(ReadArray(zip.get(), static_cast<zip_uint64_t>(i), path, most_bytes, archive));
  }
  return Status::Ok();
}

}  // namespace sac
