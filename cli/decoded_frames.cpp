// SPDX-License-Identifier: Apache-2.0
#include "cli/decoded_frames.h"

namespace sac {

Status DecodedFrames::Next(DecodedFrame& frame, bool& end) {
  end = false;
  for (;;) {
    const Status received = decoder_.Receive(frame);
    if (received.ok()) return received;
    if (received.code() != StatusCode::kNeedMoreData) return At(received);
    if (ended_) {
      end = true;
      return Status::Ok();
    }
    if (chunk_.empty()) {
      SAC_RETURN_IF_ERROR(next_chunk_(chunk_));
      bytes_ += chunk_.size();
      if (chunk_.empty()) {
        ended_ = true;
        const Status finished = decoder_.Finish();
        // What has been lost is told; what is left can still be received.
        const bool good = finished.ok() || (skip_damage_ && decoder_.mesh() != nullptr);
        if (!good) return At(finished);
        continue;
      }
    }
    if (const Status sent = decoder_.Send(chunk_); !sent.ok()) return At(sent);
  }
}

}  // namespace sac
