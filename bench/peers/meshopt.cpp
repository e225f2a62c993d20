// SPDX-License-Identifier: Apache-2.0
// meshoptimizer's vertex codec on differences from frame to frame, then zstd. Coordinates are quantized to `bits` bits
// of the clip's largest extent.
#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/peers/array_peer.h"

namespace sac::bench {
namespace {

using Packed =
    std::array<std::uint16_t, 4>;  // three coordinates and padding, since the codec takes multiples of four bytes

Status Encode(const std::vector<Positions>& frames, double bits, ByteWriter& out) {
  Vec3f low = frames[0][0], high = low;
  for (const Positions& frame : frames) {
    for (const Vec3f& p : frame) {
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
  }
  const float extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30f});
  const float step = extent / static_cast<float>((1 << static_cast<int>(bits)) - 1);
  for (const float value : {low[0], low[1], low[2], step}) out.F32(value);

  const std::size_t n = frames.front().size();
  std::vector<Packed> last(n), difference(n);
  std::vector<std::uint8_t> code(meshopt_encodeVertexBufferBound(n, sizeof(Packed))), all;
  for (const Positions& frame : frames) {
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        const auto value = static_cast<std::uint16_t>(std::lround((frame[v][a] - low[a]) / step));
        difference[v][a] = static_cast<std::uint16_t>(value - last[v][a]);
        last[v][a] = value;
      }
    }
    const std::size_t size = meshopt_encodeVertexBuffer(code.data(), code.size(), difference.data(), n, sizeof(Packed));
    ByteWriter frame_bytes;
    frame_bytes.Varint(static_cast<std::uint32_t>(size));
    frame_bytes.Bytes({code.data(), size});
    all.insert(all.end(), frame_bytes.bytes().begin(), frame_bytes.bytes().end());
  }
  std::vector<std::uint8_t> packed(ZSTD_compressBound(all.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), all.data(), all.size(), 19);
  if (ZSTD_isError(size) != 0) return Status::Unsupported(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.Varint(static_cast<std::uint32_t>(all.size()));
  out.Bytes({packed.data(), size});
  return Status::Ok();
}

Status Decode(ByteReader& in, std::vector<Positions>& frames) {
  const Vec3f low{in.F32(), in.F32(), in.F32()};
  const float step = in.F32();
  std::vector<std::uint8_t> all(in.Varint());
  const auto packed = in.Bytes(in.remaining());
  const std::size_t size = ZSTD_decompress(all.data(), all.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) != 0 || size != all.size()) return Status::Corrupt("zstd");
  const std::size_t n = frames.front().size();
  std::vector<Packed> last(n), difference(n);
  ByteReader code(all);
  for (Positions& positions : frames) {
    const auto frame = code.Bytes(code.Varint());
    if (meshopt_decodeVertexBuffer(difference.data(), n, sizeof(Packed), frame.data(), frame.size()) != 0) {
      return Status::Corrupt("meshoptimizer");
    }
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        last[v][a] = static_cast<std::uint16_t>(last[v][a] + difference[v][a]);
        positions[v][a] = low[a] + step * static_cast<float>(last[v][a]);
      }
    }
  }
  return Status::Ok();
}

std::string Version() {
  return std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." + std::to_string(MESHOPTIMIZER_VERSION / 10 % 100) +
         ", zstd " + ZSTD_versionString() + " -19";
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunArrayPeer(argc, argv,
                                  {"meshoptimizer on frame differences, zstd",
                                   sac::bench::Version(),
                                   "bits",
                                   {"7", "8", "9", "10", "11", "12", "13", "14"},
                                   sac::bench::Encode,
                                   sac::bench::Decode});
}
