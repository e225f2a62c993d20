#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "codec/decode/group_parser.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Holds the coefficients of the frames that were read last, and turns them into positions.
class FrameSource {
 public:
  // `shape` must outlive it. `threads`, one at least, reconstruct frames that do not depend on each other.
  FrameSource(const Shape& shape, const SequenceHeader& header, unsigned threads);

  // Frames of a new group, or the next one of an open group. The last frame of those before is kept for Interpolate().
  // kCorrupt when the first frame's shape is singular.
  Status Take(CodedFrames frames, bool starts_group);
  // The same frames from the first on. Likewise.
  Status Restart();
  // Holds no frames.
  void Drop();
  const CodedFrames& frames() const { return now_; }
  bool Holds(std::uint32_t frame) const { return Find(frame) != nullptr; }
  // Whether a frame that it holds needed no other.
  bool IsIntra(std::uint32_t frame) const { return Find(frame) != nullptr && Find(frame)->intra; }

  // The positions of a frame that frames() has. Frames are asked for by ascending numbers, and all of them where they
  // are measured against the frame before; `step` says which one is likely to be the next. kCorrupt, with the frame's
  // number.
  Status Reconstruct(std::uint32_t frame, std::uint32_t step, Positions& positions);

  // At `time`, in frames; holds the frames before and after. See Decoder::Interpolate().
  Status Interpolate(double time, Positions& positions);

 private:
  struct Ready {
    std::uint32_t frame = 0;
    Status status;
    Positions positions;
  };

  const CodedFrames::Frame* Find(std::uint32_t frame) const;
  Status ReconstructWith(Reconstructor& with, std::uint32_t frame, Positions& positions) const;
  // A batch of frames, each thread a run of them.
  void ReconstructAhead(std::uint32_t frame, std::uint32_t step);

  const Shape& shape_;
  SequenceHeader header_;
  std::vector<std::unique_ptr<Reconstructor>> reconstructors_;  // one a thread
  CodedFrames now_;
  std::optional<CodedFrames::Frame> before_;  // the frame of number now_.first - 1
  std::vector<Ready> ready_;                  // ascending
};

}  // namespace sac
