// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_range_option.h"

#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>

namespace sac {
namespace {

bool ParseFrameNumber(std::string_view text, std::uint32_t& number) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

bool ParseFrameRange(std::string_view text, WantedFrames& range) {
  range = {};
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    if (!ParseFrameNumber(text, range.begin) || range.begin == std::numeric_limits<std::uint32_t>::max()) return false;
    range.end = range.begin + 1;
    return true;
  }
  const std::string_view begin = text.substr(0, colon), end = text.substr(colon + 1);
  if (begin.empty() && end.empty()) return false;
  if (!begin.empty() && !ParseFrameNumber(begin, range.begin)) return false;
  if (end.empty()) return true;
  return ParseFrameNumber(end, range.end.emplace()) && range.begin < *range.end;
}

}  // namespace

CLI::Option* AddFrameRange(CLI::App& app, const std::string& name, WantedFrames& range, const std::string& help) {
  const auto parse = [name, &range](const CLI::results_t& words) {
    if (ParseFrameRange(words.front(), range)) return true;
    throw CLI::ValidationError(name, "'" + words.front() + "' is no range of frames such as 10:20");
  };
  return app.add_option(name, parse, help)->option_text("A:B");
}

}  // namespace sac
