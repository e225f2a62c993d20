// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rate_control/measured_encoding.h"
#include "sac/status.h"

namespace sac {

// Keeps a stream until it is known whether it is the one that is given out. A stream of more than kMostBytes is
// dropped and has to be encoded again, so that memory does not grow with the length of a clip.
class HeldStream {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  HeldStream() = default;
  explicit HeldStream(std::size_t most) : most_(most) {}

  void Add(std::span<const std::uint8_t> bytes) {
    is_whole_ = is_whole_ && bytes.size() <= most_ - bytes_.size();
    if (is_whole_) {
      bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    } else {
      bytes_ = {};
    }
  }

  // Whether nothing was dropped.
  bool is_whole() const { return is_whole_; }

  // Gives the stream to `sink`, which may be empty.
  Status Give(const ByteSink& sink) const { return sink && !bytes_.empty() ? sink(bytes_) : Status::Ok(); }

 private:
  std::size_t most_ = kMostBytes;
  std::vector<std::uint8_t> bytes_;
  bool is_whole_ = true;
};

}  // namespace sac
