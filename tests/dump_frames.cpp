// SPDX-License-Identifier: Apache-2.0
// Prints a checksum of each frame's integers: what prediction and residuals add up to, without any float. Writes the
// positions that they give, 32-bit floats one frame after the other.
// usage: dump_frames CLIP.sac FRAMES.f32
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "conformance/coefficients.h"
#include "sac/decoder.h"

namespace {

sac::Status WriteFrames(std::span<const std::uint8_t> bytes, const char* path) {
  std::ofstream file(path, std::ios::binary);
  sac::Decoder decoder;
  sac::DecodedFrame frame;
  while (!bytes.empty()) {
    SAC_RETURN_IF_ERROR(decoder.Send(bytes));
    while (decoder.Receive(frame).ok()) {
      file.write(reinterpret_cast<const char*>(frame.positions.data()),
                 static_cast<std::streamsize>(frame.positions.size() * sizeof(sac::Vec3f)));
    }
  }
  SAC_RETURN_IF_ERROR(decoder.Finish());
  return file.flush() ? sac::Status::Ok() : sac::Status::IoError(std::string(path) + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CLIP.sac FRAMES.f32\n", argv[0]);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  unsigned frame = 0;
  sac::Status status =
      sac::ReadCoefficients(bytes, [&frame](const sac::FrameSlot& slot, const sac::FrameCoefficients& coefficients) {
        std::printf("frame %u references %zu crc %08x\n", frame++, slot.references.size(),
                    sac::CoefficientsCrc32(coefficients, 0));
      });
  if (status.ok()) status = WriteFrames(bytes, argv[2]);
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", argv[1], status.message().c_str());
  return status.ok() ? 0 : 1;
}
