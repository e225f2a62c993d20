// SPDX-License-Identifier: Apache-2.0
#include "files/random_access.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

namespace sac {

RandomAccess::~RandomAccess() {
  if (fd_ >= 0) close(fd_);
}

RandomAccess::RandomAccess(RandomAccess&& other) noexcept { *this = std::move(other); }

RandomAccess& RandomAccess::operator=(RandomAccess&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  return *this;
}

Status RandomAccess::Open(const std::string& path) {
  RandomAccess opened;
  // Not to wait for a writer if it is a pipe, which is then refused.
  opened.fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened.fd_ < 0) return Status::IoError(std::strerror(errno));
  struct stat info {};
  if (fstat(opened.fd_, &info) != 0) return Status::IoError(std::strerror(errno));
  if (S_ISDIR(info.st_mode)) return Status::IoError("is a directory");
  if (!S_ISREG(info.st_mode)) return Status::IoError("not a regular file");
  opened.size_ = static_cast<std::uint64_t>(info.st_size);
  *this = std::move(opened);
  return Status::Ok();
}

Status RandomAccess::ReadAt(std::uint64_t offset, void* bytes, std::size_t size) const {
  assert(offset <= size_ && size <= size_ - offset);
  if (fd_ < 0) {
    if (size > 0) std::memcpy(bytes, bytes_.data() + offset, size);
    return Status::Ok();
  }
  auto* out = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = pread(fd_, out, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Status::IoError(std::strerror(errno));
    if (got == 0) return Status::IoError("became shorter while it was read");
    out += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return Status::Ok();
}

}  // namespace sac
