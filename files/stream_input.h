// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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

// Appends all of a file, or of standard input, to `out`, a container of bytes. kIoError as StreamInput; kCorrupt, with
// the path and `too_large`, where `out` comes to have more than `most` bytes.
template <class Bytes>
Status ReadToEnd(const std::string& path, Bytes& out, std::size_t most = std::numeric_limits<std::size_t>::max(),
                 const char* too_large = "") {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(path));
  std::span<const std::uint8_t> chunk;
  do {
    SAC_RETURN_IF_ERROR(input.Read(chunk));
    out.insert(out.end(), chunk.begin(), chunk.end());
    if (out.size() > most) return Status::Corrupt(path + ": " + too_large);
  } while (!chunk.empty());
  return Status::Ok();
}

}  // namespace sac
