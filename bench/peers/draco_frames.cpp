// SPDX-License-Identifier: Apache-2.0
// Draco's mesh codec, frame by frame. Every frame is coded as a mesh of its own, with its connectivity.
#include <draco/core/draco_version.h>

#include "bench/peers/connectivity.h"
#include "bench/peers/peer.h"
#include "format/bytes.h"

namespace sac::bench {
namespace {

Status Encode(const Clip& clip, const std::string& setting, PeerStream& stream) {
  double bits = 0;
  if (!ParseNumber(setting, bits)) return Status::InvalidArgument(setting + ": not a number of bits");
  SAC_RETURN_IF_ERROR(OrderOfDraco(clip.mesh.triangles, clip.vertices(), stream.order));
  ByteWriter out;
  for (const Positions& frame : clip.frames) {
    std::vector<std::uint8_t> bytes;
    SAC_RETURN_IF_ERROR(EncodeWithDraco(clip.mesh.triangles, frame, static_cast<int>(bits), bytes));
    out.Varint(static_cast<std::uint32_t>(bytes.size()));
    out.Bytes(bytes);
  }
  stream.bytes = out.bytes();
  return Status::Ok();
}

Status Decode(std::span<const std::uint8_t> bytes, Clip& clip) {
  ByteReader in(bytes);
  while (in.ok() && in.remaining() > 0) {
    const std::uint32_t size = in.Varint();
    SAC_RETURN_IF_ERROR(DecodeWithDraco(in.Bytes(size), clip.mesh.triangles, clip.frames.emplace_back()));
  }
  return in.ok() ? Status::Ok() : Status::Corrupt("truncated stream");
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(argc, argv,
                             {"Draco, frame by frame",
                              draco::kDracoVersion,
                              "bits",
                              {"7", "8", "9", "10", "11", "12", "13", "14"},
                              sac::bench::Encode,
                              sac::bench::Decode});
}
