#include "cli/checked_encoding.h"

#include <utility>

#include "cli/decoded_frames.h"
#include "cli/progress.h"
#include "files/frame_rate.h"
#include "files/vertex_order.h"
#include "geometry/bounding_box.h"

namespace sac {

Status CheckedEncoding::AtInput(const std::string& where, const Status& status) const {
  if (status.ok()) return status;
  return {status.code(), settings_.inputs.front() + ": " + where + status.message()};
}

Status CheckedEncoding::Open() {
  Progress progress;
  progress.Begin("harmonics");
  SAC_RETURN_IF_ERROR(ClipInput::Open(settings_.inputs, input_));
  EncoderSettings& encoder = settings_.encoder;
  if (encoder.frame_rate_numerator == 0 && input_->fps()) {
    const FrameRate rate = NearestFrameRate(*input_->fps());
    encoder.frame_rate_numerator = rate.numerator;
    encoder.frame_rate_denominator = rate.denominator;
  }
  if (settings_.max_error) {
    encoder.max_error = settings_.max_error->value;
    const double diagonal = BoundingBox(input_->mesh().positions).diagonal();
    if (settings_.max_error->in_diagonals && diagonal == 0) {
      return AtInput("", Status::InvalidArgument("its first frame is a single point: --max-error needs model units"));
    }
    if (settings_.max_error->in_diagonals) *encoder.max_error *= diagonal;
  }
  // The outputs before the harmonics, which take long.
  SAC_RETURN_IF_ERROR(stream_.Open(settings_.output));
  if (!settings_.order_map.empty()) SAC_RETURN_IF_ERROR(order_map_.Open(settings_.order_map));
  if (settings_.targets.any()) SAC_RETURN_IF_ERROR(Search());
  return AtInput("", Encoder::Create(input_->mesh(), encoder, encoder_));
}

Status CheckedEncoding::Search() {
  Progress progress(input_->frame_count());
  Status input_status;  // names a file already
  ClipSource clip;
  clip.mesh = &input_->mesh();
  clip.rewind = [this] { input_->Rewind(); };
  clip.next = [&](Positions& frame, bool& end) { return input_status = input_->Next(frame, end); };
  Trial best;
  const auto run = [&](Trial& trial) {
    progress.SetPass("trial " + std::to_string(++trials_) + ", ");
    return RunTrial(
        clip, [&progress](std::uint32_t count) { progress.FramesDone(count); }, trial);
  };
  const Status status = SearchTargets(settings_.targets, settings_.encoder,
                                      static_cast<std::uint32_t>(clip.mesh->positions.size()), run, best);
  SAC_RETURN_IF_ERROR(input_status);
  SAC_RETURN_IF_ERROR(AtInput("", status));
  settings_.encoder = best.settings;
  input_->Rewind();
  return Status::Ok();
}

Status CheckedEncoding::EncodeUntilBytes(std::span<const std::uint8_t>& chunk) {
  for (;;) {
    chunk_ = encoder_->TakeBytes();
    chunk = chunk_;
    bytes_ += chunk_.size();
    if (!chunk_.empty()) return stream_.Write(chunk_.data(), chunk_.size());
    if (finished_) return Status::Ok();
    Positions frame;
    SAC_RETURN_IF_ERROR(input_->Next(frame, finished_));
    if (finished_) {
      SAC_RETURN_IF_ERROR(AtInput("", encoder_->Finish()));
    } else {
      SAC_RETURN_IF_ERROR(AtInput("frame " + std::to_string(sent_) + ": ", encoder_->Send(frame)));
      ++sent_;
      if (!settings_.unchecked) undecoded_.push_back(std::move(frame));
    }
  }
}

Status CheckedEncoding::Check() {
  const std::string name = settings_.output + ": decoding what was written";
  Progress progress(input_->frame_count());
  ErrorMeter meter(input_->mesh().triangles, input_->mesh().positions.size());
  DecodedFrames decoded(name, [this](auto& chunk) { return EncodeUntilBytes(chunk); });
  DecodedFrame frame;
  for (bool end = false;;) {
    SAC_RETURN_IF_ERROR(decoded.Next(frame, end));
    if (end) break;
    if (undecoded_.empty()) return Status::Corrupt(name + ": a frame too many");
    meter.Add(undecoded_.front(), ToInputOrder(frame.positions, encoder_->order()));
    undecoded_.pop_front();
    progress.FramesDone(frame.index + 1);
  }
  if (!undecoded_.empty()) return Status::Corrupt(name + ": a frame is missing");
  lost_texture_coordinates_ = !input_->mesh().uv_triangles.empty() && decoded.decoder().mesh()->uv_triangles.empty();
  distortion_ = meter.Result();
  return Status::Ok();
}

Status CheckedEncoding::EncodeAll() {
  Progress progress(input_->frame_count());
  std::span<const std::uint8_t> chunk;
  do {
    SAC_RETURN_IF_ERROR(EncodeUntilBytes(chunk));
    progress.FramesDone(sent_);
  } while (!chunk.empty());
  return Status::Ok();
}

Status CheckedEncoding::Run() {
  SAC_RETURN_IF_ERROR(Open());
  SAC_RETURN_IF_ERROR(settings_.unchecked ? EncodeAll() : Check());
  if (!settings_.order_map.empty()) {
    SAC_RETURN_IF_ERROR(order_map_.Write(FormatOrderMap(encoder_->order())));
    SAC_RETURN_IF_ERROR(order_map_.Close());  // the disk may be full
  }
  SAC_RETURN_IF_ERROR(stream_.Commit());
  return settings_.order_map.empty() ? Status::Ok() : order_map_.Commit();
}

}  // namespace sac
