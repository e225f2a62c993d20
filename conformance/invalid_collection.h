// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/invalid_vectors.h"
#include "conformance/stream_parts.h"

namespace sac {

// A list of malformed streams. Each member function adds one stream that breaks `rule` of spec.md 11, with the file
// name RULE_NAME and the status that a decoder must return.
struct Collection {
  void Add(const char* rule, const char* name, Bytes stream, const char* status = "corrupt");

  // Adds SmallStream() after `change` has changed its parts.
  void Change(const char* rule, const char* name, const std::function<void(StreamParts&)>& change,
              const char* status = "corrupt");

  // Adds SmallStream() after `change` has changed its packets: their payloads, order or number.
  void ChangePackets(const char* rule, const char* name,
                     const std::function<void(std::vector<std::pair<PacketType, Bytes>>&)>& change);

  // Adds SmallStream() with a group of `frames` frames that `fill` makes (see CodeGroup()).
  void ChangeGroup(const char* rule, const char* name, std::uint32_t frames, std::uint32_t pyramid,
                   const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint8_t reference_shape = 0,
                   const char* status = "corrupt");

  std::vector<InvalidVector> vectors;
};

// Each of these adds the malformed streams of one subject. They are called in the order of the manifest.
void AddPackets(Collection& c);
void AddRecords(Collection& c);
void AddHeader(Collection& c);
void AddIFrame(Collection& c);
void AddDraco(Collection& c);
void AddGroups(Collection& c);

}  // namespace sac
