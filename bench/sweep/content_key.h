// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sac/status.h"

struct XXH3_state_s;

namespace sac {

// A name for content: 32 hexadecimal digits of XXH3, which tell what differs by accident, not by malice.
class ContentKey {
 public:
  ContentKey();
  ~ContentKey();
  ContentKey(const ContentKey&) = delete;
  ContentKey& operator=(const ContentKey&) = delete;

  void Add(const void* bytes, std::size_t size);
  // Two texts are not one text.
  void Add(const std::string& text);
  std::string Text() const;

 private:
  XXH3_state_s* state_;
};

// The key of a file's bytes. kIoError names it.
Status KeyOfFile(const std::string& path, std::string& key);

}  // namespace sac
