#include "rate_control/trial.h"

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "metrics/error_meter.h"
#include "sac/decoder.h"

namespace sac {
namespace {

// Decodes what an encoder gives and compares it with what went in.
class Measurement {
 public:
  Measurement(const Mesh& mesh, const std::vector<std::uint32_t>& order)
      : order_(order), meter_(mesh.triangles, mesh.positions.size()) {}

  void Expect(Positions frame) { expected_.push_back(std::move(frame)); }
  Status Take(std::span<const std::uint8_t> bytes, const std::function<void(std::uint32_t)>& frame_done);
  Status Finish(DistortionMetrics& distortion, std::uint64_t& bytes);

 private:
  const std::vector<std::uint32_t>& order_;
  Decoder decoder_;
  ErrorMeter meter_;
  std::deque<Positions> expected_;
  std::uint64_t bytes_ = 0;
};

Status Measurement::Take(std::span<const std::uint8_t> bytes, const std::function<void(std::uint32_t)>& frame_done) {
  bytes_ += bytes.size();
  while (!bytes.empty()) {
    SAC_RETURN_IF_ERROR(decoder_.Send(bytes));
    DecodedFrame frame;
    Status status;
    while ((status = decoder_.Receive(frame)).ok()) {
      if (expected_.empty()) return Status::Corrupt("a frame too many");
      Positions in_input_order(frame.positions.size());
      for (std::size_t v = 0; v < order_.size(); ++v) in_input_order[order_[v]] = frame.positions[v];
      meter_.Add(expected_.front(), in_input_order);
      expected_.pop_front();
      frame_done(frame.index + 1);
    }
    if (status.code() != StatusCode::kNeedMoreData) return status;
  }
  return Status::Ok();
}

Status Measurement::Finish(DistortionMetrics& distortion, std::uint64_t& bytes) {
  SAC_RETURN_IF_ERROR(decoder_.Finish());
  if (!expected_.empty()) return Status::Corrupt("a frame is missing");
  distortion = meter_.Result();
  bytes = bytes_;
  return Status::Ok();
}

}  // namespace

Status RunTrial(const ClipSource& clip, const std::function<void(std::uint32_t)>& frame_done, Trial& trial) {
  std::unique_ptr<Encoder> encoder;
  SAC_RETURN_IF_ERROR(Encoder::Create(*clip.mesh, trial.settings, encoder));
  Measurement measurement(*clip.mesh, encoder->order());
  clip.rewind();
  Positions frame;
  for (std::uint32_t sent = 0;; ++sent) {
    bool end = false;
    SAC_RETURN_IF_ERROR(clip.next(frame, end));
    if (end) break;
    if (const Status s = encoder->Send(frame); !s.ok()) {
      return {s.code(), "frame " + std::to_string(sent) + ": " + s.message()};
    }
    measurement.Expect(std::move(frame));
    SAC_RETURN_IF_ERROR(measurement.Take(encoder->TakeBytes(), frame_done));
  }
  SAC_RETURN_IF_ERROR(encoder->Finish());
  SAC_RETURN_IF_ERROR(measurement.Take(encoder->TakeBytes(), frame_done));
  DistortionMetrics distortion;
  SAC_RETURN_IF_ERROR(measurement.Finish(distortion, trial.bytes));
  trial.parts = encoder->stream_bytes();
  trial.vertices = static_cast<double>(encoder->info().vertices);
  trial.kg = distortion.kg;
  trial.sted = distortion.sted;
  trial.bpvf = 8 * static_cast<double>(trial.bytes) / (trial.vertices * static_cast<double>(distortion.frames));
  return Status::Ok();
}

}  // namespace sac
