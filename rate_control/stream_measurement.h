// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "codec/decode/run_jobs.h"
#include "geometry/in_input_order.h"
#include "metrics/error_meter.h"
#include "rate_control/shape_residual.h"
#include "sac/clip_encoder.h"
#include "sac/decoder.h"
#include "sac/mesh.h"
#include "sac/status.h"
#if SAC_HAS_THREADS
#include <thread>
#endif

namespace sac {

// Decodes the bytes of an encoder and measures the decoded frames against the encoder's input, one after another, so
// that the result does not depend on threads.
class StreamMeasurement {
 public:
  // `residual` may be null; otherwise it must outlive the object, and the clip has one mesh. With `beside`, what Take()
  // gets is decoded by another thread while the caller goes on.
  StreamMeasurement(ShapeResidual* residual, bool beside) : residual_(residual), beside_(beside) {}
  ~StreamMeasurement() { Wait(); }
  StreamMeasurement(const StreamMeasurement&) = delete;
  StreamMeasurement& operator=(const StreamMeasurement&) = delete;

  // The frames that are expected next have this mesh, whose vertices the encoder puts into `order`.
  void BeginSegment(const Mesh& mesh, const std::vector<std::uint32_t>& order);
  // A frame that was sent to the encoder.
  void Expect(Positions frame) { sent_.push_back({std::move(frame), segments_.size() - 1}); }
  // The next bytes of the stream. The status may be that of bytes taken before. kCorrupt where the stream is not that
  // of the frames that are expected, kLimit when memory is short, and the decoder's errors.
  Status Take(std::vector<std::uint8_t> bytes);
  // Sets the distortion of `result` and what was lost. Status as of Take().
  Status Finish(EncodedClip& result);

 private:
  struct Segment {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> order;
    bool has_uvs, has_normals;
  };
  struct Expected {
    Positions positions;
    std::size_t segment;
  };

  // Waits for the other thread. Until then it has all members from decoder_ on.
  void Wait();
  Status Decode();
  // Those of the current segment, in the order of its input.
  Positions Ordered(const Positions& decoded) const { return InInputOrder(decoded, segments_[measured_].order); }
  void BeginMeasuring(std::size_t segment);
  void Compare(const Positions& original, const Positions& decoded);

  ShapeResidual* residual_;
  [[maybe_unused]] bool beside_;
#if SAC_HAS_THREADS
  std::thread other_;
#endif
  std::vector<Expected> sent_;  // frames that wait for the next Take()

  Decoder decoder_;
  std::vector<std::uint8_t> bytes_;  // to be decoded
  Status failure_;
  std::vector<Segment> segments_;
  std::optional<ErrorMeter> meter_;
  std::size_t measured_ = 0;       // the segment that meter_ is at
  std::deque<Expected> expected_;  // frames that were sent to the encoder and have not been decoded yet
  DecodedFrame frame_;
  bool lost_uvs_ = false, lost_normals_ = false;
};

}  // namespace sac
