// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>
#include <stdexcept>

#include "sac/status.h"

namespace sac {

// Returns what `call` returns. When `call` throws because memory is short (the limits of the settings may allow more
// than the machine has), returns on_exception(kLimit status) instead.
template <class Call, class OnException>
Status Contain(Call&& call, OnException&& on_exception) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return on_exception(Status::Limit("out of memory"));  // short enough for a string that allocates nothing
}

// The same, but returns the kLimit status itself.
template <class Call>
Status Contain(Call&& call) {
  return Contain(call, [](Status status) { return status; });
}

}  // namespace sac
