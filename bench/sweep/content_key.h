// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sac/status.h"

struct XXH3_state_s;

namespace sac {

// A key for content: 32 hexadecimal digits of the hash XXH3, which is not safe against deliberate collisions.
class ContentKey {
 public:
  ContentKey();
  ~ContentKey();
  ContentKey(const ContentKey&) = delete;
  ContentKey& operator=(const ContentKey&) = delete;

  void Add(const void* bytes, std::size_t size);
  // Adds a text. Two texts give another key than their concatenation.
  void Add(const std::string& text);
  std::string Text() const;

 private:
  XXH3_state_s* state_;
};

// Computes the key of a file's bytes. Returns kIoError, naming the file, when it cannot be read.
Status KeyOfFile(const std::string& path, std::string& key);

}  // namespace sac
