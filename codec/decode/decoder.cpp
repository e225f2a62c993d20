#include "codec/decode/decoder.h"

#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "codec/decode/i_frame.h"
#include "codec/reconstruct.h"
#include "codec/shape.h"
#include "format/bytes.h"
#include "format/frame_coder.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"

namespace sac {
namespace {

Positions ToPositions(const PositionMatrix& matrix) {
  Positions out(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t v = 0; v < out.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      out[v][a] = static_cast<float>(matrix(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)));
    }
  }
  return out;
}

}  // namespace

class Decoder::Impl {
 public:
  explicit Impl(const DecoderSettings& settings) : limits_(settings.limits), packets_(settings.limits) {}

  Status Send(std::span<const std::uint8_t>& bytes);
  Status Receive(DecodedFrame& frame);
  Status Finish();

  std::optional<SequenceHeader> header;
  std::optional<Mesh> mesh;
  std::vector<std::uint32_t> order;

 private:
  Status Take(Packet packet);
  Status TakeIFrame(std::span<const std::uint8_t> payload);
  Status TakeGroup(std::span<const std::uint8_t> payload);
  Status TakeFrame(std::span<const std::uint8_t> payload);
  Status TakeEnd(std::span<const std::uint8_t> payload);
  // Whether a group of so many frames is within the limits.
  Status CheckGroupSize(std::uint32_t frames) const;
  // Parses the frame of `slot`; `intra`: whether it is predicted from none.
  Status ParseFrame(const FrameSlot& slot, RangeDecoder& range, FrameCoder<RangeDecoder>& coder, bool& intra) const;
  Status DecodeFrame(DecodedFrame& frame);
  Status Latch(Status status) {
    if (!status.ok()) error_ = status;
    return status;
  }

  Limits limits_;
  PacketReader packets_;
  std::optional<Status> error_;
  bool ended_ = false;
  std::uint32_t frame_count_ = 0;

  Shape shape_;  // the members below refer to it
  std::unique_ptr<Reconstructor> reconstructor_;

  // The group being decoded: its frames by time.
  std::vector<FrameCoefficients> group_;
  std::vector<bool> group_intra_;
  std::size_t next_in_group_ = 0;

  std::optional<FrameCoder<RangeDecoder>> open_group_;  // whose frames come one by one
};

Status Decoder::Impl::Send(std::span<const std::uint8_t>& bytes) {
  if (error_) return *error_;
  if (next_in_group_ < group_.size()) return Status::Ok();
  if (ended_) return bytes.empty() ? Status::Ok() : Latch(Status::Corrupt("bytes after the end of the stream"));
  std::optional<Packet> packet;
  SAC_RETURN_IF_ERROR(Latch(packets_.Read(bytes, packet)));
  if (!packet) return Status::Ok();
  try {
    return Latch(Take(std::move(*packet)));
  } catch (const std::exception& e) {  // memory: the limits allow more than there is
    return Latch(Status::Limit(e.what()));
  }
}

Status Decoder::Impl::Take(Packet packet) {
  switch (packet.type) {
    case PacketType::kHeader: {
      if (header) return Status::Corrupt("a second sequence header");
      SequenceHeader parsed;
      SAC_RETURN_IF_ERROR(ParseSequenceHeader(packet.payload, limits_, parsed));
      header = parsed;
      return Status::Ok();
    }
    case PacketType::kIFrame:
      if (!header || mesh) return Status::Corrupt("an I-frame out of place");
      return TakeIFrame(packet.payload);
    case PacketType::kGroup:
      if (!mesh) return Status::Corrupt("a group before the I-frame");
      return TakeGroup(packet.payload);
    case PacketType::kEnd:
      if (!mesh) return Status::Corrupt("the end before the I-frame");
      return TakeEnd(packet.payload);
    case PacketType::kFrame:
      return TakeFrame(packet.payload);
    case PacketType::kGroupEnd:
      open_group_.reset();
      return Status::Ok();
  }
  return Status::Corrupt("unknown packet");
}

Status Decoder::Impl::TakeIFrame(std::span<const std::uint8_t> payload) {
  IFrameSyntax syntax;
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, *header, syntax));
  DracoMesh draco;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, *header, draco));
  if (!draco.ids.empty()) return Status::Corrupt("I-frame: an unknown attribute");
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, *header, std::move(draco), decoded));
  Mesh out;
  out.triangles = decoded.mesh.triangles;
  out.uvs = std::move(decoded.uvs);
  out.uv_triangles = std::move(decoded.uv_triangles);
  out.normals = std::move(decoded.normals);
  out.colors = std::move(decoded.colors);
  SAC_RETURN_IF_ERROR(
      BuildShape(*header, std::move(decoded.mesh), syntax.harmonics, syntax.samples_per_harmonic, limits_, shape_));
  if (!SameFingerprint(shape_.basis.Fingerprint(), syntax.fingerprint)) {
    return Status::Unsupported("the harmonics computed here are not the encoder's");
  }
  out.positions = ToPositions(shape_.positions);
  mesh = std::move(out);
  order = std::move(syntax.order);
  reconstructor_ = std::make_unique<Reconstructor>(shape_, *header);
  return Status::Ok();
}

Status Decoder::Impl::CheckGroupSize(std::uint32_t frames) const {
  if (frames > limits_.frames_per_group) {
    return Status::Limit(std::to_string(frames) + " frames in a group, the limit is " +
                         std::to_string(limits_.frames_per_group));
  }
  if (frames * FrameValues(shape_.layouts) > limits_.group_values) {
    return Status::Limit("a group holds more coefficients than the limit");
  }
  return Status::Ok();
}

Status Decoder::Impl::ParseFrame(const FrameSlot& slot, RangeDecoder& range, FrameCoder<RangeDecoder>& coder,
                                 bool& intra) const {
  FrameSyntax frame;
  if (!coder.Code(range, slot, frame)) return Status::Corrupt("malformed coefficients");
  const bool previous = header->reference_shape == static_cast<std::uint8_t>(ReferenceShape::kPrevious);
  if (previous && !frame.intra() && frame.slot.references != slot.references) {
    return Status::Corrupt("not predicted from the frame before");
  }
  intra = frame.intra();
  return Status::Ok();
}

Status Decoder::Impl::TakeGroup(std::span<const std::uint8_t> payload) {
  ByteReader reader(payload);
  const std::uint32_t frames = reader.Varint();
  const bool opens = frames == kOpenGroup && reader.remaining() == 0;
  if (!reader.ok() || (frames == 0 && !opens)) return Status::Corrupt("group: malformed number of frames");
  if (opens) {
    open_group_.emplace(*header, shape_.layouts);
    return reconstructor_->StartGroup() ? Status::Ok() : Status::Corrupt("the first frame's shape is singular");
  }
  SAC_RETURN_IF_ERROR(CheckGroupSize(frames));
  if (frames > 0xffffffffu - frame_count_) return Status::Corrupt("group: too many frames");
  const std::uint32_t pyramid = reader.Varint();
  if (!reader.ok() || pyramid == 0) return Status::Corrupt("group: malformed pyramid");
  const bool previous = header->reference_shape == static_cast<std::uint8_t>(ReferenceShape::kPrevious);
  if (previous && pyramid != 1) return Status::Corrupt("group: B-frames against the previous frame");

  RangeDecoder range(payload.subspan(reader.position()));
  FrameCoder<RangeDecoder> coder(*header, shape_.layouts);
  const std::vector<FrameSlot> structure = GroupStructure(frames, pyramid);
  group_.assign(frames, FrameCoefficients());
  group_intra_.assign(frames, false);
  next_in_group_ = frames;  // none is ready before all are parsed
  for (const FrameSlot& slot : structure) {
    bool intra = false;
    if (const Status s = ParseFrame(slot, range, coder, intra); !s.ok()) {
      return {s.code(), "frame " + std::to_string(frame_count_ + slot.display) + ": " + s.message()};
    }
    group_intra_[slot.display] = intra;
  }
  if (!range.AtEnd()) return Status::Corrupt("group: bytes after the last frame");
  std::vector<FrameCoefficients> coded = coder.TakeFrames();
  for (std::size_t i = 0; i < structure.size(); ++i) group_[structure[i].display] = std::move(coded[i]);
  if (!reconstructor_->StartGroup()) return Status::Corrupt("the first frame's shape is singular");
  next_in_group_ = 0;
  return Status::Ok();
}

Status Decoder::Impl::TakeFrame(std::span<const std::uint8_t> payload) {
  const auto index = static_cast<std::uint32_t>(open_group_->predictor().frames().size());
  SAC_RETURN_IF_ERROR(CheckGroupSize(index + 1));
  if (frame_count_ == 0xffffffffu) return Status::Corrupt("group: too many frames");
  const auto where = [&] { return "frame " + std::to_string(frame_count_) + ": "; };
  RangeDecoder range(payload);
  bool intra = false;
  const Status s = ParseFrame(ChainSlot(index), range, *open_group_, intra);
  if (!s.ok()) return {s.code(), where() + s.message()};
  if (!range.AtEnd()) return Status::Corrupt(where() + "bytes after its end");
  group_.assign(1, open_group_->predictor().frames().back());
  group_intra_.assign(1, intra);
  next_in_group_ = 0;
  return Status::Ok();
}

Status Decoder::Impl::TakeEnd(std::span<const std::uint8_t> payload) {
  ByteReader reader(payload);
  const std::uint32_t frames = reader.Varint();
  if (!reader.ok() || reader.remaining() != 0) return Status::Corrupt("end: wrong length");
  if (frames != frame_count_) {
    return Status::Corrupt("end: " + std::to_string(frames) + " frames declared, " + std::to_string(frame_count_) +
                           " found");
  }
  ended_ = true;
  return Status::Ok();
}

Status Decoder::Impl::Receive(DecodedFrame& frame) {
  if (error_) return *error_;
  if (next_in_group_ == group_.size()) return Status::NeedMoreData();
  try {
    return Latch(DecodeFrame(frame));
  } catch (const std::exception& e) {
    return Latch(Status::Limit(e.what()));
  }
}

Status Decoder::Impl::DecodeFrame(DecodedFrame& out) {
  out.index = frame_count_;
  out.intra = group_intra_[next_in_group_];
  if (!reconstructor_->StartFrame(out.intra)) {
    return Status::Corrupt("frame " + std::to_string(frame_count_) + ": the reference shape is singular");
  }
  const PositionMatrix positions = reconstructor_->Reconstruct(group_[next_in_group_]);
  if (!(positions.array().abs() <= std::numeric_limits<float>::max()).all()) {
    return Status::Corrupt("frame " + std::to_string(frame_count_) + ": positions that are not finite");
  }
  out.positions = ToPositions(positions);
  ++next_in_group_;
  ++frame_count_;
  return Status::Ok();
}

Status Decoder::Impl::Finish() {
  if (error_) return *error_;
  if (!ended_ || next_in_group_ < group_.size()) {
    return Latch(Truncated(packets_.position(), frame_count_));
  }
  return Status::Ok();
}

Decoder::Decoder(const DecoderSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

Status Decoder::Send(std::span<const std::uint8_t>& bytes) { return impl_->Send(bytes); }
Status Decoder::Receive(DecodedFrame& frame) { return impl_->Receive(frame); }
Status Decoder::Finish() { return impl_->Finish(); }
const SequenceHeader* Decoder::header() const { return impl_->header ? &*impl_->header : nullptr; }
const Mesh* Decoder::mesh() const { return impl_->mesh ? &*impl_->mesh : nullptr; }
const std::vector<std::uint32_t>& Decoder::order() const { return impl_->order; }

}  // namespace sac
