// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sac/sac.h"
#include "sac/status.h"

namespace sac {

// The code of `status` in the C interface. That interface reads and writes no files, so kIoError has no code of its
// own.
inline sac_status CodeOf(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return SAC_OK;
    case StatusCode::kNeedMoreData:
      return SAC_NEED_MORE_DATA;
    case StatusCode::kUnsupported:
      return SAC_UNSUPPORTED;
    case StatusCode::kCorrupt:
      return SAC_CORRUPT;
    case StatusCode::kLimit:
      return SAC_LIMIT;
    case StatusCode::kCancelled:
      return SAC_CANCELLED;
    case StatusCode::kInvalidArgument:
    case StatusCode::kIoError:
      return SAC_INVALID_ARGUMENT;
  }
  return SAC_INVALID_ARGUMENT;
}

}  // namespace sac
