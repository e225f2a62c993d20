// SPDX-License-Identifier: Apache-2.0
#include "files/frame_pattern.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

namespace sac {

Status FramePattern::Parse(const std::string& text, FramePattern& pattern) {
  constexpr int kWidthLimit = 20;
  const auto error = [&](const std::string& what) { return Status::InvalidArgument(text + ": " + what); };
  FramePattern parsed;
  parsed.text_ = text;
  std::string* part = &parsed.prefix_;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      *part += text[i];
    } else if (i + 1 < text.size() && text[i + 1] == '%') {
      *part += '%';
      ++i;
    } else {
      const std::size_t d = text.find_first_not_of("0123456789", i + 1);
      const std::string_view width = std::string_view(text).substr(i + 1, d - i - 1);
      int value = 0;
      if (d == std::string::npos || text[d] != 'd' || (!width.empty() && width[0] != '0')) {
        return error("the frame number is written %d or %04d");
      }
      if (!width.empty() && (std::from_chars(width.data(), width.data() + width.size(), value).ec != std::errc() ||
                             value < 1 || value > kWidthLimit)) {
        return error("the frame number has a width of 1 to 20");
      }
      if (part == &parsed.suffix_) return error("more than one frame number");
      parsed.width_ = static_cast<std::size_t>(value);
      part = &parsed.suffix_;
      i = d;
    }
  }
  if (part == &parsed.prefix_) return error("no frame number (%d or %04d)");
  if (parsed.suffix_.find('/') != std::string::npos) return error("the frame number is in a directory's name");
  const std::size_t slash = parsed.prefix_.rfind('/');
  if (slash != std::string::npos) {
    parsed.directory_ = parsed.prefix_.substr(0, slash + 1);
    parsed.prefix_.erase(0, slash + 1);
  }
  pattern = std::move(parsed);
  return Status::Ok();
}

std::string FramePattern::Path(std::uint64_t number) const {
  const std::string digits = std::to_string(number);
  const std::size_t zeros = digits.size() < width_ ? width_ - digits.size() : 0;
  return directory_ + prefix_ + std::string(zeros, '0') + digits + suffix_;
}

Status FramePattern::List(std::vector<std::string>& paths) const {
  namespace fs = std::filesystem;
  std::error_code error;
  std::optional<std::uint64_t> lowest;
  fs::directory_iterator entry(directory_.empty() ? "." : directory_, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= prefix_.size() + suffix_.size() || name.compare(0, prefix_.size(), prefix_) != 0) continue;
    std::uint64_t number = 0;
    const char* begin = name.data() + prefix_.size();
    const auto result = std::from_chars(begin, name.data() + name.size(), number);
    // Spelt as Path spells it, so that frame_7 is none of frame_%04d.
    if (result.ec == std::errc() && directory_ + name == Path(number))
      lowest = std::min(lowest.value_or(number), number);
  }
  if (error) return Status::IoError(text_ + ": " + error.message());
  if (!lowest) return Status::IoError(text_ + ": no file matches");
  paths.clear();
  for (std::uint64_t number = *lowest; fs::exists(Path(number), error); ++number) paths.push_back(Path(number));
  return Status::Ok();
}

}  // namespace sac
