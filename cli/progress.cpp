// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sac {

Progress::Progress(std::optional<std::uint32_t> total) : terminal_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() { Show(""); }

void Progress::Begin(const std::string& text) { Show(text); }

void Progress::FramesDone(std::uint32_t count) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  Show(pass_ + "frame " + std::to_string(count) + (total_ ? " / " + std::to_string(*total_) : std::string()));
}

void Progress::Show(const std::string& text) {
  if (!terminal_ || (text.empty() && shown_ == 0)) return;
  std::string line = "\r" + text;
  const std::size_t blanks = shown_ - std::min(shown_, text.size());
  line += std::string(blanks, ' ') + (text.empty() ? std::string("\r") : std::string(blanks, '\b'));
  std::fputs(line.c_str(), stderr);
  shown_ = text.size();
}

}  // namespace sac
