// fpzip on each coordinate as an array of vertices by frames, with so many bits of each float kept.
#include <fpzip.h>

#include <algorithm>

#include "bench/peers/connectivity.h"
#include "bench/peers/peer.h"
#include "format/bytes.h"

namespace sac::bench {
namespace {

constexpr std::size_t kMargin = 1024;  // for what cannot be compressed

void Describe(FPZ& fpz, int bits, std::size_t vertices, std::size_t frames) {
  fpz.type = FPZIP_TYPE_FLOAT;
  fpz.prec = bits;
  fpz.nx = static_cast<int>(vertices);
  fpz.ny = static_cast<int>(frames);
  fpz.nz = 1;
  fpz.nf = 3;
}

Status Encode(const PeerClip& clip, const std::string& setting, PeerStream& stream) {
  double bits = 0;
  if (!ParseNumber(setting, bits)) return Status::InvalidArgument(setting + ": not a number of bits");
  ByteWriter out;
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
  stream.order = connectivity.order;
  const std::size_t n = stream.order.size(), frames = clip.frames.size();
  std::vector<float> values;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const Positions& frame : clip.frames) {
      for (const std::uint32_t v : stream.order) values.push_back(frame[v][a]);
    }
  }
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float) * 5 / 4 + kMargin);
  FPZ* fpz = fpzip_write_to_buffer(bytes.data(), bytes.size());
  Describe(*fpz, static_cast<int>(bits), n, frames);
  const std::size_t size = fpzip_write(fpz, values.data());
  fpzip_write_close(fpz);
  if (size == 0) return Status::Unsupported(std::string("fpzip: ") + fpzip_errstr[fpzip_errno]);
  out.Varint(static_cast<std::uint32_t>(frames));
  out.U8(static_cast<std::uint8_t>(bits));
  out.Bytes({bytes.data(), size});
  stream.bytes = out.bytes();
  return Status::Ok();
}

Status Decode(std::span<const std::uint8_t> bytes, PeerClip& clip) {
  ByteReader in(bytes);
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
  const std::size_t n = connectivity.vertices, frames = in.Varint();
  const int bits = in.U8();
  const auto code = in.Bytes(in.remaining());
  if (!in.ok()) return Status::Corrupt("truncated stream");
  std::vector<float> values(3 * n * frames);
  FPZ* fpz = fpzip_read_from_buffer(code.data());
  Describe(*fpz, bits, n, frames);
  const std::size_t size = fpzip_read(fpz, values.data());
  fpzip_read_close(fpz);
  if (size == 0) return Status::Corrupt(std::string("fpzip: ") + fpzip_errstr[fpzip_errno]);
  clip.triangles = connectivity.triangles;
  clip.frames.assign(frames, Positions(n));
  for (std::size_t i = 0; i < values.size(); ++i) clip.frames[i / n % frames][i % n][i / (n * frames)] = values[i];
  return Status::Ok();
}

std::string Version() { return std::to_string(FPZIP_VERSION_MAJOR) + "." + std::to_string(FPZIP_VERSION_MINOR); }

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(argc, argv,
                             {"fpzip, vertices by frames",
                              sac::bench::Version(),
                              "bits of a float",
                              {"14", "16", "18", "20", "22", "24"},
                              sac::bench::Encode,
                              sac::bench::Decode});
}
