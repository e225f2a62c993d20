// SPDX-License-Identifier: Apache-2.0
// fpzip on each coordinate as an array of vertices by frames. The setting is the number of bits of each float that are
// kept.
#include <fpzip.h>

#include <algorithm>

#include "bench/peers/array_peer.h"

namespace sac::bench {
namespace {

constexpr std::size_t kMargin = 1024;  // bytes of room for data that cannot be compressed

void Describe(FPZ& fpz, int bits, std::size_t vertices, std::size_t frames) {
  fpz.type = FPZIP_TYPE_FLOAT;
  fpz.prec = bits;
  fpz.nx = static_cast<int>(vertices);
  fpz.ny = static_cast<int>(frames);
  fpz.nz = 1;
  fpz.nf = 3;
}

Status Encode(const std::vector<Positions>& frames, double bits, ByteWriter& out) {
  const std::size_t n = frames.front().size();
  std::vector<float> values;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const Positions& frame : frames) {
      for (const Vec3f& p : frame) values.push_back(p[a]);
    }
  }
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float) * 5 / 4 + kMargin);
  FPZ* fpz = fpzip_write_to_buffer(bytes.data(), bytes.size());
  Describe(*fpz, static_cast<int>(bits), n, frames.size());
  const std::size_t size = fpzip_write(fpz, values.data());
  fpzip_write_close(fpz);
  if (size == 0) return Status::Unsupported(std::string("fpzip: ") + fpzip_errstr[fpzip_errno]);
  out.U8(static_cast<std::uint8_t>(bits));
  out.Bytes({bytes.data(), size});
  return Status::Ok();
}

Status Decode(ByteReader& in, std::vector<Positions>& frames) {
  const std::size_t n = frames.front().size();
  const int bits = in.U8();
  const auto code = in.Bytes(in.remaining());
  std::vector<float> values(3 * n * frames.size());
  FPZ* fpz = fpzip_read_from_buffer(code.data());
  Describe(*fpz, bits, n, frames.size());
  const std::size_t size = fpzip_read(fpz, values.data());
  fpzip_read_close(fpz);
  if (size == 0) return Status::Corrupt(std::string("fpzip: ") + fpzip_errstr[fpzip_errno]);
  for (std::size_t i = 0; i < values.size(); ++i)
    frames[i / n % frames.size()][i % n][i / (n * frames.size())] = values[i];
  return Status::Ok();
}

std::string Version() { return std::to_string(FPZIP_VERSION_MAJOR) + "." + std::to_string(FPZIP_VERSION_MINOR); }

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunArrayPeer(argc, argv,
                                  {"fpzip, vertices by frames",
                                   sac::bench::Version(),
                                   "bits of a float",
                                   {"14", "16", "18", "20", "22", "24"},
                                   sac::bench::Encode,
                                   sac::bench::Decode});
}
