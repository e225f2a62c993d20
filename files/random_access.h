// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "sac/status.h"

namespace sac {

// Bytes that are read where they are wanted: those of a regular file, or of a string in memory. Messages do not name
// the file.
class RandomAccess {
 public:
  RandomAccess() = default;
  explicit RandomAccess(std::string bytes) : bytes_(std::move(bytes)), size_(bytes_.size()) {}
  ~RandomAccess();
  RandomAccess(RandomAccess&& other) noexcept;
  RandomAccess& operator=(RandomAccess&& other) noexcept;

  // kIoError: the file cannot be opened, or is a directory, a device or a pipe.
  Status Open(const std::string& path);

  // In bytes, as it was when the file was opened.
  std::uint64_t size() const { return size_; }

  // kIoError where the file cannot be read or has become shorter; `offset` + `size` is within size().
  Status ReadAt(std::uint64_t offset, void* bytes, std::size_t size) const;

 private:
  std::string bytes_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace sac
