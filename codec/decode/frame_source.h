// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "codec/decode/group_parser.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/sequence_header.h"
#include "sac/decoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// What a frame is turned into: positions, or the coefficients of the blend alone.
struct FrameOutput {
  Positions* positions = nullptr;    // filled, model units; null: the coefficients are wanted
  const RowMatrix* blend = nullptr;  // then these, about the origin; valid until the next frame
  bool exact = true;                 // whether the blend leaves nothing out
};

// Holds the coefficients of the frames that were read last, and turns them into positions.
class FrameSource {
 public:
  // `shape` and `run_jobs` must outlive the object. `threads` frames, one at least, that do not depend on each other
  // are reconstructed at the same time, by `run_jobs` unless that is empty.
  FrameSource(const Shape& shape, const SequenceHeader& header, unsigned threads, const JobRunner& run_jobs);

  // Holds the frames of a new group, or the next frame of an open group. The last of the frames held before is kept for
  // Interpolate().
  void Take(CodedFrames frames, bool starts_group);
  // Goes back to the first of the frames that are held.
  void Restart();
  // Holds no frames any more.
  void Drop();
  const CodedFrames& frames() const { return now_; }
  bool Holds(std::uint32_t frame) const { return Find(frame) != nullptr; }
  // Whether a frame that is held needed no other.
  bool IsIntra(std::uint32_t frame) const { return Find(frame) != nullptr && Find(frame)->intra; }

  // Gives a frame that frames() has. Frames must be asked for by ascending numbers; where
  // they reference the previous frame, none may be left out. The next request is expected `step` frames later, and
  // frames are reconstructed ahead for it. Returns kCorrupt, with the frame's number, when the frame cannot be
  // reconstructed; kInvalidArgument when run_jobs throws or leaves a job out.
  Status Reconstruct(std::uint32_t frame, std::uint32_t step, FrameOutput& output);

  // Gives the shape at `time`, in frames, whose frames before and after are held. See Decoder::Interpolate().
  Status Interpolate(double time, FrameOutput& output);

 private:
  // A frame that is reconstructed before it is asked for.
  struct Ready {
    std::uint32_t frame = 0;
    bool done = false;
    Status status;
    Positions positions;
  };

  const CodedFrames::Frame* Find(std::uint32_t frame) const;
  // Gives the coefficients of the blend of a frame with these planes and transform.
  void Blend(const FramePlanes& planes, const RigidTransform& transform, FrameOutput& output);
  Status ReconstructWith(Reconstructor& with, std::uint32_t frame, Positions& positions) const;
  // Reconstructs a batch of frames from `frame` on, each job a run of them. kInvalidArgument when run_jobs throws.
  Status ReconstructAhead(std::uint32_t frame, std::uint32_t step);
  // Reconstructs the frames of job number `job` of the batch, one after another.
  void ReconstructRun(std::size_t job);
  void DropReady() { first_ready_ = ready_count_ = 0; }

  const Shape& shape_;
  SequenceHeader header_;
  const JobRunner& run_jobs_;
  std::vector<std::unique_ptr<Reconstructor>> reconstructors_;  // one a job
  CodedFrames now_;
  std::optional<CodedFrames::Frame> before_;  // the frame of number now_.first - 1
  // Frames by ascending numbers, of which those from first_ready_ to before ready_count_ are ready. All keep their
  // memory for the next batch.
  std::vector<Ready> ready_;
  std::size_t first_ready_ = 0, ready_count_ = 0;
  FramePlanes between_;  // the planes of Interpolate(), kept for their memory
};

}  // namespace sac
