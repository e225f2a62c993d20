// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "sac/clip.h"
#include "sac/sac_encode.h"

namespace sac {

// A clip whose frames the caller's C functions read. Both of `source` are there.
class FrameSourceReader : public ClipReader {
 public:
  FrameSourceReader(Mesh mesh, const sac_frame_source& source) : mesh_(std::move(mesh)), source_(source) {}

  const Mesh& mesh() const override { return mesh_; }
  Status Next(Positions& frame, bool& end) override {
    int ended = 0;
    frame_.resize(mesh_.positions.size());
    float none[3];
    float* const positions = frame_.empty() ? none : frame_.data()->data();
    if (source_.next(source_.user, positions, &ended) != 0) return Status::InvalidArgument("the source ended it");
    end = ended != 0;
    if (!end) frame = frame_;
    return Status::Ok();
  }
  Status Rewind() override {
    return source_.rewind(source_.user) == 0 ? Status::Ok() : Status::InvalidArgument("the source cannot be rewound");
  }

 private:
  Mesh mesh_;
  Positions frame_;
  const sac_frame_source source_;
};

}  // namespace sac
