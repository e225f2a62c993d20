// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace sac {

// Limits of single sizes, for those who know spec.md 9, which defines them under the same names. The defaults hold any
// stream that `Limits` admits and that an encoder makes of a usual clip; most decoders leave them alone.
struct ExpertLimits {
  std::uint32_t triangles = 8'000'000;
  std::uint32_t harmonics = 8'192;         // of one component
  std::uint32_t frames_per_group = 4'096;  // frames
  std::uint32_t packet_bytes = 1u << 27;   // bytes of a packet's payload
  std::uint64_t group_values = 1u << 27;   // coefficients of all planes of a group together
  std::uint64_t basis_values = 1u << 28;   // doubles of all harmonics together: components' vertices x harmonics
  std::uint64_t factor_values = 1u << 28;  // values of the factorized Laplacian, of 12 bytes each
  // Multiplications, approximately, that an I-frame may ask for: free_work + work_per_byte * the bytes of its packet,
  // so that few bytes do not ask for much. Limits::work holds as well.
  double free_work = 4e10;
  double work_per_byte = 4e6;
  double frame_work = 1e11;  // multiplications, approximately, for each frame
};

// What a decoder is ready to spend on a stream, finite by default (spec.md 9). A stream that asks for more is refused
// before anything is allocated for it.
struct Limits {
  std::uint32_t vertices = 4'000'000;
  // Bytes, approximately, that a decoder holds at a time: of the mesh, its basis, its factor and the coefficients of a
  // group. 8 GiB, or 1 GiB where an address has 32 bits.
  std::uint64_t memory = sizeof(std::size_t) < 8 ? std::uint64_t{1} << 30 : std::uint64_t{1} << 33;
  // Multiplications, approximately, for all that is derived from the I-frame; 5e11 are minutes. `basis_work` in
  // spec.md.
  double work = 5e11;
  ExpertLimits expert;
};

}  // namespace sac
