// SPDX-License-Identifier: Apache-2.0
#include "rate_control/measured_encoding.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "codec/encode/group_window.h"
#include "rate_control/stream_measurement.h"

namespace sac {
namespace {

// An encoding as it goes.
class Encoding {
 public:
  Encoding(ClipReader& clip, const EncoderSettings& settings, const EncodingTask& task, EncodedClip& result)
      : clip_(clip),
        settings_(settings),
        task_(task),
        result_(result),
        measure_(task.measure),
        // An engine's job system stands for all threads: none of our own beside it.
        measurement_(task.residual, ThreadsOf(settings) > 1 && !settings.run_jobs) {}

  Status Run();

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
  Status Create();
  // Gives out and measures what has been coded.
  Status Take();
  // Ends the stream after the last frame that could be coded.
  Status Fail(const Status& status);
  Status EncodeSegment();
  Status BeginNextSegment(bool& end);

  ClipReader& clip_;
  const EncoderSettings& settings_;
  const EncodingTask& task_;
  EncodedClip& result_;
  const LookAhead nothing_;
  bool measure_;
  StreamMeasurement measurement_;
  std::unique_ptr<Encoder> encoder_;
};

Status Encoding::Take() {
  std::vector<std::uint8_t> bytes = encoder_->TakeBytes();
  result_.bytes += bytes.size();
  if (task_.sink && !bytes.empty()) SAC_RETURN_IF_ERROR(task_.sink(bytes));
  if (!measure_) return Status::Ok();
  return Named(clip_.name(), Named("decoding what was encoded", measurement_.Take(std::move(bytes))));
}

Status Encoding::Fail(const Status& status) {
  if (!encoder_->fault()) return Named(clip_.name(), status);
  if (encoder_->Finish().ok()) {
    measure_ = false;
    SAC_RETURN_IF_ERROR(Take());
    result_.frames = encoder_->frames();
    result_.order = encoder_->order();
  }
  std::string where = clip_.name_of(encoder_->fault()->frame);
  if (task_.part != nullptr) where += ": in the part from frame " + std::to_string(task_.part->first_frame) + " on";
  return Named(where, status);
}

Status Encoding::EncodeSegment() {
  ++result_.segments;
  measurement_.BeginSegment(clip_.mesh(), encoder_->order());
  Positions frame;
  for (bool end = false;;) {
    if (const Status read = clip_.Next(frame, end); !read.ok()) {
      const Status before = encoder_->Flush();  // a frame before may be at fault
      return before.ok() ? read : Fail(before);
    }
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

Status Encoding::Create() {
  if (task_.part == nullptr) {
    EncoderSettings own = settings_;
    own.join = false;  // but for those of the task
    return Encoder::Create(Shape(), own, encoder_, Known().lowest, Known().reach);
  }
  const std::uint32_t first = task_.part->first_frame;
  SAC_RETURN_IF_ERROR(Encoder::CreateFrom(task_.part->start, settings_, encoder_));
  if (clip_.mesh().positions.size() != encoder_->info().vertices ||
      clip_.mesh().triangles.size() != encoder_->info().triangles) {
    return Status::InvalidArgument("another mesh than that of the start");
  }
  if (const std::uint32_t group = encoder_->group_frames(); first % group != 0) {
    return Status::InvalidArgument("a part begins with a group, of which each has " + std::to_string(group) +
                                   " frames: not with frame " + std::to_string(first) + " but with " +
                                   std::to_string(first / group * group) + " or " +
                                   std::to_string((first / group + 1) * group));
  }
  return Status::Ok();
}

Status Encoding::Run() {
  const std::string name = clip_.name();
  result_ = {};
  SAC_RETURN_IF_ERROR(clip_.Rewind());
  SAC_RETURN_IF_ERROR(Named(name, Create()));
  for (bool end = false; !end;) {
    SAC_RETURN_IF_ERROR(EncodeSegment());
    SAC_RETURN_IF_ERROR(BeginNextSegment(end));
  }
  if (const Status finished = encoder_->Finish(); !finished.ok()) return Fail(finished);
  result_.frames = encoder_->frames();
  SAC_RETURN_IF_ERROR(Take());
  if (measure_) SAC_RETURN_IF_ERROR(Named(name, Named("decoding what was encoded", measurement_.Finish(result_))));
  result_.settings = settings_;
  result_.group_frames = encoder_->group_frames();
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
  return Encoding(clip, settings, task, result).Run();
}

}  // namespace sac
