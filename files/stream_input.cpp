// SPDX-License-Identifier: Apache-2.0
#include "files/stream_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sac {

StreamInput::~StreamInput() {
  if (fd_ >= 0 && fd_ != STDIN_FILENO) close(fd_);
}

Status StreamInput::Open(const std::string& path) {
  buffer_.resize(1 << 16);
  if (path == "-") {
    name_ = "standard input";
    fd_ = STDIN_FILENO;
    return Status::Ok();
  }
  name_ = path;
  fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  return fd_ < 0 ? Status::IoError(name_ + ": " + std::strerror(errno)) : Status::Ok();
}

Status StreamInput::Read(std::span<const std::uint8_t>& chunk) {
  ssize_t size = 0;
  do {
    size = read(fd_, buffer_.data(), buffer_.size());
  } while (size < 0 && errno == EINTR);
  if (size < 0) return Status::IoError(name_ + ": " + std::strerror(errno));
  chunk = std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(size));
  return Status::Ok();
}

}  // namespace sac
