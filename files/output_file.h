// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "sac/status.h"

namespace sac {

// A file that appears under its name only when it is whole: bytes go to a temporary file in the same directory, which
// Commit renames and the destructor otherwise removes. Devices, pipes and `-` (standard output) cannot be renamed onto;
// they are written through, unbuffered, and Commit only closes them. Errors are kIoError and name the file.
class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;

  // Opens `path` for writing; `-` is standard output. Fails when the directory is missing or not writable, or when
  // `path` is a directory or a file that may not be written. Not to be called twice.
  Status Open(const std::string& path);

  // Appends `size` bytes.
  Status Write(const void* data, std::size_t size);
  Status Write(const std::string& bytes) { return Write(bytes.data(), bytes.size()); }

  // Overwrite or read back `size` bytes at `offset`, counted in bytes from the start of the file; only if seekable().
  Status WriteAt(std::uint64_t offset, const void* data, std::size_t size);
  Status ReadAt(std::uint64_t offset, void* data, std::size_t size);
  bool seekable() const { return !temporary_.empty(); }

  // Flushes, syncs and closes, so that a full disk is noticed and the descriptor is free; the file still has its
  // temporary name. Nothing can be written afterwards. Does nothing the second time.
  Status Close();

  // Close, then the rename. Nothing stands under `path` before this succeeds.
  Status Commit();

  const std::string& path() const { return path_; }

 private:
  Status Flush();
  Status WriteThrough(const char* bytes, std::size_t size);
  Status Error(int error) const;
  void Remove();

  std::string path_;       // as given, for messages
  std::string final_;      // with symbolic links resolved
  std::string temporary_;  // empty when written through
  std::string buffer_;
  int fd_ = -1;
};

}  // namespace sac
