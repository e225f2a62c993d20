// SPDX-License-Identifier: Apache-2.0
// Decodes a stream several times into one buffer and prints the least processor time of a round, in seconds. What is
// derived from the first frame is not part of it. bench/python compares the Python module with it.
//
// usage: decode_speed STREAM ROUNDS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "sac/decoder.h"

namespace {

// Decodes all frames from the beginning.
sac::Status Round(std::span<const std::uint8_t> stream, sac::Decoder& decoder, const sac::FrameBuffers& buffers) {
  std::uint64_t byte = 0;
  SAC_RETURN_IF_ERROR(decoder.Seek(0, byte));
  std::span<const std::uint8_t> bytes = stream.subspan(byte);
  while (!bytes.empty()) {
    SAC_RETURN_IF_ERROR(decoder.Send(bytes));
    sac::FrameInfo info;
    sac::Status status;
    while ((status = decoder.Receive(buffers, info)).ok()) continue;
    if (status.code() != sac::StatusCode::kNeedMoreData) return status;
  }
  return decoder.Finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<std::uint8_t> stream{std::istreambuf_iterator<char>(file), {}};
  sac::Decoder decoder;
  std::span<const std::uint8_t> bytes = stream;
  sac::Status status;
  while (status.ok() && !bytes.empty() && decoder.mesh() == nullptr) status = decoder.Send(bytes);
  std::vector<sac::Vec3f> positions(decoder.mesh() != nullptr ? decoder.mesh()->positions.size() : 0);
  const sac::FrameBuffers buffers{{positions.data(), 12 * positions.size(), 12, sac::VertexFormat::kFloat32}, {}};
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; status.ok() && round < std::atoi(argv[2]); ++round) {
    const std::clock_t begin = std::clock();
    status = Round(stream, decoder, buffers);
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  if (!status.ok()) std::fprintf(stderr, "decode_speed: %s\n", status.message().c_str());
  std::printf("%.6f\n", least);
  return status.ok() ? 0 : 1;
}
