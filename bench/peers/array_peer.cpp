// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/array_peer.h"

#include "bench/peers/connectivity.h"

namespace sac::bench {

int RunArrayPeer(int argc, char** argv, const ArrayPeer& peer) {
  const auto encode = [&](const Clip& clip, const std::string& setting, PeerStream& stream) {
    double number = 0;
    if (!ParseNumber(setting, number)) return Status::InvalidArgument(setting + ": not a number");
    ByteWriter out;
    Connectivity connectivity;
    SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
    stream.order = connectivity.order;
    std::vector<Positions> frames;
    for (const Positions& frame : clip.frames) {
      Positions& ordered = frames.emplace_back();
      for (const std::uint32_t v : stream.order) ordered.push_back(frame[v]);
    }
    out.Varint(static_cast<std::uint32_t>(frames.size()));
    SAC_RETURN_IF_ERROR(peer.encode(frames, number, out));
    stream.bytes = out.bytes();
    return Status::Ok();
  };
  const auto decode = [&](std::span<const std::uint8_t> bytes, Clip& clip) {
    ByteReader in(bytes);
    Connectivity connectivity;
    SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
    clip.mesh.triangles = connectivity.triangles;
    clip.frames.assign(in.Varint(), Positions(connectivity.vertices));
    if (clip.frames.empty()) return Status::Corrupt("no frames");
    SAC_RETURN_IF_ERROR(peer.decode(in, clip.frames));
    return in.ok() ? Status::Ok() : Status::Corrupt("truncated stream");
  };
  return RunPeer(argc, argv, {peer.title, peer.version, peer.parameter, peer.settings, encode, decode});
}

}  // namespace sac::bench
