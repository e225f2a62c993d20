// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace sac {

// One line on standard error that is written anew as work goes on, and erased at the end; nothing at all where standard
// error is no terminal.
class Progress {
 public:
  // `total` frames, where known.
  explicit Progress(std::optional<std::uint32_t> total = std::nullopt);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void SetTotal(std::optional<std::uint32_t> total) { total_ = total; }
  // `text` until the first frame is done.
  void Begin(const std::string& text);
  // What is said before the frames from now on: which pass over the clip this is.
  void SetPass(const std::string& pass) { pass_ = pass; }
  void FramesDone(std::uint32_t count);

 private:
  void Show(const std::string& text);

  bool terminal_;
  std::optional<std::uint32_t> total_;
  std::string pass_;
  std::size_t shown_ = 0;  // columns in use
  std::chrono::steady_clock::time_point last_;
};

}  // namespace sac
