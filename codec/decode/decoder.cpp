#include "sac/decoder.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "codec/decode/frame_source.h"
#include "codec/decode/group_parser.h"
#include "codec/decode/lost_frames.h"
#include "codec/decode/packet_source.h"
#include "codec/decode/seek_table.h"
#include "codec/decode/vertex_buffer.h"
#include "codec/i_frame.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/stream_index.h"
#include "geometry/bounding_box.h"

namespace sac {

class Decoder::Impl {
 public:
  explicit Impl(const DecoderSettings& s) : settings(s), packets_(s.limits, s.skip_damage) {
    if (s.frame_step == 0) error_ = Status::InvalidArgument("a frame_step of 0");
  }

  Status Send(std::span<const std::uint8_t>& bytes);
  // Into `positions`, and from there into `buffers`, unless null, which are checked before anything is given out.
  Status Receive(Positions& positions, FrameInfo& info, const FrameBuffers* buffers = nullptr);
  Status Finish();
  Status Seek(std::uint32_t frame, std::uint64_t& byte);
  Status AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed);
  Status Interpolate(double time, Positions& positions, FrameInfo& info, const FrameBuffers* buffers = nullptr);

  // Keeps exceptions in. They are want of memory: the limits allow more than there is.
  template <class Call>
  Status Contain(Call&& call) {
    try {
      return call();
    } catch (const std::exception&) {                // std::bad_alloc or std::length_error
      return Latch(Status::Limit("out of memory"));  // short enough for a string that allocates nothing
    }
  }

  const DecoderSettings settings;
  std::optional<SequenceHeader> header;
  StreamInfo stream_info;  // of the header
  std::optional<Mesh> mesh;
  std::vector<std::uint32_t> order;
  std::optional<std::uint32_t> total_frames;
  LostFrames lost;

 private:
  // Reads a packet, or the record of an open group, from the front of `bytes` or from those that are read again.
  Status Advance(std::span<const std::uint8_t>& bytes);
  // What there is without more bytes. False when there is nothing.
  bool CanAdvance();
  Status AdvanceAlone();

  Status Take(const Packet& packet, std::uint64_t begin);
  Status TakeHeader(std::span<const std::uint8_t> payload);
  Status TakeIFrame(std::span<const std::uint8_t> payload);
  Status DecodeIFrame(std::span<const std::uint8_t> payload);
  Status TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin);
  Status TakeFrame(std::span<const std::uint8_t> payload);
  Status TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin);
  // The frames of a group that is cut off by the end of the bytes.
  void TakeCutGroup(std::span<const std::uint8_t> packet);
  // Whether to pass over what gave `status`. What exceeds a limit is no damage.
  bool IsDamage(const Status& status) const {
    return settings.skip_damage && !status.ok() && status.code() != StatusCode::kLimit;
  }
  // Whether the stream goes on with `frame`: notes what is lost before.
  Status ContinueAt(std::uint32_t frame);

  bool FrameWaits() const { return source_ && next_out_ < source_->frames().end(); }
  Status Check(const FrameBuffers* buffers) const {
    return buffers ? CheckBuffers(*buffers, shape_.vertices()) : Status::Ok();
  }
  Status BeyondTheEnd(double time) const {
    return Status::InvalidArgument("frame " + std::to_string(static_cast<std::uint32_t>(time)) + " of a clip of " +
                                   std::to_string(*total_frames) + " frames");
  }
  void GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
               const FrameBuffers* buffers) const;
  Status Latch(Status status) {
    if (!status.ok()) error_ = status;
    return status;
  }

  PacketSource packets_;
  std::optional<Status> error_;
  bool ended_ = false;     // the end packet has been read
  bool finished_ = false;  // no more bytes will be sent

  std::vector<std::uint8_t> header_bytes_;
  std::uint32_t i_frame_crc_ = 0;
  std::size_t i_frame_size_ = 0;
  bool after_header_ = false;
  bool foreign_ = false;  // with skip_damage: another stream has begun

  Shape shape_;  // the members below refer to it
  std::optional<GroupParser> parser_;
  std::optional<FrameSource> source_;
  bool group_begins_ = false;
  // The packet whose frames source_ has.
  struct HeldGroup {
    std::uint64_t begin;
    std::size_t size;
    std::uint32_t crc;
    bool operator==(const HeldGroup&) const = default;
  };
  std::optional<HeldGroup> held_;

  std::optional<std::uint64_t> next_frame_ = 0;  // that the stream has; none where it is entered
  std::uint64_t next_out_ = 0;                   // of those in source_
  std::uint64_t wanted_ = 0;                     // frames before are not given out
  SeekTable places_;
};

Status Decoder::Impl::Send(std::span<const std::uint8_t>& bytes) {
  if (error_) return *error_;
  if (FrameWaits()) return Status::Ok();
  return Latch(Advance(bytes));
}

Status Decoder::Impl::Advance(std::span<const std::uint8_t>& bytes) {
  if (ended_) {
    if (!bytes.empty() && !settings.skip_damage) return Status::Corrupt("bytes after the end of the stream");
    bytes = {};
    return Status::Ok();
  }
  std::optional<Packet> packet;
  bool damaged = false;
  SAC_RETURN_IF_ERROR(packets_.Read(bytes, packet, damaged));
  if (damaged && parser_) parser_->Close();
  if (!packet) return Status::Ok();
  const std::uint64_t size = PacketSize(packet->payload.size());
  return Take(*packet, packets_.position() - std::min(size, packets_.position()));
}

bool Decoder::Impl::CanAdvance() {
  if (ended_) return false;
  if (!finished_ || packets_.HasOld()) return packets_.HasOld();
  std::vector<std::uint8_t> cut;
  if (packets_.Finish(cut)) return true;
  if (parser_ && !parser_->is_open()) TakeCutGroup(cut);
  return FrameWaits();
}

Status Decoder::Impl::AdvanceAlone() {
  std::span<const std::uint8_t> none;
  return FrameWaits() ? Status::Ok() : Latch(Advance(none));
}

Status Decoder::Impl::Take(const Packet& packet, std::uint64_t begin) {
  const bool follows_header = std::exchange(after_header_, false), is_i_frame = packet.type == PacketType::kIFrame;
  if (header && follows_header != is_i_frame && !settings.skip_damage) {
    return Status::Corrupt(is_i_frame ? "an I-frame without its sequence header"
                                      : "a sequence header without an I-frame");
  }
  switch (packet.type) {
    case PacketType::kHeader:
      return TakeHeader(packet.payload);
    case PacketType::kIFrame:
      return TakeIFrame(packet.payload);
    case PacketType::kGroup:
      return TakeGroup(packet.payload, begin);
    case PacketType::kEnd:
      return TakeEnd(packet.payload, begin);
    case PacketType::kFrame:
      return TakeFrame(packet.payload);
    case PacketType::kGroupEnd:
      if (parser_) parser_->Close();
      return Status::Ok();
  }
  return Status::Corrupt("unknown packet");
}

Status Decoder::Impl::TakeHeader(std::span<const std::uint8_t> payload) {
  if (header && !mesh && settings.skip_damage) header.reset();  // its I-frame is lost; another stream may be here
  if (header) {
    after_header_ = std::ranges::equal(payload, header_bytes_);
    foreign_ = !after_header_;
    if (after_header_ || settings.skip_damage) return Status::Ok();
    return Status::Corrupt("a second sequence header that is not the first");
  }
  SequenceHeader parsed;
  SAC_RETURN_IF_ERROR(ParseSequenceHeader(payload, settings.limits, parsed));
  header = parsed;
  stream_info = InfoOf(parsed);
  header_bytes_.assign(payload.begin(), payload.end());
  after_header_ = true;
  return Status::Ok();
}

Status Decoder::Impl::TakeIFrame(std::span<const std::uint8_t> payload) {
  const std::uint32_t crc = Crc32(payload);
  if (!header) return settings.skip_damage ? Status::Ok() : Status::Corrupt("an I-frame before the sequence header");
  if (mesh) {
    foreign_ = foreign_ || crc != i_frame_crc_ || payload.size() != i_frame_size_;
    if (!foreign_ || settings.skip_damage) return Status::Ok();
    return Status::Corrupt("a second I-frame that is not the first");
  }
  SAC_RETURN_IF_ERROR(DecodeIFrame(payload));
  i_frame_crc_ = crc;
  i_frame_size_ = payload.size();
  const unsigned threads = header->references_previous() ? 1 : std::max(1u, settings.threads);
  source_.emplace(shape_, *header, UseThreads(threads, settings.limits, shape_));
  parser_.emplace(*header, shape_, settings.limits);
  places_.Start(packets_.position(), packets_.from_start());
  return Status::Ok();
}

Status Decoder::Impl::DecodeIFrame(std::span<const std::uint8_t> payload) {
  IFrameSyntax syntax;
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, *header, syntax));
  DracoMesh draco;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, *header, draco));
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, *header, std::move(draco), decoded));
  Mesh out;
  out.triangles = decoded.mesh.triangles;
  out.uvs = std::move(decoded.uvs);
  out.uv_triangles = std::move(decoded.uv_triangles);
  out.normals = std::move(decoded.normals);
  out.colors = std::move(decoded.colors);
  SAC_RETURN_IF_ERROR(BuildShape(*header, std::move(decoded.mesh), syntax.harmonics, syntax.samples_per_harmonic,
                                 LimitsOfIFrame(settings.limits, payload.size()), shape_));
  if (!SameFingerprint(Fingerprint(shape_.basis, shape_.patch_basis), syntax.fingerprint)) {
    return Status::Unsupported("the harmonics computed here are not the encoder's");
  }
  ToPositions(shape_.positions, out.positions);
  mesh = std::move(out);
  order = std::move(syntax.order);
  return Status::Ok();
}

Status Decoder::Impl::ContinueAt(std::uint32_t frame) {
  const std::uint64_t expected = next_frame_.value_or(frame);
  next_frame_ = frame;
  if (frame == expected) return Status::Ok();
  if (!settings.skip_damage) {
    return Status::Corrupt("frame " + std::to_string(frame) + " where frame " + std::to_string(expected) +
                           " is expected");
  }
  if (frame < expected) {
    next_frame_ = expected;
    return Status::Corrupt("frames that were there before");
  }
  lost.Add(static_cast<std::uint32_t>(expected), frame);
  return Status::Ok();
}

Status Decoder::Impl::TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!mesh) return settings.skip_damage ? Status::Ok() : Status::Corrupt("a group before the I-frame");
  if (foreign_) return Status::Ok();
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  CodedFrames frames;
  Status status = ParseGroup(payload, group, code);
  if (status.ok()) status = ContinueAt(group.first_frame);
  if (!status.ok()) return settings.skip_damage ? Status::Ok() : status;
  places_.Add(begin, group.first_frame);
  if (group.open()) {
    parser_->Open(group.first_frame);
    group_begins_ = true;
    return Status::Ok();
  }
  const std::uint64_t end = std::uint64_t{group.first_frame} + group.frames;
  next_frame_ = end;
  if (end <= wanted_) return Status::Ok();
  const HeldGroup sent{begin, payload.size(), Crc32(payload)};
  if (held_ == sent) {  // it has been sought again
    status = source_->Restart();
  } else {
    held_.reset();
    status = parser_->Parse(group, code, false, frames);
    if (status.ok()) status = source_->Take(std::move(frames), true);
  }
  if (IsDamage(status)) {
    lost.Add(group.first_frame, end);
    return Status::Ok();
  }
  SAC_RETURN_IF_ERROR(status);
  held_ = sent;
  next_out_ = group.first_frame;
  return Status::Ok();
}

Status Decoder::Impl::TakeFrame(std::span<const std::uint8_t> payload) {
  if (!parser_ || !parser_->is_open()) return Status::Ok();  // of a group that has been given up
  CodedFrames frames;
  Status status = parser_->ParseNext(payload, frames);
  if (status.ok()) {
    next_out_ = frames.first;
    next_frame_ = frames.end();
    held_.reset();
    status = source_->Take(std::move(frames), std::exchange(group_begins_, false));
  }
  if (!IsDamage(status)) return status;
  parser_->Close();
  return Status::Ok();
}

Status Decoder::Impl::TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!mesh) return settings.skip_damage ? Status::Ok() : Status::Corrupt("the end before the I-frame");
  if (foreign_) return Status::Ok();
  EndSyntax end;
  Status status = ParseEnd(payload, settings.limits, end);
  if (status.ok() && next_frame_ && *next_frame_ != end.frames) {
    if (settings.skip_damage && end.frames > *next_frame_) {
      lost.Add(static_cast<std::uint32_t>(*next_frame_), end.frames);
    } else {
      status = Status::Corrupt("end: " + std::to_string(end.frames) + " frames declared, " +
                               std::to_string(*next_frame_) + " found");
    }
  }
  if (status.ok() && end.index && packets_.from_start() && !lost.any() && !places_.Matches(*end.index, begin)) {
    status = Status::Corrupt("end: the index is not the stream's");
  }
  if (!status.ok()) return IsDamage(status) ? Status::Ok() : status;
  total_frames = end.frames;
  ended_ = true;
  return Status::Ok();
}

Status Decoder::Impl::Receive(Positions& positions, FrameInfo& info, const FrameBuffers* buffers) {
  while (true) {
    if (error_) return *error_;
    SAC_RETURN_IF_ERROR(Check(buffers));  // again when bytes that are read again have had the mesh in them
    if (!FrameWaits()) {
      if (!CanAdvance()) return Status::NeedMoreData();
      SAC_RETURN_IF_ERROR(AdvanceAlone());
      continue;
    }
    const auto frame = static_cast<std::uint32_t>(next_out_++);
    const bool shown = frame >= wanted_ && frame % settings.frame_step == 0;
    if (!shown && !header->references_previous()) continue;
    if (const Status status = source_->Reconstruct(frame, settings.frame_step, positions); !status.ok()) {
      if (!IsDamage(status)) return Latch(status);
      lost.Add(frame, std::uint64_t{frame} + 1);
      continue;
    }
    if (!shown) continue;
    GiveOut(frame, frame, positions, info, buffers);
    return Status::Ok();
  }
}

void Decoder::Impl::GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
                            const FrameBuffers* buffers) const {
  info.index = frame;
  info.intra = source_->IsIntra(frame);
  info.time = header->frame_rate_numerator == 0 ? 0 : time / header->frames_per_second();
  info.box = BoundingBox(positions);
  if (buffers) FillBuffers(positions, shape_.triangles, info.box, *buffers);
}

Status Decoder::Impl::Interpolate(double time, Positions& positions, FrameInfo& info, const FrameBuffers* buffers) {
  if (error_) return *error_;
  if (!(time >= 0 && time <= 0xfffffffeu)) return Status::InvalidArgument("a time that is no frame's");
  if (!source_) return Status::NeedMoreData();
  SAC_RETURN_IF_ERROR(Check(buffers));
  if (header->references_previous())
    return Status::Unsupported("frames measured against the frame before have none between");
  if (total_frames && time >= *total_frames) return BeyondTheEnd(time);
  if (total_frames) time = std::min(time, *total_frames - 1.0);
  const auto frame = static_cast<std::uint32_t>(time), after = static_cast<std::uint32_t>(std::ceil(time));
  while (!source_->Holds(frame) || !source_->Holds(after)) {
    if (next_frame_ && after < *next_frame_) {
      const std::string frames = "frame " + std::to_string(frame) + " or the next is ";
      return lost.Has(frame) || lost.Has(after) ? Status::Corrupt(frames + "lost")
                                                : Status::InvalidArgument(frames + "gone");
    }
    next_out_ = source_->frames().end();
    if (!CanAdvance()) {
      if (!ended_ && !finished_) return Status::NeedMoreData();
      return Status::InvalidArgument("frame " + std::to_string(frame) + " or the next is not there");
    }
    SAC_RETURN_IF_ERROR(AdvanceAlone());
  }
  wanted_ = std::max<std::uint64_t>(wanted_, after);
  SAC_RETURN_IF_ERROR(source_->Interpolate(time, positions));
  GiveOut(frame, time, positions, info, buffers);
  return Status::Ok();
}

Status Decoder::Impl::Seek(std::uint32_t frame, std::uint64_t& byte) {
  if (!source_) return Status::NeedMoreData();
  if (total_frames && frame >= *total_frames) return BeyondTheEnd(frame);
  const SeekTable::Place place = places_.Find(frame);
  byte = place.byte;
  packets_.Restart(byte);
  error_.reset();
  ended_ = finished_ = after_header_ = false;
  parser_->Close();
  next_frame_ = place.first_frame;
  foreign_ = false;
  if (!held_) source_->Drop();          // what cannot be known again, or is not whole
  next_out_ = source_->frames().end();  // none waits
  wanted_ = frame;
  return Status::Ok();
}

Status Decoder::Impl::AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed) {
  StreamIndex index;
  SAC_RETURN_IF_ERROR(ReadIndex(tail, settings.limits, index, needed));
  places_.Take(index);
  total_frames = 0;
  for (const StreamIndex::Group& group : index.groups) *total_frames += group.frames;
  return Status::Ok();
}

void Decoder::Impl::TakeCutGroup(std::span<const std::uint8_t> packet) {
  ByteReader reader(packet);
  const std::uint32_t tag = reader.Varint();
  if (!reader.ok() || static_cast<PacketType>(tag & 3) != PacketType::kGroup) return;
  auto payload = packet.subspan(reader.position());
  payload = payload.first(std::min<std::size_t>(payload.size(), tag / 4));  // the check may have begun
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  CodedFrames frames;
  if (!ParseGroup(payload, group, code).ok() || group.open()) return;
  // Its check is missing: what it says has to fit.
  const std::uint64_t end = std::uint64_t{group.first_frame} + group.frames;
  if (foreign_ || next_frame_.value_or(group.first_frame) != group.first_frame) return;
  if (end > total_frames.value_or(0xffffffffu)) return;
  next_frame_ = end;
  if (!parser_->Parse(group, code, true, frames).ok()) return lost.Add(group.first_frame, *next_frame_);
  while (!frames.frames.back().whole) frames.frames.pop_back();
  held_.reset();
  lost.Add(frames.end(), *next_frame_);
  if (source_->Take(std::move(frames), true).ok()) next_out_ = group.first_frame;
}

Status Decoder::Impl::Finish() {
  if (error_) return *error_;
  const auto truncated = [this] { return Truncated(packets_.position(), next_frame_.value_or(0)); };
  if (!settings.skip_damage) return ended_ && !FrameWaits() ? Status::Ok() : Latch(truncated());
  finished_ = true;
  while (!FrameWaits() && CanAdvance()) SAC_RETURN_IF_ERROR(AdvanceAlone());
  return ended_ || (FrameWaits() && packets_.HasMore()) ? Status::Ok() : truncated();
}

Decoder::Decoder(const DecoderSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

Status Decoder::Send(std::span<const std::uint8_t>& bytes) {
  return impl_->Contain([&] { return impl_->Send(bytes); });
}
Status Decoder::Receive(DecodedFrame& frame) {
  return impl_->Contain([&] { return impl_->Receive(frame.positions, frame); });
}
Status Decoder::Interpolate(double time, DecodedFrame& frame) {
  return impl_->Contain([&] { return impl_->Interpolate(time, frame.positions, frame); });
}
Status Decoder::Finish() {
  return impl_->Contain([&] { return impl_->Finish(); });
}
Status Decoder::Seek(std::uint32_t frame, std::uint64_t& byte) {
  return impl_->Contain([&] { return impl_->Seek(frame, byte); });
}
Status Decoder::AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed) {
  return impl_->Contain([&] { return impl_->AddIndex(tail, needed); });
}
void Decoder::Reset() { impl_ = std::make_unique<Impl>(impl_->settings); }
const StreamInfo* Decoder::info() const { return impl_->header ? &impl_->stream_info : nullptr; }
const Mesh* Decoder::mesh() const { return impl_->mesh ? &*impl_->mesh : nullptr; }
const std::vector<std::uint32_t>& Decoder::order() const { return impl_->order; }
std::optional<std::uint32_t> Decoder::frames() const { return impl_->total_frames; }
const std::vector<FrameRange>& Decoder::lost_frames() const { return impl_->lost.ranges(); }

Status Decoder::Receive(const FrameBuffers& buffers, FrameInfo& info) {
  Positions positions;
  return impl_->Contain([&] { return impl_->Receive(positions, info, &buffers); });
}

Status Decoder::Interpolate(double time, const FrameBuffers& buffers, FrameInfo& info) {
  Positions positions;
  return impl_->Contain([&] { return impl_->Interpolate(time, positions, info, &buffers); });
}

Status Decoder::SeekTime(double seconds, std::uint64_t& byte) {
  if (!info()) return Status::NeedMoreData();
  if (info()->frame_rate_numerator == 0) return Status::InvalidArgument("the stream has no frame rate");
  const double time = seconds * info()->frames_per_second();
  const double frame = std::floor(time + 1e-9 + 4e-16 * time);  // of frames' own times, too
  if (!(frame >= 0 && frame <= 0xffffffffu)) return Status::InvalidArgument("a time that is no frame's");
  return Seek(static_cast<std::uint32_t>(frame), byte);
}

}  // namespace sac
