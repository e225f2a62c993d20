// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sac {

// The rigid motion of a frame, or the residual of one, in the order in which it is coded (spec.md 6.2): the vector of
// the rotation, whose length is the angle, in the header's rotation steps, then the translation in its translation
// steps.
struct RigidMotion {
  std::array<std::int32_t, 6> values = {};

  constexpr std::span<const std::int32_t, 3> rotation() const { return std::span(values).first<3>(); }
  constexpr std::span<const std::int32_t, 3> translation() const { return std::span(values).last<3>(); }

  static constexpr std::size_t size() { return 6; }
  constexpr std::int32_t& operator[](std::size_t i) { return values[i]; }
  constexpr std::int32_t operator[](std::size_t i) const { return values[i]; }
  constexpr std::int32_t* begin() { return values.data(); }
  constexpr std::int32_t* end() { return values.data() + size(); }
  constexpr const std::int32_t* begin() const { return values.data(); }
  constexpr const std::int32_t* end() const { return values.data() + size(); }

  friend constexpr bool operator==(const RigidMotion&, const RigidMotion&) = default;
};

}  // namespace sac
