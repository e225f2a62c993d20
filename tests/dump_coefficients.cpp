// Prints a checksum of each frame's integers: what prediction and residuals add up to, without any float.
// usage: dump_coefficients CLIP.sac
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/decode/draco_mesh.h"
#include "codec/decode/i_frame.h"
#include "codec/prediction.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/frame_syntax.h"
#include "format/group_structure.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"

namespace sac {
namespace {

std::uint32_t AddToCrc(std::span<const std::int32_t> values, std::uint32_t crc) {
  for (const std::int32_t value : values) {
    const auto u = static_cast<std::uint32_t>(value);
    const std::uint8_t bytes[4] = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(u >> 8),
                                   static_cast<std::uint8_t>(u >> 16), static_cast<std::uint8_t>(u >> 24)};
    crc = Crc32(bytes, crc);
  }
  return crc;
}

class Dump {
 public:
  Status Take(const Packet& packet) {
    switch (packet.type) {
      case PacketType::kHeader:
        return ParseSequenceHeader(packet.payload, limits_, header_);
      case PacketType::kIFrame:
        return TakeIFrame(packet.payload);
      case PacketType::kGroup:
        return TakeGroup(packet.payload);
      case PacketType::kEnd:
        return Status::Ok();
    }
    return Status::Corrupt("unknown packet");
  }

 private:
  Status TakeIFrame(std::span<const std::uint8_t> payload) {
    IFrameSyntax syntax;
    SAC_RETURN_IF_ERROR(ParseIFrame(payload, header_, syntax));
    DracoMesh draco;
    SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, header_, draco));
    DecodedIFrame decoded;
    SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, header_, std::move(draco), decoded));
    std::vector<std::uint32_t> patch_sizes;
    for (const Component& patch : decoded.mesh.patches) patch_sizes.push_back(patch.count);
    layouts_ = LayOutPlanes(header_, syntax.harmonics, patch_sizes);
    return Status::Ok();
  }

  Status TakeGroup(std::span<const std::uint8_t> payload) {
    ByteReader reader(payload);
    const std::uint32_t frames = reader.Varint();
    const std::uint32_t pyramid = reader.Varint();
    if (!reader.ok()) return Status::Corrupt("malformed group");
    RangeDecoder range(payload.subspan(reader.position()));
    FrameCoder<RangeDecoder> coder(layouts_);
    Predictor predictor(header_, layouts_);
    for (const FrameSlot& slot : GroupStructure(frames, pyramid)) {
      FrameSyntax syntax;
      if (!coder.Code(range, slot, syntax) || !predictor.Add(syntax)) return Status::Corrupt("malformed frame");
      const FrameCoefficients& sums = predictor.frames().back();
      std::uint32_t crc = AddToCrc(sums.rigid, 0);
      for (const PlaneValues& plane : sums.planes) crc = AddToCrc(plane, crc);
      std::printf("frame %u references %zu crc %08x\n", first_ + slot.display, syntax.slot.references.size(), crc);
    }
    first_ += frames;
    return Status::Ok();
  }

  Limits limits_;
  SequenceHeader header_;
  PlaneLayouts layouts_;
  std::uint32_t first_ = 0;  // frame of the next group
};

Status DumpStream(std::span<const std::uint8_t> bytes) {
  PacketReader packets{Limits{}};
  Dump dump;
  for (;;) {
    std::optional<Packet> packet;
    SAC_RETURN_IF_ERROR(packets.Read(bytes, packet));
    if (packet) {
      SAC_RETURN_IF_ERROR(dump.Take(*packet));
    } else if (bytes.empty()) {
      return packets.AtBoundary() ? Status::Ok() : Status::Corrupt("truncated");
    }
  }
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s CLIP.sac\n", argv[0]);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  const sac::Status status = sac::DumpStream(bytes);
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", argv[1], status.message().c_str());
  return status.ok() ? 0 : 1;
}
