// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "codec/encode/encoded_start.h"
#include "codec/encode/group_encoder.h"
#include "codec/encode/projection.h"
#include "format/frame_coder.h"
#include "format/group.h"
#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A closed group, from its frames to its bytes.
struct ClosedGroup {
  GroupSyntax syntax;             // but for what the writer sets
  std::vector<Positions> frames;  // by time, in decoded vertex order, model units; none once it is coded
  bool goes_on = false;           // another group may follow, see GroupEncoder::Encode()
  std::vector<std::vector<std::uint8_t>> codes = {};  // of the packet of the group and of its layers
  FrameBits bits = {};
  Status status = {};
  // After kInvalidArgument: which frame of the group, by time, and which decoded vertex is at fault.
  std::uint32_t failed_frame = 0;
  std::optional<std::uint32_t> failed_vertex = {};
};

// How many threads `settings` want; at least 1.
unsigned ThreadsOf(const EncoderSettings& settings);

// Closed groups of one segment that wait to be coded at the same time, each by one thread. What becomes of a group
// depends neither on the others nor on the number of threads.
class GroupWindow {
 public:
  // `start`, `projection`, which is that of start.shape, and `settings` must outlive it.
  GroupWindow(const EncodedStart& start, const Projection& projection, const EncoderSettings& settings);

  // Adds a group that has as many frames as a group may have, or with `goes_on` false any number: the segment's last.
  void Add(std::vector<Positions> frames, bool goes_on);
  bool empty() const { return groups_.empty(); }
  std::size_t size() const { return groups_.size(); }
  // Whether there are as many groups as should be coded at the same time: one for each thread, but no more than memory
  // is meant for.
  bool IsFull() const { return groups_.size() >= capacity_; }

  // Codes all groups and takes them out, each with a status of its own; after the first that failed, the others are
  // not coded. `progress` is called on this thread with the number of frames coded, between frames as far as the thread
  // codes some itself and at the end; after false the groups that are not complete are kCancelled.
  // kInvalidArgument when settings.run_jobs throws or leaves a job out, and no group is coded then.
  Status Encode(const std::function<bool(std::uint32_t)>& progress, std::vector<ClosedGroup>& groups);

 private:
  struct Run;
  // Codes groups of `run`, one after another, until none is left.
  void EncodeSome(Run& run, std::size_t job);
  Status EncodeGroup(Run& run, std::size_t index, GroupEncoder& encoder);

  const EncodedStart& start_;
  const Projection& projection_;
  const EncoderSettings& settings_;
  std::size_t capacity_;
  std::vector<std::unique_ptr<GroupEncoder>> encoders_;  // of each thread, made when it first has a group
  std::vector<ClosedGroup> groups_;
};

}  // namespace sac
