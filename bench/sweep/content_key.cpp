// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/content_key.h"

#include <xxhash.h>

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <new>
#include <span>

#include "files/stream_input.h"

namespace sac {

ContentKey::ContentKey() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  (void)XXH3_128bits_reset(state_);
}

ContentKey::~ContentKey() { (void)XXH3_freeState(state_); }

void ContentKey::Add(const void* bytes, std::size_t size) { (void)XXH3_128bits_update(state_, bytes, size); }

void ContentKey::Add(const std::string& text) {
  const std::uint64_t size = text.size();
  Add(&size, sizeof size);
  Add(text.data(), text.size());
}

std::string ContentKey::Text() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_);
  char text[33];
  std::snprintf(text, sizeof text, "%016" PRIx64 "%016" PRIx64, hash.high64, hash.low64);
  return text;
}

Status KeyOfFile(const std::string& path, std::string& key) {
  StreamInput file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  ContentKey hash;
  std::span<const std::uint8_t> chunk;
  do {
    SAC_RETURN_IF_ERROR(file.Read(chunk));
    hash.Add(chunk.data(), chunk.size());
  } while (!chunk.empty());
  key = hash.Text();
  return Status::Ok();
}

}  // namespace sac
