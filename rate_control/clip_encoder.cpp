// SPDX-License-Identifier: Apache-2.0
#include "sac/clip_encoder.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/encode/contain.h"
#include "codec/encode/input_check.h"
#include "geometry/coincident_vertices.h"
#include "rate_control/measured_encoding.h"
#include "rate_control/part_reach.h"
#include "rate_control/reference_shape.h"
#include "rate_control/target_search.h"
#include "rate_control/trial.h"

namespace sac {
namespace {

// The progress callback of an encoder that calls that of the encoding with the number of the trial.
std::function<bool(std::uint32_t)> ProgressOf(const ClipEncoding& encoding, std::uint32_t trial) {
  if (!encoding.progress) return encoding.encoder.progress;
  return [&encoding, trial](std::uint32_t frames) { return encoding.progress({trial, frames}); };
}

// The segment number `segment` of a clip, at which the clip is.
class SegmentReader : public ClipReader {
 public:
  // A clip at a segment but the first has just come to its begin.
  SegmentReader(ClipReader& clip, std::uint32_t segment)
      : clip_(clip), segment_(segment), first_(clip.first_frame()), at_begin_(segment > 0) {}

  const Mesh& mesh() const override { return clip_.mesh(); }
  FrameRate rate() const override { return clip_.rate(); }
  std::string name() const override { return clip_.name(); }
  std::string name_of(std::uint32_t frame) const override { return clip_.name_of(first_ + frame); }
  Status Next(Positions& frame, bool& end) override {
    at_begin_ = false;
    return clip_.Next(frame, end);
  }
  Status Rewind() override {
    if (at_begin_) return Status::Ok();
    SAC_RETURN_IF_ERROR(clip_.Rewind());
    for (std::uint32_t s = 0; s < segment_; ++s) {
      bool end = false;
      SAC_RETURN_IF_ERROR(clip_.NextSegment(end));
      if (end) return Status::InvalidArgument(clip_.name() + ": changed while it was read");
    }
    return Status::Ok();
  }

 private:
  ClipReader& clip_;
  const std::uint32_t segment_;
  const std::uint32_t first_;  // the number of its first frame in the clip
  bool at_begin_;              // nothing of it has been read
};

// The encoding of a clip while its settings and the shapes of its I-frames are chosen.
class ClipEncoder {
 public:
  ClipEncoder(ClipReader& clip, const ClipEncoding& encoding)
      : clip_(clip), encoding_(encoding), rounds_(RoundsOf(encoding)), settings_(encoding.encoder) {
    if (encoding.part && (encoding.part->first_frame > 0 || settings_.metadata.first_frame)) {
      const std::int64_t number = std::int64_t{encoding.part->first_frame} + settings_.metadata.first_frame.value_or(0);
      constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
      settings_.metadata.first_frame = static_cast<std::int32_t>(std::min(number, kMost));
    }
    if (settings_.frame_rate_numerator == 0 && clip.rate().numerator != 0) {
      settings_.frame_rate_numerator = clip.rate().numerator;
      settings_.frame_rate_denominator = clip.rate().denominator;
    }
  }

  Status Run(const ByteSink& sink, EncodedClip& result);

 private:
  // `settings` for the next trial.
  EncoderSettings ForTrial(EncoderSettings settings) {
    settings.progress = ProgressOf(encoding_, ++trials_);
    return settings;
  }
  // Finds the vertices of each segment that coincide in all of its frames, and how far small parts move.
  Status ReadAhead();
  // Chooses the shapes of all segments. `whole` becomes the encoding of the clip, if it has one segment.
  Status ChooseShapes(const EncoderSettings& settings, std::optional<ChosenShape>& whole);
  // Chooses settings_ and, with the settings that the search begins with, shapes_.
  Status Search();
  // Encodes with settings_ from shapes_.
  Status Encode(const ByteSink& sink, EncodedClip& result);
  // Chooses the shapes, with settings_, and gives out the encoding from them.
  Status EncodeFromChosenShapes(const ByteSink& sink, EncodedClip& result);

  ClipReader& clip_;
  const ClipEncoding& encoding_;
  const std::uint32_t rounds_;  // of fitting a shape
  EncoderSettings settings_;
  std::vector<std::optional<Mesh>> shapes_;  // of each segment; empty: its first frame
  std::vector<LookAhead> known_;             // of each segment
  std::uint32_t trials_ = 0;
};

Status ClipEncoder::ReadAhead() {
  if (encoding_.part) return Status::Ok();
  for (bool end = false; !end;) {
    SegmentReader segment(clip_, static_cast<std::uint32_t>(known_.size()));
    SAC_RETURN_IF_ERROR(sac::ReadAhead(segment, settings_, known_.emplace_back()));
    SAC_RETURN_IF_ERROR(clip_.NextSegment(end));
  }
  return known_.size() > 1 ? clip_.Rewind() : Status::Ok();
}

Status ClipEncoder::ChooseShapes(const EncoderSettings& settings, std::optional<ChosenShape>& whole) {
  const auto next_settings = [&] { return ForTrial(settings); };
  Status status;
  for (std::uint32_t s = 0;; ++s) {
    bool end = false;
    if (s > 0) SAC_RETURN_IF_ERROR(clip_.NextSegment(end));
    if (end) break;
    SegmentReader segment(clip_, s);
    SAC_RETURN_IF_ERROR(Named(segment.name_of(0), CheckMesh(segment.mesh(), settings.limits)));
    ChosenShape chosen;
    status = sac::ChooseShape(segment, s < known_.size() ? known_[s] : LookAhead{}, rounds_, next_settings, chosen);
    shapes_.push_back(chosen.mesh);
    if (s == 0) {
      whole = std::move(chosen);
    } else {
      whole.reset();
    }
    if (!status.ok()) break;  // the encoding of all will say so again, with the frames before
  }
  return whole || status.code() == StatusCode::kCancelled ? status : Status::Ok();
}

Status ClipEncoder::Search() {
  bool has_shapes = rounds_ == 0;
  const auto try_settings = [&](Trial& trial) {
    std::optional<ChosenShape> whole;
    if (!has_shapes) {
      SAC_RETURN_IF_ERROR(ChooseShapes(trial.settings, whole));
      has_shapes = true;
    }
    EncodedClip encoded;
    if (whole) {
      encoded = std::move(whole->encoded);
    } else {
      SAC_RETURN_IF_ERROR(
          EncodeAndMeasure(clip_, ForTrial(trial.settings), {shapes_, known_, true, {}, nullptr}, encoded));
    }
    trial.Take(encoded);
    return Status::Ok();
  };
  Status of_trial;  // its message already begins with the clip's name
  const auto run = [&](Trial& trial) { return of_trial = try_settings(trial); };
  Trial best;
  if (const Status found = SearchTargets(encoding_.targets, settings_, clip_.mesh(), run, best); !found.ok()) {
    return of_trial.ok() ? Named(clip_.name(), found) : found;
  }
  settings_ = best.settings;
  return Status::Ok();
}

Status ClipEncoder::Encode(const ByteSink& sink, EncodedClip& result) {
  settings_.progress = ProgressOf(encoding_, 0);
  return EncodeAndMeasure(
      clip_, settings_,
      {shapes_, known_, encoding_.measure || trials_ > 0, sink, nullptr, encoding_.part ? &*encoding_.part : nullptr},
      result);
}

Status ClipEncoder::EncodeFromChosenShapes(const ByteSink& sink, EncodedClip& result) {
  std::optional<ChosenShape> whole;
  Status status = ChooseShapes(settings_, whole);
  if (status.code() == StatusCode::kCancelled) return status;
  if (!whole || !whole->stream.is_whole()) return status.ok() || whole ? Encode(sink, result) : status;
  result = {};
  SAC_RETURN_IF_ERROR(whole->stream.Give(sink));
  result = std::move(whole->encoded);
  return status;
}

Status ClipEncoder::Run(const ByteSink& sink, EncodedClip& result) {
  SAC_RETURN_IF_ERROR(ReadAhead());
  if (encoding_.targets.any()) {
    SAC_RETURN_IF_ERROR(Search());
    SAC_RETURN_IF_ERROR(Encode(sink, result));
  } else if (rounds_ > 0) {
    SAC_RETURN_IF_ERROR(EncodeFromChosenShapes(sink, result));
  } else {
    SAC_RETURN_IF_ERROR(Encode(sink, result));
  }
  result.trials = trials_;
  result.fitted_reference =
      std::any_of(shapes_.begin(), shapes_.end(), [](const auto& mesh) { return mesh.has_value(); });
  result.settings.progress = encoding_.encoder.progress;
  return Status::Ok();
}

}  // namespace

Status ReadAhead(ClipReader& clip, const EncoderSettings& settings, LookAhead& known) {
  CoincidentVertices coincident;
  const Positions& first = clip.mesh().positions;
  const bool is_good = CheckMesh(clip.mesh(), settings.limits).ok() && CheckFinite(first).ok();
  if (is_good && settings.join.value_or(true)) coincident.Add(first);
  PartReach parts(is_good ? clip.mesh() : Mesh{}, coincident.Lowest());
  if (coincident.any() || parts.any()) SAC_RETURN_IF_ERROR(clip.Rewind());
  Positions frame;
  // What is wrong with a frame is said when it is to be coded, with the frames before it.
  for (bool end = false; (coincident.any() || parts.any()) && clip.Next(frame, end).ok() && !end;) {
    if (frame.size() != first.size() || !CheckFinite(frame).ok()) break;
    if (coincident.any()) coincident.Add(frame);
    if (parts.any()) parts.Add(frame);
  }
  known = {coincident.Lowest(), settings.reach ? std::vector<float>() : parts.Value()};
  return Status::Ok();
}

Status EncodeClip(ClipReader& clip, const ClipEncoding& encoding,
                  const std::function<Status(std::span<const std::uint8_t> bytes)>& sink, EncodedClip& result) {
  return Contain([&] {
    if (encoding.part && encoding.targets.any()) return Status::InvalidArgument("a part of a clip has no targets");
    // The shape is fitted and measured beside the encoder, which would check the mesh too late for them.
    SAC_RETURN_IF_ERROR(Named(clip.name(), CheckMesh(clip.mesh(), encoding.encoder.limits)));
    return ClipEncoder(clip, encoding).Run(sink, result);
  });
}

}  // namespace sac
