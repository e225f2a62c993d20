// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace sac {

// The frames that one frame is predicted from: none, one or two, each as its index in the coding order of its group
// (spec.md 6.2). Nothing is allocated for them, since encoders compare many for each frame.
class References {
 public:
  static constexpr std::size_t kMaxSize = 2;

  constexpr References() = default;
  // `frames` are at most two.
  constexpr References(std::initializer_list<std::uint32_t> frames) {
    assert(frames.size() <= kMaxSize);
    for (const std::uint32_t frame : frames) frames_[size_++] = frame;
  }

  // Makes them `size` references, at most two; what is added refers to frame 0.
  constexpr void resize(std::size_t size) {
    assert(size <= kMaxSize);
    for (std::size_t i = size; i < kMaxSize; ++i) frames_[i] = 0;
    size_ = size;
  }

  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr std::uint32_t operator[](std::size_t i) const { return frames_[i]; }
  constexpr std::uint32_t front() const { return frames_[0]; }
  constexpr std::uint32_t back() const { return frames_[size_ - 1]; }
  constexpr std::uint32_t* begin() { return frames_.data(); }
  constexpr std::uint32_t* end() { return frames_.data() + size_; }
  constexpr const std::uint32_t* begin() const { return frames_.data(); }
  constexpr const std::uint32_t* end() const { return frames_.data() + size_; }

  friend constexpr bool operator==(const References&, const References&) = default;

 private:
  std::array<std::uint32_t, kMaxSize> frames_ = {};  // 0 from size_ on, so that comparing all compares those that count
  std::size_t size_ = 0;
};

}  // namespace sac
