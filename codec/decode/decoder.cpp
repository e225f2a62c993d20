// SPDX-License-Identifier: Apache-2.0
#include "sac/decoder.h"

#include <exception>

#include "codec/decode/stream_decoder.h"

namespace sac {

class Decoder::Impl {
 public:
  explicit Impl(const DecoderSettings& s) : settings(s) { Restart(); }

  // Forgets the stream.
  void Restart() { stream.emplace(settings); }

  // Runs `call` on the stream and lets no exception leave. An exception means that memory ran out, because the limits
  // allow more than the machine has.
  template <class Call>
  Status Contain(Call&& call) {
    try {
      if (settings.frame_step == 0) return Status::InvalidArgument("a frame_step of 0");
      return call(*stream);
    } catch (const std::exception&) {                        // std::bad_alloc or std::length_error
      return stream->Latch(Status::Limit("out of memory"));  // short enough for a string that allocates nothing
    }
  }

  const DecoderSettings settings;
  std::optional<StreamDecoder> stream;  // never empty; std::optional so that it can be constructed anew in place
  Positions positions;                  // frames for the caller's buffers, kept from call to call for their memory
};

Decoder::Decoder(const DecoderSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

Status Decoder::Send(std::span<const std::uint8_t>& bytes) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Send(bytes); });
}

Status Decoder::Receive(DecodedFrame& frame) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Receive(frame.positions, frame, nullptr); });
}

Status Decoder::Receive(const FrameBuffers& buffers, FrameInfo& info) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Receive(impl_->positions, info, &buffers); });
}

Status Decoder::Interpolate(double time, DecodedFrame& frame) {
  return impl_->Contain(
      [&](StreamDecoder& stream) { return stream.Interpolate(time, frame.positions, frame, nullptr); });
}

Status Decoder::Interpolate(double time, const FrameBuffers& buffers, FrameInfo& info) {
  return impl_->Contain(
      [&](StreamDecoder& stream) { return stream.Interpolate(time, impl_->positions, info, &buffers); });
}

Status Decoder::Blend(BlendWeights& weights) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Weights(weights); });
}

Status Decoder::ReceiveHandles(std::span<float> matrices, FrameInfo& info, bool& exact) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.ReceiveHandles(matrices, info, exact); });
}

Status Decoder::InterpolateHandles(double time, std::span<float> matrices, FrameInfo& info, bool& exact) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.InterpolateHandles(time, matrices, info, exact); });
}

Status Decoder::Finish() {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Finish(); });
}

Status Decoder::Seek(std::uint32_t frame, std::uint64_t& byte) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.Seek(frame, byte); });
}

Status Decoder::SeekTime(double seconds, std::uint64_t& byte) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.SeekTime(seconds, byte); });
}

Status Decoder::AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed) {
  return impl_->Contain([&](StreamDecoder& stream) { return stream.AddIndex(tail, needed); });
}

Status Decoder::Prepare() {
  return impl_->Contain([](StreamDecoder& stream) { return stream.Prepare(); });
}

Status Decoder::Flush() {
  return impl_->Contain([](StreamDecoder& stream) { return stream.Flush(); });
}

void Decoder::Reset() noexcept { impl_->Restart(); }

const StreamInfo* Decoder::info() const {
  const StreamStart& start = impl_->stream->start();
  return start.header() ? &start.info() : nullptr;
}

const Mesh* Decoder::mesh() const {
  const StreamStart& start = impl_->stream->start();
  return start.mesh() ? &*start.mesh() : nullptr;
}

std::optional<std::uint32_t> Decoder::segment() const { return impl_->stream->start().segment(); }

const Metadata* Decoder::metadata() const {
  const std::optional<Metadata>& metadata = impl_->stream->metadata();
  return metadata ? &*metadata : nullptr;
}

const std::vector<std::uint32_t>& Decoder::order() const { return impl_->stream->start().order(); }
std::uint32_t Decoder::layers() const { return impl_->stream->layers(); }
std::optional<std::uint32_t> Decoder::frames() const { return impl_->stream->total_frames(); }
const std::vector<FrameRange>& Decoder::lost_frames() const { return impl_->stream->lost().ranges(); }

}  // namespace sac
