// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "sac/status.h"

namespace sac {

// The extension of a file's name with its point, in small letters.
inline std::string Extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// Runs `step`, which returns a Status whose message does not name the file, puts the path before the message, and lets
// no exception out.
template <typename Step>
Status Named(const std::string& path, Step step) {
  Status status;
  try {
    status = step();
  } catch (const std::bad_alloc&) {
    status = Status::Limit("not enough memory");
  } catch (const std::exception& e) {
    status = Status::Corrupt(e.what());
  }
  return status.ok() ? status : Status(status.code(), path + ": " + status.message());
}

}  // namespace sac
