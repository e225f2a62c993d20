// SPDX-License-Identifier: Apache-2.0
#include "files/frame_pattern.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace sac {
namespace {

constexpr std::size_t kWidthLimit = 20;
constexpr std::string_view kDigits = "0123456789";

// A frame number in a pattern: where it stands, and at least how many digits it has.
struct Number {
  std::size_t begin, end, width;
};

std::size_t FileNameOf(const std::string& text) {
  const std::size_t slash = text.rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

// The runs of a letter in the file name, or of $F with its digit.
std::vector<Number> FindNumbers(const std::string& text, char letter) {
  std::vector<Number> found;
  for (std::size_t i = FileNameOf(text); i < text.size();) {
    std::size_t end = i;
    std::size_t width = 0;
    if (letter == '$') {
      if (text.compare(i, 2, "$F") == 0) {
        end = i + 2;
        if (end < text.size() && text[end] >= '1' && text[end] <= '9')
          width = static_cast<std::size_t>(text[end++] - '0');
      }
    } else {
      while (end < text.size() && text[end] == letter) ++end;
      width = letter == '#' ? end - i : 0;
    }
    if (end > i) found.push_back({i, end, width});
    i = std::max(end, i + 1);
  }
  return found;
}

// The same of printf's, which may be in a directory, too. Any other percent sign than %% is an error.
Status FindPrintfNumbers(const std::string& text, std::vector<Number>& found) {
  for (std::size_t i = 0; (i = text.find('%', i)) != std::string::npos;) {
    if (text.compare(i, 2, "%%") == 0) {
      i += 2;
      continue;
    }
    const std::size_t d = text.find_first_not_of(kDigits, i + 1);
    const std::string_view width = std::string_view(text).substr(i + 1, d - i - 1);
    if (d == std::string::npos || text[d] != 'd' || (!width.empty() && width[0] != '0')) {
      return Status::InvalidArgument(text + ": the frame number is written %d or %04d");
    }
    std::size_t value = 0;
    if (!width.empty() && (std::from_chars(width.data(), width.data() + width.size(), value).ec != std::errc() ||
                           value < 1 || value > kWidthLimit)) {
      return Status::InvalidArgument(text + ": the frame number has a width of 1 to 20");
    }
    found.push_back({i, d + 1, value});
    i = d + 1;
  }
  return Status::Ok();
}

std::string WithoutDoubledPercents(std::string text) {
  for (std::size_t i = 0; (i = text.find("%%", i)) != std::string::npos; ++i) text.erase(i, 1);
  return text;
}

}  // namespace

bool FramePattern::IsPattern(const std::string& text) {
  if (text.find('%') != std::string::npos) return true;
  for (const char letter : {'$', '#', '*'}) {
    if (!FindNumbers(text, letter).empty()) return true;
  }
  return false;
}

Status FramePattern::Parse(const std::string& text, FramePattern& pattern) {
  const auto error = [&](const std::string& what) { return Status::InvalidArgument(text + ": " + what); };
  std::vector<Number> numbers;
  const bool printf_like = text.find('%') != std::string::npos;
  if (printf_like) SAC_RETURN_IF_ERROR(FindPrintfNumbers(text, numbers));
  FramePattern parsed;
  for (const char letter : {'$', '#', '*'}) {
    if (!numbers.empty()) break;
    numbers = FindNumbers(text, letter);
    parsed.any_digits_ = letter == '*' && !numbers.empty();
  }
  if (numbers.empty()) return error("no frame number (%d or %04d)");
  if (numbers.size() > 1) return error("more than one frame number");
  if (numbers[0].width > kWidthLimit) return error("the frame number has a width of 1 to 20");
  if (numbers[0].begin < FileNameOf(text)) return error("the frame number is in a directory's name");
  parsed.text_ = text;
  parsed.width_ = numbers[0].width;
  parsed.directory_ = text.substr(0, FileNameOf(text));
  parsed.prefix_ = text.substr(FileNameOf(text), numbers[0].begin - FileNameOf(text));
  parsed.suffix_ = text.substr(numbers[0].end);
  if (printf_like) {
    for (std::string* part : {&parsed.directory_, &parsed.prefix_, &parsed.suffix_}) {
      *part = WithoutDoubledPercents(std::move(*part));
    }
  }
  pattern = std::move(parsed);
  return Status::Ok();
}

std::string FramePattern::Path(std::int64_t number) const {
  std::string digits = std::to_string(number);
  const std::string sign = number < 0 ? "-" : "";
  digits.erase(0, sign.size());
  // As printf does: the sign is one of the letters that the width counts.
  const std::size_t length = digits.size() + sign.size();
  return directory_ + prefix_ + sign + std::string(length < width_ ? width_ - length : 0, '0') + digits + suffix_;
}

bool FramePattern::Matches(const std::string& name, std::optional<std::int64_t>& number) const {
  if (name.size() <= prefix_.size() + suffix_.size() || name.compare(0, prefix_.size(), prefix_) != 0 ||
      name.compare(name.size() - suffix_.size(), suffix_.size(), suffix_) != 0) {
    return false;
  }
  const std::string_view digits =
      std::string_view(name).substr(prefix_.size(), name.size() - prefix_.size() - suffix_.size());
  std::int64_t value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (result.ec == std::errc::invalid_argument || result.ptr != digits.data() + digits.size()) return false;
  number.reset();
  if (result.ec == std::errc::result_out_of_range) return true;
  number = value;
  if (any_digits_ || directory_ + name == Path(value)) return true;
  // Frames before 0 are also written with the sign before all of the digits.
  return value < 0 && digits.size() == width_ + 1;
}

Status FramePattern::List(std::map<std::int64_t, std::string>& files) const {
  namespace fs = std::filesystem;
  files.clear();
  std::error_code error;
  fs::directory_iterator entry(directory_.empty() ? "." : directory_, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::optional<std::int64_t> number;
    if (!Matches(name, number)) continue;
    if (!number) return Status::InvalidArgument(directory_ + name + ": its frame number is too large");
    const auto [other, added] = files.try_emplace(*number, directory_ + name);
    if (!added) {
      // A directory has no order of its own.
      const std::string path = directory_ + name;
      const auto& [first, second] = std::minmax(other->second, path);
      return Status::InvalidArgument(text_ + ": " + first + " and " + second + " have the same number");
    }
  }
  if (error) return Status::IoError(text_ + ": " + error.message());
  if (files.empty()) return Status::IoError(text_ + ": no file matches");
  if (any_digits_ && files.rbegin()->first <= 0 && files.size() > 1 && files.begin()->first < 0) {
    // The sign belongs to the name: frame-1, frame-2.
    std::map<std::int64_t, std::string> positive;
    for (auto& [number, path] : files) positive.emplace(-number, std::move(path));
    files = std::move(positive);
  }
  return Status::Ok();
}

}  // namespace sac
