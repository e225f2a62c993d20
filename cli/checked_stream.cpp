// SPDX-License-Identifier: Apache-2.0
#include "cli/checked_stream.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace sac {
namespace {

DecoderSettings AllProcessors() {
  DecoderSettings settings;
  settings.threads = std::max(1u, std::thread::hardware_concurrency());
  return settings;
}

Status Undecodable(const Status& status) { return {status.code(), "the result does not decode: " + status.message()}; }

}  // namespace

CheckedStream::CheckedStream(bool check, std::function<void(std::uint32_t)> frame_done)
    : check_(check), frame_done_(std::move(frame_done)), decoder_(AllProcessors()) {}

Status CheckedStream::Write(std::span<const std::uint8_t> bytes) {
  bytes_ += bytes.size();
  SAC_RETURN_IF_ERROR(file_.Write(bytes.data(), bytes.size()));
  while (check_ && !bytes.empty()) {
    if (const Status sent = decoder_.Send(bytes); !sent.ok()) return Undecodable(sent);
    Status received;
    while ((received = decoder_.Receive(frame_)).ok()) frame_done_(frame_.index + 1);
    if (received.code() != StatusCode::kNeedMoreData) return Undecodable(received);
  }
  return Status::Ok();
}

Status CheckedStream::Commit() {
  if (check_) {
    if (const Status finished = decoder_.Finish(); !finished.ok()) return Undecodable(finished);
  }
  return file_.Commit();
}

}  // namespace sac
