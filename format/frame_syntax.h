// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "format/group.h"
#include "format/plane_layout.h"
#include "format/rigid_motion.h"

namespace sac {

// The syntax elements of one frame (spec.md 6.2). They are integers in units of the header's steps.
struct FrameSyntax {
  FrameSlot slot;      // references may differ from the structure's
  RigidMotion rigid;   // residual of rotation (3), translation (3)
  FramePlanes planes;  // residuals

  bool intra() const { return slot.references.empty(); }
};

// The largest magnitude of a plane's residual (spec.md 6.2).
inline constexpr std::int32_t kMaxResidual = 1 << 20;
// The largest magnitude of a rigid motion's residual and of any coefficient (spec.md 6.3).
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

}  // namespace sac
