// SPDX-License-Identifier: Apache-2.0
// xz on the indices of the triangles, followed by the floats of all frames. It is lossless.
#include <lzma.h>

#include <cstring>

#include "bench/peers/peer.h"
#include "format/bytes.h"

namespace sac::bench {
namespace {

Status Encode(const Clip& clip, const std::string& setting, PeerStream& stream) {
  double level = 0;
  if (!ParseNumber(setting, level)) return Status::InvalidArgument(setting + ": not a level");
  ByteWriter raw;
  raw.U32(static_cast<std::uint32_t>(clip.mesh.triangles.size()));
  raw.U32(static_cast<std::uint32_t>(clip.vertices()));
  raw.U32(static_cast<std::uint32_t>(clip.frames.size()));
  for (const Triangle& t : clip.mesh.triangles) {
    for (const std::uint32_t v : t) raw.U32(v);
  }
  for (const Positions& frame : clip.frames) {
    for (const Vec3f& p : frame) {
      for (const float x : p) raw.F32(x);
    }
  }
  stream.bytes.resize(lzma_stream_buffer_bound(raw.size()) + 8);
  std::size_t size = 0;
  const lzma_ret result =
      lzma_easy_buffer_encode(static_cast<std::uint32_t>(level), LZMA_CHECK_CRC32, nullptr, raw.bytes().data(),
                              raw.size(), stream.bytes.data(), &size, stream.bytes.size());
  if (result != LZMA_OK) return Status::Unsupported("xz: error " + std::to_string(result));
  stream.bytes.resize(size);
  for (std::uint32_t v = 0; v < clip.vertices(); ++v) stream.order.push_back(v);
  return Status::Ok();
}

Status Decompress(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& raw) {
  lzma_stream xz = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&xz, UINT64_MAX, 0) != LZMA_OK) return Status::Corrupt("xz: no decoder");
  xz.next_in = bytes.data();
  xz.avail_in = bytes.size();
  lzma_ret result = LZMA_OK;
  while (result == LZMA_OK) {
    raw.resize(2 * raw.size() + 65536);
    xz.next_out = raw.data() + xz.total_out;
    xz.avail_out = raw.size() - xz.total_out;
    result = lzma_code(&xz, LZMA_FINISH);
  }
  raw.resize(xz.total_out);
  lzma_end(&xz);
  return result == LZMA_STREAM_END ? Status::Ok() : Status::Corrupt("xz: error " + std::to_string(result));
}

Status Decode(std::span<const std::uint8_t> bytes, Clip& clip) {
  std::vector<std::uint8_t> raw;
  SAC_RETURN_IF_ERROR(Decompress(bytes, raw));
  ByteReader in(raw);
  clip.mesh.triangles.resize(in.U32());
  const std::uint32_t vertices = in.U32(), frames = in.U32();
  for (Triangle& t : clip.mesh.triangles) {
    for (std::uint32_t& v : t) v = in.U32();
  }
  clip.frames.assign(frames, Positions(vertices));
  for (Positions& frame : clip.frames) {
    for (Vec3f& p : frame) {
      for (float& x : p) x = in.F32();
    }
  }
  return in.ok() ? Status::Ok() : Status::Corrupt("truncated stream");
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(
      argc, argv, {"xz of the floats", lzma_version_string(), "level", {"9"}, sac::bench::Encode, sac::bench::Decode});
}
