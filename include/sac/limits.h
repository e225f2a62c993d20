#pragma once

#include <cstdint>

namespace sac {

// What a decoder is ready to spend on a stream, finite by default (spec.md 9). A stream that asks for more is refused
// before anything is allocated for it.
struct Limits {
  std::uint32_t vertices = 4'000'000;
  std::uint32_t triangles = 8'000'000;
  std::uint32_t harmonics = 8'192;  // and at least one per component, see basis_values
  std::uint32_t frames_per_group = 4'096;
  std::uint32_t packet_bytes = 1u << 28;
  std::uint64_t group_values = 1u << 27;  // coefficients in all planes of a group together
  std::uint64_t basis_values =
      1u << 28;  // doubles in all harmonics together: sum over components of vertices x harmonics
  std::uint64_t factor_values = 1u << 28;  // of the factorized Laplacian, 12 bytes each
  // Bytes that a decoder holds at a time, about: of the mesh, its basis, its factor and a group's coefficients.
  std::uint64_t memory = std::uint64_t{1} << 33;
  // Multiplications, about, for what is derived from the I-frame (spec.md 9): at most basis_work, and at most
  // free_work + work_per_byte * the bytes of its packet.
  double basis_work = 5e11;
  double free_work = 4e10;
  double work_per_byte = 4e6;
  double frame_work = 1e11;  // likewise, for each frame
};

}  // namespace sac
