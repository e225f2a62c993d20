// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/frame_range_option.h"
#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Reads a range of the frames of a clip that has one mesh.
class ClipPartReader : public ClipReader {
 public:
  // `clip` must outlive it.
  ClipPartReader(ClipReader& clip, const WantedFrames& wanted) : clip_(clip), wanted_(wanted) {}

  const Mesh& mesh() const override { return clip_.mesh(); }
  FrameRate rate() const override { return clip_.rate(); }
  std::optional<std::uint32_t> frame_count() const override;
  std::string name() const override { return clip_.name(); }
  std::string name_of(std::uint32_t frame) const override { return clip_.name_of(wanted_.begin + frame); }
  // kInvalidArgument, beside the clip's own errors, when the clip has fewer frames than are wanted.
  Status Next(Positions& frame, bool& end) override;
  Status Rewind() override;

  // After the last frame: whether the clip goes on behind it.
  bool clip_goes_on() const { return clip_goes_on_; }

 private:
  Status TooShort() const;

  ClipReader& clip_;
  const WantedFrames wanted_;
  std::uint32_t next_ = 0;  // in the clip
  bool clip_goes_on_ = false;
};

// Reads the file of a stream's start. `rate` becomes that of the clip.
Status ReadStartFile(const std::string& path, std::vector<std::uint8_t>& start, FrameRate& rate);

}  // namespace sac
