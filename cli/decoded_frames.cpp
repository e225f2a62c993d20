#include "cli/decoded_frames.h"

namespace sac {

Status DecodedFrames::Next(DecodedFrame& frame, bool& end) {
  end = false;
  for (;;) {
    const Status received = decoder_.Receive(frame);
    if (received.ok()) return received;
    if (received.code() != StatusCode::kNeedMoreData) return At(received);
    if (chunk_.empty()) {
      SAC_RETURN_IF_ERROR(next_chunk_(chunk_));
      bytes_ += chunk_.size();
      if (chunk_.empty()) {
        end = true;
        const Status finished = decoder_.Finish();
        return finished.ok() ? finished : At(finished);
      }
    }
    if (const Status sent = decoder_.Send(chunk_); !sent.ok()) return At(sent);
  }
}

}  // namespace sac
