// SPDX-License-Identifier: Apache-2.0
// Prints a checksum of each frame's integers: what prediction and residuals add up to, without any float.
// usage: dump_coefficients CLIP.sac
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "conformance/coefficients.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s CLIP.sac\n", argv[0]);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  unsigned frame = 0;
  const sac::Status status =
      sac::ReadCoefficients(bytes, [&frame](const sac::FrameSlot& slot, const sac::FrameCoefficients& coefficients) {
        std::printf("frame %u references %zu crc %08x\n", frame++, slot.references.size(),
                    sac::CoefficientsCrc32(coefficients, 0));
      });
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", argv[1], status.message().c_str());
  return status.ok() ? 0 : 1;
}
