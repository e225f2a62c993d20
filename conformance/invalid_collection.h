// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/invalid_vectors.h"
#include "conformance/stream_parts.h"

namespace sac {

// The malformed streams so far. Each function adds one stream that breaks `rule` of spec.md 11, under the name
// RULE_NAME, and `status` is what a decoder answers.
struct Collection {
  void Add(const char* rule, const char* name, Bytes stream, const char* status = "corrupt");

  // Adds the small stream with its parts changed.
  void Change(const char* rule, const char* name, const std::function<void(StreamParts&)>& change,
              const char* status = "corrupt");

  // Adds the small stream with its packets changed: their payloads, or their order and number.
  void ChangePackets(const char* rule, const char* name,
                     const std::function<void(std::vector<std::pair<PacketType, Bytes>>&)>& change);

  // Adds the small stream with a group of `frames` frames that `fill` makes (CodeGroup()).
  void ChangeGroup(const char* rule, const char* name, std::uint32_t frames, std::uint32_t pyramid,
                   const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint8_t reference_shape = 0,
                   const char* status = "corrupt");

  std::vector<InvalidVector> vectors;
};

// The streams by subject, in the order of the manifest.
void AddPackets(Collection& c);
void AddRecords(Collection& c);
void AddHeader(Collection& c);
void AddIFrame(Collection& c);
void AddDraco(Collection& c);
void AddGroups(Collection& c);

}  // namespace sac
