// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "codec/decode/lost_frames.h"
#include "sac/status.h"

namespace sac {

// Decides for every error that a part of the stream causes whether the decoder stops or passes over that part
// (DecoderSettings::skip_damage), and remembers the frames that are lost with the parts passed over. All parts of the
// decoder share one object.
class DamagePolicy {
 public:
  explicit DamagePolicy(bool skips) : skips_(skips) {}

  // Whether the decoder passes over damage at all.
  bool skips() const { return skips_; }

  // Returns the status that decoding goes on with after a part of the stream gave `status`: ok when that part is passed
  // over, otherwise `status`. Only kCorrupt and kUnsupported are passed over. A part that exceeds a limit, or on which
  // the caller's job system failed, is sound: passing over it would lose frames without damage.
  Status Judge(Status status) const { return PassesOver(status) ? Status::Ok() : status; }

  // Judges the status of a part that holds the frames from `first` to before `end`, which are lost when it is passed
  // over.
  Status Judge(Status status, std::uint64_t first, std::uint64_t end) {
    if (PassesOver(status)) lost_.Add(first, end);
    return Judge(std::move(status));
  }

  // Notes that the frames from `first` to before `end` are lost.
  void Lose(std::uint64_t first, std::uint64_t end) { lost_.Add(first, end); }
  const LostFrames& lost() const { return lost_; }

 private:
  bool PassesOver(const Status& status) const {
    return skips_ && (status.code() == StatusCode::kCorrupt || status.code() == StatusCode::kUnsupported);
  }

  bool skips_;
  LostFrames lost_;
};

}  // namespace sac
