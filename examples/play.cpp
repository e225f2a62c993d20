// SPDX-License-Identifier: Apache-2.0
// Decodes a stream as its bytes arrive and prints one position of each frame: play < clip.sac
#include <cstdio>
#include <iostream>

#include "sac/decoder.h"

static sac::Status Play(std::istream& in) {
  sac::Decoder decoder;
  sac::DecodedFrame frame;
  sac::Status status;
  for (char chunk[4096]; in.read(chunk, sizeof chunk), in.gcount() > 0;) {
    std::span bytes(reinterpret_cast<const std::uint8_t*>(chunk), static_cast<std::size_t>(in.gcount()));
    while (!bytes.empty()) {
      SAC_RETURN_IF_ERROR(decoder.Send(bytes));
      while ((status = decoder.Receive(frame)).ok()) {
        std::printf("frame %u: vertex 0 of %zu is at %g %g %g\n", frame.index, frame.positions.size(),
                    frame.positions[0][0], frame.positions[0][1], frame.positions[0][2]);
      }
      if (status.code() != sac::StatusCode::kNeedMoreData) return status;
    }
  }
  return decoder.Finish();
}

int main() {
  const sac::Status status = Play(std::cin);
  if (!status.ok()) std::fprintf(stderr, "play: %s\n", status.message().c_str());
  return status.ok() ? 0 : 1;
}
