// SPDX-License-Identifier: Apache-2.0
// Counts the frames of the stream that is named.
#include <sac/decoder.h>

#include <cstdio>
#include <fstream>
#include <iterator>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> stream(text.begin(), text.end());
  sac::Decoder decoder;
  sac::DecodedFrame frame;
  unsigned frames = 0;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    if (!decoder.Send(rest).ok()) return 1;
    while (decoder.Receive(frame).ok()) ++frames;
  }
  if (!decoder.Finish().ok()) return 1;
  std::printf("%u\n", frames);
}
