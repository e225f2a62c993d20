// SPDX-License-Identifier: Apache-2.0
// Prints the checksum of the coefficients of each stream as conformance/manifest.json has it.
// usage: coefficients STREAM.sac...
#include "conformance/coefficients.h"

#include <cstdint>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::vector<std::uint8_t> bytes(1 << 16);
    std::FILE* file = std::fopen(argv[i], "rb");
    bytes.resize(file == nullptr ? 0 : std::fread(bytes.data(), 1, bytes.size(), file));
    if (file != nullptr) std::fclose(file);
    std::uint32_t crc = 0;
    const sac::Status status =
        sac::ReadCoefficients(bytes, [&crc](const sac::FrameSlot&, const sac::FrameCoefficients& coefficients) {
          crc = sac::CoefficientsCrc32(coefficients, crc);
        });
    std::printf("%s %08x %s\n", argv[i], crc, status.message().c_str());
  }
}
