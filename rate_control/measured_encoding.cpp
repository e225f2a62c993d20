// SPDX-License-Identifier: Apache-2.0
#include "rate_control/measured_encoding.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
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
  // `residual` may be null; otherwise it must outlive the object, and the clip has one mesh.
  explicit Measurement(ShapeResidual* residual) : residual_(residual) {}

  // The frames that are expected next have this mesh, whose vertices the encoder puts into `order`.
  void BeginSegment(const Mesh& mesh, const std::vector<std::uint32_t>& order);
  void Expect(Positions frame) { expected_.push_back({std::move(frame), segments_.size() - 1}); }
  Status Take(std::span<const std::uint8_t> bytes);
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

  // `decoded` in the order of the input of the current segment.
  Positions InInputOrder(const Positions& decoded) const;
  void BeginMeasuring(std::size_t segment);
  void Compare(const Positions& original, const Positions& decoded);

  Decoder decoder_;
  std::vector<Segment> segments_;
  std::optional<ErrorMeter> meter_;
  std::size_t measured_ = 0;  // the segment that meter_ is at
  ShapeResidual* residual_;
  std::deque<Expected> expected_;  // frames that were sent to the encoder and have not been decoded yet
  DecodedFrame frame_;
  bool lost_uvs_ = false, lost_normals_ = false;
};

void Measurement::BeginSegment(const Mesh& mesh, const std::vector<std::uint32_t>& order) {
  segments_.push_back({mesh.triangles, order, !mesh.uv_triangles.empty(), !mesh.normals.empty()});
}

Positions Measurement::InInputOrder(const Positions& decoded) const {
  const std::vector<std::uint32_t>& order = segments_[measured_].order;
  Positions ordered(decoded.size());
  for (std::size_t v = 0; v < order.size(); ++v) ordered[order[v]] = decoded[v];
  return ordered;
}

void Measurement::BeginMeasuring(std::size_t index) {
  measured_ = index;
  Segment& segment = segments_[index];
  const std::size_t vertices = segment.order.size();
  if (meter_) {
    meter_->BeginMesh(std::move(segment.triangles), vertices);
  } else {
    meter_.emplace(std::move(segment.triangles), vertices);
  }
  const Mesh& decoded = *decoder_.mesh();
  lost_uvs_ = lost_uvs_ || (segment.has_uvs && decoded.uv_triangles.empty());
  lost_normals_ = lost_normals_ || (segment.has_normals && decoded.normals.empty());
  if (residual_ != nullptr) residual_->Begin(InInputOrder(decoded.positions));
}

void Measurement::Compare(const Positions& original, const Positions& decoded) {
  meter_->Add(original, decoded);
  if (residual_ != nullptr) residual_->Add(original, decoded);
}

Status Measurement::Take(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    SAC_RETURN_IF_ERROR(decoder_.Send(bytes));
    Status status;
    while ((status = decoder_.Receive(frame_)).ok()) {
      if (expected_.empty()) return Status::Corrupt("a frame too many");
      const Expected& expected = expected_.front();
      if (expected.segment != frame_.segment) return Status::Corrupt("a frame of another segment");
      if (!meter_ || expected.segment != measured_) BeginMeasuring(expected.segment);
      Compare(expected.positions, InInputOrder(frame_.positions));
      expected_.pop_front();
    }
    if (status.code() != StatusCode::kNeedMoreData) return status;
  }
  return Status::Ok();
}

Status Measurement::Finish(EncodedClip& result) {
  SAC_RETURN_IF_ERROR(decoder_.Finish());
  if (!expected_.empty()) return Status::Corrupt("a frame is missing");
  if (meter_) result.distortion = meter_->Result();
  result.lost_texture_coordinates = lost_uvs_;
  result.lost_normals = lost_normals_;
  return Status::Ok();
}

// An encoding as it goes.
class Encoding {
 public:
  Encoding(ClipReader& clip, const EncodingTask& task, EncodedClip& result)
      : clip_(clip), task_(task), result_(result), measure_(task.measure), measurement_(task.residual) {}

  Status Run(const EncoderSettings& settings);

 private:
  // The mesh of the I-frame of the segment that the clip is at.
  const Mesh& Shape() const {
    const bool given = result_.segments < task_.shapes.size() && task_.shapes[result_.segments];
    return given ? *task_.shapes[result_.segments] : clip_.mesh();
  }
  // What is known of that segment.
  const LookAhead& Known() const {
    return result_.segments < task_.known.size() ? task_.known[result_.segments] : nothing_;
  }
  // Gives out and measures what has been coded.
  Status Take();
  // Ends the stream after the last frame that could be coded.
  Status Fail(const Status& status);
  Status EncodeSegment();
  Status BeginNextSegment(bool& end);

  ClipReader& clip_;
  const EncodingTask& task_;
  EncodedClip& result_;
  const LookAhead nothing_;
  bool measure_;
  Measurement measurement_;
  std::unique_ptr<Encoder> encoder_;
};

Status Encoding::Take() {
  const std::vector<std::uint8_t> bytes = encoder_->TakeBytes();
  result_.bytes += bytes.size();
  if (task_.sink && !bytes.empty()) SAC_RETURN_IF_ERROR(task_.sink(bytes));
  if (!measure_) return Status::Ok();
  return Named(clip_.name(), Named("decoding what was encoded", measurement_.Take(bytes)));
}

Status Encoding::Fail(const Status& status) {
  if (!encoder_->fault()) return Named(clip_.name(), status);
  if (encoder_->Finish().ok()) {
    measure_ = false;
    SAC_RETURN_IF_ERROR(Take());
    result_.frames = encoder_->frames();
    result_.order = encoder_->order();
  }
  return Named(clip_.name_of(encoder_->fault()->frame), status);
}

Status Encoding::EncodeSegment() {
  ++result_.segments;
  measurement_.BeginSegment(clip_.mesh(), encoder_->order());
  Positions frame;
  for (bool end = false;;) {
    SAC_RETURN_IF_ERROR(clip_.Next(frame, end));
    if (end) return Status::Ok();
    result_.positions += frame.size();
    if (const Status sent = encoder_->Send(frame); !sent.ok()) return Fail(sent);
    if (measure_) measurement_.Expect(std::move(frame));
    SAC_RETURN_IF_ERROR(Take());
  }
}

Status Encoding::BeginNextSegment(bool& end) {
  SAC_RETURN_IF_ERROR(clip_.NextSegment(end));
  if (end) return Status::Ok();
  const Status begun = encoder_->BeginSegment(Shape(), Known().lowest, Known().reach);
  if (begun.ok()) return Take();
  return encoder_->fault() ? Fail(begun) : Named(clip_.name_of(clip_.first_frame()), begun);
}

Status Encoding::Run(const EncoderSettings& settings) {
  const std::string name = clip_.name();
  result_ = {};
  SAC_RETURN_IF_ERROR(clip_.Rewind());
  EncoderSettings own = settings;
  own.join = false;  // but for those of the task
  SAC_RETURN_IF_ERROR(Named(name, Encoder::Create(Shape(), own, encoder_, Known().lowest, Known().reach)));
  for (bool end = false; !end;) {
    SAC_RETURN_IF_ERROR(EncodeSegment());
    SAC_RETURN_IF_ERROR(BeginNextSegment(end));
  }
  if (const Status finished = encoder_->Finish(); !finished.ok()) return Fail(finished);
  result_.frames = encoder_->frames();
  SAC_RETURN_IF_ERROR(Take());
  if (measure_) SAC_RETURN_IF_ERROR(Named(name, Named("decoding what was encoded", measurement_.Finish(result_))));
  result_.settings = settings;
  result_.info = encoder_->info();
  result_.parts = encoder_->stream_bytes();
  result_.order = encoder_->order();
  return Status::Ok();
}

}  // namespace

Status Named(const std::string& name, const Status& status) {
  if (status.ok() || name.empty()) return status;
  return {status.code(), name + ": " + status.message()};
}

Status EncodeAndMeasure(ClipReader& clip, const EncoderSettings& settings, const EncodingTask& task,
                        EncodedClip& result) {
  return Encoding(clip, task, result).Run(settings);
}

}  // namespace sac
