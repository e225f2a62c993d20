// SPDX-License-Identifier: Apache-2.0
#include "sac/encoder.h"

#include <optional>
#include <utility>

#include "codec/encode/contain.h"
#include "codec/encode/encoded_start.h"
#include "codec/encode/input_check.h"
#include "codec/encode/stream_encoder.h"

namespace sac {

class Encoder::Impl {
 public:
  Impl(EncodedStart start, const EncoderSettings& s) : settings(s), stream(std::move(start), s) {}

  // Runs `call` on the stream and lets no exception leave. After an exception the stream is at an undefined point of a
  // frame or group, so the failure is final.
  template <class Call>
  Status Do(Call&& call) {
    return Contain([&] { return call(stream); }, [&](Status status) { return stream.Latch(std::move(status)); });
  }

  const EncoderSettings settings;
  StreamEncoder stream;
};

Encoder::Encoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Encoder::~Encoder() = default;

Status Encoder::Create(const Mesh& mesh, const EncoderSettings& settings, std::unique_ptr<Encoder>& encoder,
                       std::span<const std::uint32_t> lowest, std::span<const float> reach) {
  const auto create = [&] {
    EncodedStart start;
    SAC_RETURN_IF_ERROR(EncodeStart(mesh, settings, start, lowest, reach));
    encoder.reset(new Encoder(std::make_unique<Impl>(std::move(start), settings)));
    return Status::Ok();
  };
  return Contain(create);
}

Status Encoder::CreateFrom(std::span<const std::uint8_t> bytes, const EncoderSettings& settings,
                           std::unique_ptr<Encoder>& encoder) {
  const auto create = [&] {
    SAC_RETURN_IF_ERROR(CheckSettings(settings));
    if (settings.low_delay)
      return Status::InvalidArgument("frames that come one by one are coded from their own start");
    EncodedStart start;
    SAC_RETURN_IF_ERROR(ReadStreamStart(bytes, settings.limits, start));
    encoder.reset(new Encoder(std::make_unique<Impl>(std::move(start), settings)));
    return Status::Ok();
  };
  return Contain(create);
}

std::vector<std::uint8_t> Encoder::start() const { return WriteStreamStart(impl_->stream.start()); }
std::uint32_t Encoder::group_frames() const { return impl_->stream.full_group(); }

Status Encoder::Send(std::span<const Vec3f> positions) {
  return impl_->Do([&](StreamEncoder& stream) { return stream.Send(positions); });
}

Status Encoder::BeginSegment(const Mesh& mesh, std::span<const std::uint32_t> lowest, std::span<const float> reach) {
  const auto begin = [&] {
    EncodedStart start;
    SAC_RETURN_IF_ERROR(EncodeStart(mesh, impl_->settings, start, lowest, reach));
    return impl_->Do([&](StreamEncoder& stream) { return stream.BeginSegment(std::move(start)); });
  };
  return Contain(begin);
}

Status Encoder::Flush() {
  return impl_->Do([](StreamEncoder& stream) { return stream.Flush(); });
}

Status Encoder::Finish() {
  return impl_->Do([](StreamEncoder& stream) { return stream.Finish(); });
}

std::uint32_t Encoder::frames() const { return impl_->stream.frames(); }
std::vector<std::uint8_t> Encoder::TakeBytes() { return impl_->stream.TakeBytes(); }
std::optional<FrameFault> Encoder::fault() const { return impl_->stream.fault(); }
const std::vector<std::uint32_t>& Encoder::order() const { return impl_->stream.order(); }
const StreamInfo& Encoder::info() const { return impl_->stream.info(); }
const StreamBytes& Encoder::stream_bytes() const { return impl_->stream.stream_bytes(); }

}  // namespace sac
