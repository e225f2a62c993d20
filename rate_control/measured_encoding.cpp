// SPDX-License-Identifier: Apache-2.0
#include "rate_control/measured_encoding.h"

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "metrics/error_meter.h"
#include "sac/decoder.h"

namespace sac {
namespace {

// Decodes the bytes of an encoder and measures the decoded frames against the encoder's input.
class Measurement {
 public:
  // `order` is that of the encoder. It must outlive the object.
  Measurement(const Mesh& mesh, const std::vector<std::uint32_t>& order)
      : order_(order), meter_(mesh.triangles, mesh.positions.size()) {}

  void Expect(Positions frame) { expected_.push_back(std::move(frame)); }
  Status Take(std::span<const std::uint8_t> bytes);
  Status Finish(EncodedClip& result);

 private:
  const std::vector<std::uint32_t>& order_;
  Decoder decoder_;
  ErrorMeter meter_;
  std::deque<Positions> expected_;  // frames that were sent to the encoder and have not been decoded yet
  DecodedFrame frame_;
  Positions in_input_order_;
};

Status Measurement::Take(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    SAC_RETURN_IF_ERROR(decoder_.Send(bytes));
    Status status;
    while ((status = decoder_.Receive(frame_)).ok()) {
      if (expected_.empty()) return Status::Corrupt("a frame too many");
      in_input_order_.resize(frame_.positions.size());
      for (std::size_t v = 0; v < order_.size(); ++v) in_input_order_[order_[v]] = frame_.positions[v];
      meter_.Add(expected_.front(), in_input_order_);
      expected_.pop_front();
    }
    if (status.code() != StatusCode::kNeedMoreData) return status;
  }
  return Status::Ok();
}

Status Measurement::Finish(EncodedClip& result) {
  SAC_RETURN_IF_ERROR(decoder_.Finish());
  if (!expected_.empty()) return Status::Corrupt("a frame is missing");
  result.distortion = meter_.Result();
  result.lost_texture_coordinates = decoder_.mesh()->uv_triangles.empty();
  result.lost_normals = decoder_.mesh()->normals.empty();
  return Status::Ok();
}

}  // namespace

Status Named(const std::string& name, const Status& status) {
  if (status.ok() || name.empty()) return status;
  return {status.code(), name + ": " + status.message()};
}

Status EncodeAndMeasure(ClipReader& clip, const EncoderSettings& settings, bool measure, const ByteSink& sink,
                        EncodedClip& result) {
  const std::string name = clip.name();
  std::unique_ptr<Encoder> encoder;
  SAC_RETURN_IF_ERROR(Named(name, Encoder::Create(clip.mesh(), settings, encoder)));
  result = {};
  Measurement measurement(clip.mesh(), encoder->order());
  const auto take = [&] {
    const std::vector<std::uint8_t> bytes = encoder->TakeBytes();
    result.bytes += bytes.size();
    if (sink && !bytes.empty()) SAC_RETURN_IF_ERROR(sink(bytes));
    return measure ? Named(name, Named("decoding what was encoded", measurement.Take(bytes))) : Status::Ok();
  };
  SAC_RETURN_IF_ERROR(clip.Rewind());
  // Ends the stream after the last frame that could be coded.
  const auto fail = [&](const Status& status) {
    if (!encoder->fault()) return Named(name, status);
    if (encoder->Finish().ok()) {
      measure = false;
      SAC_RETURN_IF_ERROR(take());
      result.frames = encoder->frames();
      result.order = encoder->order();
    }
    return Named(clip.name_of(encoder->fault()->frame), status);
  };
  Positions frame;
  for (bool end = false;;) {
    SAC_RETURN_IF_ERROR(clip.Next(frame, end));
    if (end) break;
    if (const Status sent = encoder->Send(frame); !sent.ok()) return fail(sent);
    if (measure) measurement.Expect(std::move(frame));
    SAC_RETURN_IF_ERROR(take());
  }
  if (const Status finished = encoder->Finish(); !finished.ok()) return fail(finished);
  result.frames = encoder->frames();
  SAC_RETURN_IF_ERROR(take());
  if (measure) SAC_RETURN_IF_ERROR(Named(name, Named("decoding what was encoded", measurement.Finish(result))));
  result.lost_texture_coordinates = result.lost_texture_coordinates && !clip.mesh().uv_triangles.empty();
  result.lost_normals = result.lost_normals && !clip.mesh().normals.empty();
  result.settings = settings;
  result.info = encoder->info();
  result.parts = encoder->stream_bytes();
  result.order = encoder->order();
  return Status::Ok();
}

}  // namespace sac
