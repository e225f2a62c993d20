// zfp on each coordinate as an array of vertices by frames, in its mode of fixed accuracy.
#include <zfp.h>

#include <cmath>

#include "bench/peers/connectivity.h"
#include "bench/peers/peer.h"
#include "format/bytes.h"

namespace sac::bench {
namespace {

// The array of a coordinate, frame after frame. zfp takes its blocks of 4 by 4 from it.
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

Status Encode(const PeerClip& clip, const std::string& setting, PeerStream& stream) {
  double accuracy = 0;
  if (!ParseNumber(setting, accuracy)) return Status::InvalidArgument(setting + ": not a number");
  ByteWriter out;
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
  stream.order = connectivity.order;
  const std::size_t n = stream.order.size(), frames = clip.frames.size();
  const double tolerance = accuracy * Diagonal(clip);
  out.Varint(static_cast<std::uint32_t>(frames));
  out.F32(static_cast<float>(tolerance));
  for (std::size_t a = 0; a < 3; ++a) {
    Array array(n, frames);
    for (std::size_t i = 0; i < array.values.size(); ++i) {
      array.values[i] = clip.frames[i / n][stream.order[i % n]][a];
    }
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
  stream.bytes = out.bytes();
  return Status::Ok();
}

Status Decode(std::span<const std::uint8_t> bytes, PeerClip& clip) {
  ByteReader in(bytes);
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
  const std::size_t n = connectivity.vertices, frames = in.Varint();
  const double tolerance = static_cast<double>(in.F32());
  clip.triangles = connectivity.triangles;
  clip.frames.assign(frames, Positions(n));
  for (std::size_t a = 0; a < 3; ++a) {
    const auto part = in.Bytes(in.Varint());
    std::vector<std::uint8_t> words(part.begin(), part.end());  // whole words for zfp
    words.resize(words.size() + 16);
    Array array(n, frames);
    zfp_stream_set_accuracy(array.zfp, tolerance);
    bitstream* bits = stream_open(words.data(), words.size());
    zfp_stream_set_bit_stream(array.zfp, bits);
    zfp_stream_rewind(array.zfp);
    const std::size_t size = zfp_decompress(array.zfp, array.field);
    stream_close(bits);
    if (size == 0) return Status::Corrupt("zfp: cannot decompress");
    for (std::size_t i = 0; i < array.values.size(); ++i) clip.frames[i / n][i % n][a] = array.values[i];
  }
  return in.ok() ? Status::Ok() : Status::Corrupt("truncated stream");
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(argc, argv,
                             {"zfp, vertices by frames",
                              ZFP_VERSION_STRING,
                              "accuracy, diagonals",
                              {"1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5"},
                              sac::bench::Encode,
                              sac::bench::Decode});
}
