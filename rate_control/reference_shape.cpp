// SPDX-License-Identifier: Apache-2.0
#include "rate_control/reference_shape.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "rate_control/measured_encoding.h"
#include "rate_control/shape_residual.h"

namespace sac {
namespace {

// One of every kThinning frames says where the shape is wrong.
constexpr std::uint32_t kThinning = 3;
// Shorter clips keep their first frame: what so few frames agree on is not worth the time.
constexpr std::uint32_t kLeastFrames = 4;

// One of every kThinning frames of a clip.
class ThinnedClip : public ClipReader {
 public:
  explicit ThinnedClip(ClipReader& clip) : clip_(clip) {}

  const Mesh& mesh() const override { return clip_.mesh(); }
  FrameRate rate() const override { return clip_.rate(); }
  std::string name() const override { return clip_.name(); }
  std::string name_of(std::uint32_t frame) const override { return clip_.name_of(kThinning * frame); }
  Status Next(Positions& frame, bool& end) override {
    Positions ignored;
    for (std::uint32_t i = begun_ ? 0 : kThinning - 1; i + 1 < kThinning; ++i) {
      SAC_RETURN_IF_ERROR(clip_.Next(ignored, end));
      if (end) return Status::Ok();
    }
    begun_ = true;
    return clip_.Next(frame, end);
  }
  Status Rewind() override {
    begun_ = false;
    return clip_.Rewind();
  }

 private:
  ClipReader& clip_;
  bool begun_ = false;
};

// The logarithm of bytes, KG and STED folded into one: the bytes that the same errors would take. Bytes are as errors
// to a power which differs from clip to clip, between 0.15 and 1.6 for KG and 0.12 and 0.72 for STED; these are the
// medians over nine settings of eight clips, near the targets of bench/targets.json.
double Cost(const EncodedClip& encoded) {
  constexpr double kOfKg = 0.6, kOfSted = 0.4;
  // Beyond these errors, in percent and without unit, nothing is gained.
  constexpr double kLeastKg = 1e-4, kLeastSted = 1e-5;
  return std::log(static_cast<double>(encoded.bytes)) + kOfKg * std::log(std::max(encoded.distortion.kg, kLeastKg)) +
         kOfSted * std::log(std::max(encoded.distortion.sted, kLeastSted));
}

// Encodes all frames of `clip` from shape.mesh.
Status EncodeFrom(ClipReader& clip, const LookAhead& known, const EncoderSettings& settings, ShapeResidual& residual,
                  ChosenShape& shape) {
  const auto hold = [&shape](std::span<const std::uint8_t> bytes) {
    shape.stream.Add(bytes);
    return Status::Ok();
  };
  return EncodeAndMeasure(clip, settings, {std::span(&shape.mesh, 1), std::span(&known, 1), true, hold, &residual},
                          shape.encoded);
}

}  // namespace

std::uint32_t RoundsOf(const ClipEncoding& encoding) {
  const EncoderSettings& encoder = encoding.encoder;
  if (encoding.part || encoder.max_error || encoder.low_delay || encoder.reference_shape != ReferenceShape::kKey)
    return 0;
  return encoding.reference_rounds.value_or(encoding.measure || encoding.targets.any() ? kReferenceRounds : 0);
}

Status ChooseShape(ClipReader& clip, const LookAhead& known, std::uint32_t rounds,
                   const std::function<EncoderSettings()>& settings_of_next, ChosenShape& chosen) {
  const Positions& first = clip.mesh().positions;
  ShapeResidual of_clip(clip.mesh().triangles, first.size(), kThinning);
  chosen = {};
  SAC_RETURN_IF_ERROR(EncodeFrom(clip, known, settings_of_next(), of_clip, chosen));
  if (chosen.encoded.frames < kLeastFrames) return Status::Ok();

  ThinnedClip thinned(clip);
  ShapeResidual of_thinned(clip.mesh().triangles, first.size(), 1);
  const ShapeResidual* residual = &of_clip;
  for (std::uint32_t round = 1; round <= rounds; ++round) {
    const bool is_last = round == rounds;
    ChosenShape fitted;
    fitted.mesh = clip.mesh();
    fitted.mesh->positions = residual->Corrected(1, first);
    residual = &of_thinned;
    ClipReader& frames = is_last ? clip : static_cast<ClipReader&>(thinned);
    const Status status = EncodeFrom(frames, known, settings_of_next(), of_thinned, fitted);
    if (status.code() == StatusCode::kCancelled) return status;
    if (!status.ok()) break;
    if (is_last && Cost(fitted.encoded) < Cost(chosen.encoded)) chosen = std::move(fitted);
  }
  return Status::Ok();
}

}  // namespace sac
