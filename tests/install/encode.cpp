// SPDX-License-Identifier: Apache-2.0
// Encodes a clip of a tetrahedron that turns, and writes the stream to the file that is named.
#include <sac/encoder.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ofstream file(argv[2], std::ios::binary);
  const auto write = [&file](const std::vector<std::uint8_t>& bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  sac::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::unique_ptr<sac::Encoder> encoder;
  sac::Status status = sac::Encoder::Create(mesh, {}, encoder);
  const int frames = std::atoi(argv[1]);
  for (int frame = 0; status.ok() && frame < frames; ++frame) {
    const float angle = 0.1f * static_cast<float>(frame);
    mesh.positions[1] = {std::cos(angle), std::sin(angle), 0};
    mesh.positions[2] = {-std::sin(angle), std::cos(angle), 0};
    status = encoder->Send(mesh.positions);
    write(encoder->TakeBytes());
  }
  if (status.ok()) status = encoder->Finish();
  if (!status.ok()) {
    std::fprintf(stderr, "%s\n", status.message().c_str());
    return 1;
  }
  write(encoder->TakeBytes());
  return file.flush() ? 0 : 1;
}
