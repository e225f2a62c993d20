// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "sac/component_poser.h"
#include "sac/sac_components.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// `count` values from an array of numbers. kInvalidArgument for a null pointer to at least one, with `what` it is.
template <class Value, class Number>
Status ReadArray(const Number* from, std::size_t count, const std::string& what, std::vector<Value>& to) {
  static_assert(sizeof(Value) % sizeof(Number) == 0);
  if (from == nullptr && count > 0) return Status::InvalidArgument(what + ": a null pointer");
  to.resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(to.data()), from, count * sizeof(Value));
  return Status::Ok();
}

// Copies over the defaults in `to` the members that `from`, which may be null, has. kInvalidArgument where its size is
// none that `first_size`, the least that there was, allows; kUnsupported where it comes from a later library.
template <class Settings>
Status ReadSettings(const Settings* from, std::size_t first_size, Settings& to) {
  if (from == nullptr) return Status::Ok();
  if (from->struct_size < first_size) return Status::InvalidArgument("settings that their init function has not set");
  if (from->struct_size > sizeof(to)) return Status::Unsupported("settings of a later library");
  std::memcpy(&to, from, from->struct_size);
  return Status::Ok();
}

// The C++ settings of a decomposition of a mesh of so many vertices, with its progress. The caller's user pointer is
// that of `from`.
Status ToDecompositionSettings(const sac_decomposition_settings* from, std::uint32_t vertices,
                               DecompositionSettings& to);

// Copies a set. Sizes are checked where it is read; what else contradicts itself ComponentPoser::Create() finds.
Status ReadComponentSet(const sac_component_set* from, SparseComponents& to);

Status ToDragSettings(const sac_drag_settings* from, std::size_t components, DragSettings& to);

RigidPose ToPose(const sac_rigid_pose& from);
sac_rigid_pose FromPose(const RigidPose& from);

}  // namespace sac
