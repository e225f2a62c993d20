// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace sac {

// Pieces of a text file without the locale, the copies and the silent zeros of iostreams.

inline bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\n'; }

// Takes the next line off `text`, without its line end.
inline std::string_view TakeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

// Takes the next blank-separated word off `text`; empty when there is none.
inline std::string_view TakeWord(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && IsBlank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !IsBlank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

// The whole of `word` as the nearest float32; "nan" and "inf" are numbers here. False if it is none.
inline bool ParseFloat(std::string_view word, float& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  auto result = std::from_chars(word.data(), end, value);
  if (result.ec == std::errc::result_out_of_range) {
    // Too small or too large for a float: the conversion from double gives a zero or an infinity.
    double wide = 0;
    result = std::from_chars(word.data(), end, wide);
    value = static_cast<float>(wide);
  }
  return result.ec == std::errc() && result.ptr == end;
}

// The whole of `word` as a decimal integer; false if it is none.
inline bool ParseInteger(std::string_view word, std::int64_t& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace sac
