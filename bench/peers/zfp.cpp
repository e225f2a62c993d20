// SPDX-License-Identifier: Apache-2.0
// zfp on each coordinate as an array of vertices by frames, in zfp's fixed-accuracy mode.
#include <zfp.h>

#include "bench/peers/array_peer.h"
#include "geometry/bounding_box.h"

namespace sac::bench {
namespace {

// The array of one coordinate, frame after frame, which zfp divides into blocks of 4 by 4.
struct Array {
  std::vector<float> values;
  zfp_field* field;
  zfp_stream* zfp = zfp_stream_open(nullptr);

  Array(std::size_t vertices, std::size_t frames)
      : values(vertices * frames), field(zfp_field_2d(values.data(), zfp_type_float, vertices, frames)) {}
  ~Array() {
    zfp_field_free(field);
    zfp_stream_close(zfp);
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
};

Status Encode(const std::vector<Positions>& frames, double accuracy, ByteWriter& out) {
  const std::size_t n = frames.front().size();
  const double tolerance = accuracy * BoundingBox(frames.front()).diagonal();
  out.F32(static_cast<float>(tolerance));
  for (std::size_t a = 0; a < 3; ++a) {
    Array array(n, frames.size());
    for (std::size_t i = 0; i < array.values.size(); ++i) array.values[i] = frames[i / n][i % n][a];
    zfp_stream_set_accuracy(array.zfp, static_cast<double>(static_cast<float>(tolerance)));
    std::vector<std::uint8_t> bytes(zfp_stream_maximum_size(array.zfp, array.field));
    bitstream* bits = stream_open(bytes.data(), bytes.size());
    zfp_stream_set_bit_stream(array.zfp, bits);
    zfp_stream_rewind(array.zfp);
    const std::size_t size = zfp_compress(array.zfp, array.field);
    stream_close(bits);
    if (size == 0) return Status::Unsupported("zfp: cannot compress");
    out.Varint(static_cast<std::uint32_t>(size));
    out.Bytes({bytes.data(), size});
  }
  return Status::Ok();
}

Status Decode(ByteReader& in, std::vector<Positions>& frames) {
  const std::size_t n = frames.front().size();
  const auto tolerance = static_cast<double>(in.F32());
  for (std::size_t a = 0; a < 3; ++a) {
    const auto part = in.Bytes(in.Varint());
    std::vector<std::uint8_t> words(part.begin(), part.end());  // padded below, since zfp reads whole words
    words.resize(words.size() + 16);
    Array array(n, frames.size());
    zfp_stream_set_accuracy(array.zfp, tolerance);
    bitstream* bits = stream_open(words.data(), words.size());
    zfp_stream_set_bit_stream(array.zfp, bits);
    zfp_stream_rewind(array.zfp);
    const std::size_t size = zfp_decompress(array.zfp, array.field);
    stream_close(bits);
    if (size == 0) return Status::Corrupt("zfp: cannot decompress");
    for (std::size_t i = 0; i < array.values.size(); ++i) frames[i / n][i % n][a] = array.values[i];
  }
  return Status::Ok();
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunArrayPeer(argc, argv,
                                  {"zfp, vertices by frames",
                                   ZFP_VERSION_STRING,
                                   "accuracy, diagonals",
                                   {"1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5"},
                                   sac::bench::Encode,
                                   sac::bench::Decode});
}
