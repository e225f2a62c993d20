// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// The bytes of a .sac stream from a file or, named `-`, from standard input, in chunks as they come.
class StreamInput {
 public:
  StreamInput() = default;
  ~StreamInput();
  StreamInput(const StreamInput&) = delete;
  StreamInput& operator=(const StreamInput&) = delete;

  Status Open(const std::string& path);

  // The next bytes, which stay until the next call; none at the end.
  Status Read(std::span<const std::uint8_t>& chunk);

  // For messages.
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  int fd_ = -1;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace sac
