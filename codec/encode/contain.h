// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>
#include <stdexcept>

#include "sac/status.h"

namespace sac {

// Returns what `call` returns. When it throws for want of memory, since the limits of the settings allow more than
// there is, the result is what `on_exception` makes of the kLimit that says so.
template <class Call, class OnException>
Status Contain(Call&& call, OnException&& on_exception) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return on_exception(Status::Limit("out of memory"));  // short enough for a string that allocates nothing
}

// The same with the kLimit itself.
template <class Call>
Status Contain(Call&& call) {
  return Contain(call, [](Status status) { return status; });
}

}  // namespace sac
