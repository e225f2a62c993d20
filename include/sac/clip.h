// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Frames per second, numerator / denominator in lowest terms; a numerator of 0 means unknown.
struct FrameRate {
  std::uint32_t numerator = 0;
  std::uint32_t denominator = 1;

  // 0 where the rate is unknown.
  double per_second() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

// A clip that is read frame by frame, as often as is wanted. Memory need not grow with the number of frames.
//
// A clip whose mesh changes, such as a volumetric capture of several takes, is read segment by segment; frames are
// numbered through all of them.
class ClipReader {
 public:
  virtual ~ClipReader() = default;

  // The first frame of the segment with its triangles and attributes.
  virtual const Mesh& mesh() const = 0;
  virtual FrameRate rate() const { return {}; }
  // The number of frames, where it is known before they are read.
  virtual std::optional<std::uint32_t> frame_count() const { return std::nullopt; }
  // The beginning of messages about the clip as a whole, such as the path of its file.
  virtual std::string name() const { return {}; }
  // The beginning of messages about one frame, such as the path of the file that holds it.
  virtual std::string name_of(std::uint32_t /*frame*/) const { return name(); }

  // Reads the next frame, beginning with the first, in the vertex order of mesh(), model units. After the last frame of
  // the segment `end` becomes true and `frame` stays as it is. A message names the file and the frame at fault.
  virtual Status Next(Positions& frame, bool& end) = 0;
  // Goes on with the first frame of the next segment, also before the end of this one. `end` becomes true, and the
  // reader stays where it is, where there is none.
  virtual Status NextSegment(bool& end) {
    end = true;
    return Status::Ok();
  }
  // The number of the segment's first frame.
  virtual std::uint32_t first_frame() const { return 0; }
  // Begins again with the first frame of the first segment.
  virtual Status Rewind() = 0;
};

// A clip in memory.
struct Clip {
  Mesh mesh;                      // the first frame with its triangles and attributes
  std::vector<Positions> frames;  // each with as many positions as the mesh
  FrameRate rate = {};

  std::size_t vertices() const { return frames.empty() ? mesh.positions.size() : frames.front().size(); }
};

// Reads a clip in memory, which must outlive the reader.
class MemoryClipReader : public ClipReader {
 public:
  explicit MemoryClipReader(const Clip& clip) : clip_(clip) {}

  const Mesh& mesh() const override { return clip_.mesh; }
  FrameRate rate() const override { return clip_.rate; }
  std::optional<std::uint32_t> frame_count() const override { return static_cast<std::uint32_t>(clip_.frames.size()); }
  Status Next(Positions& frame, bool& end) override {
    end = next_ == clip_.frames.size();
    if (!end) frame = clip_.frames[next_++];
    return Status::Ok();
  }
  Status Rewind() override {
    next_ = 0;
    return Status::Ok();
  }

 private:
  const Clip& clip_;
  std::size_t next_ = 0;
};

}  // namespace sac
