// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sac/status.h"

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

// The whole of `word` as the nearest float32. "nan" and "inf" are numbers here, and so are the
// spellings 1.#IND, 1.#QNAN and 1.#INF of older C libraries; what is too large is infinite. False if it is none.
bool ParseFloat(std::string_view word, float& value);

// As ParseFloat, in double. Where the nearest double lies in the middle of two float32 and `word` does not, `value` is
// the double beside it, so that rounding it to float32 gives the float32 nearest to `word`.
bool ParseDouble(std::string_view word, double& value);

// The whole of `word` as a decimal integer; false if it is none.
bool ParseInteger(std::string_view word, std::int64_t& value);

// The error for a word that is no number; says so if it has a decimal comma.
Status NotANumber(std::string_view word);

// Makes `text` UTF-8 without a byte order mark and with lines that end in '\n' alone, whichever of CR, CRLF, VT, FF,
// NEL (U+0085), LS (U+2028) and PS (U+2029) ended them. kUnsupported for UTF-16, which a byte order mark tells.
Status NormalizeText(std::string& text);

// The line, from 1, that `at` is in; `text` is normalized.
std::size_t LineNumber(std::string_view text, std::size_t at);

}  // namespace sac
