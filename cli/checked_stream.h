// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "files/output_file.h"
#include "sac/decoder.h"
#include "sac/status.h"

namespace sac {

// A stream that is written, and decoded as it is written. It appears under its name only when all of it decodes.
class CheckedStream {
 public:
  // With `check` false nothing is decoded. `frame_done` gets the number of frames decoded.
  CheckedStream(bool check, std::function<void(std::uint32_t)> frame_done);

  // Opens the file, `-` for standard output, which is written through.
  Status Open(const std::string& path) { return file_.Open(path); }
  // The next bytes. kCorrupt, and what else a decoder says, where they do not decode; errors of the file as they are.
  Status Write(std::span<const std::uint8_t> bytes);
  // Ends the stream and gives the file its name.
  Status Commit();

  std::uint64_t bytes() const { return bytes_; }

 private:
  bool check_;
  std::function<void(std::uint32_t)> frame_done_;
  OutputFile file_;
  Decoder decoder_;
  DecodedFrame frame_;
  std::uint64_t bytes_ = 0;
};

}  // namespace sac
