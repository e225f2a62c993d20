#pragma once

#include <array>
#include <cstdint>

#include "format/group_structure.h"
#include "format/plane_layout.h"

namespace sac {

// What the bitstream carries of one frame, and nothing else (spec.md 6.2): integers, in units of the header's steps.
struct FrameSyntax {
  FrameSlot slot;                          // references may differ from the structure's
  std::array<std::int32_t, 6> rigid = {};  // residual of rotation (3), translation (3)
  FramePlanes planes;                      // residuals

  bool intra() const { return slot.references.empty(); }
};

// Residuals of planes stay within this magnitude (spec.md 6.2).
inline constexpr std::int32_t kMaxResidual = 1 << 20;
// Residuals of the rigid motion, and all coefficients (spec.md 6.3).
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

}  // namespace sac
