// SPDX-License-Identifier: Apache-2.0
#include "files/text_scan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace sac {
namespace {

std::string_view WithoutPlus(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  return word;
}

// The spellings of Microsoft's C library before 2015, padded with zeros to the digits asked for.
bool ParseOldSpelling(std::string_view word, double& value) {
  const bool minus = word.front() == '-';
  if (minus) word.remove_prefix(1);
  if (word.substr(0, 3) != "1.#") return false;
  const std::string_view name = word.substr(3);
  using Limits = std::numeric_limits<double>;
  if (name.substr(0, 3) == "INF") {
    value = minus ? -Limits::infinity() : Limits::infinity();
    return true;
  }
  value = Limits::quiet_NaN();
  return name.substr(0, 3) == "IND" || name.substr(0, 4) == "QNAN" || name.substr(0, 4) == "SNAN";
}

// Too far from zero, or too near? A word without an exponent can only be too near by its zeros after the point.
double OutOfRange(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  const bool near =
      exponent == std::string_view::npos ? word.find_first_not_of("-0.") > 30 : word.substr(exponent + 1, 1) == "-";
  const double size = near ? 0 : std::numeric_limits<double>::infinity();
  return word.front() == '-' ? -size : size;
}

bool ParseAny(std::string_view word, double& value) {
  word = WithoutPlus(word);
  if (word.empty()) return false;
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  if (result.ptr != end) return ParseOldSpelling(word, value);
  if (result.ec == std::errc::result_out_of_range) value = OutOfRange(word);
  return result.ec != std::errc::invalid_argument;
}

// The bytes of the line end that `rest` begins with, and 0 if it begins with none.
std::size_t LineEnd(std::string_view rest) {
  switch (rest.front()) {
    case '\r':
      return rest.substr(1, 1) == "\n" ? 2 : 1;
    case '\n':
    case '\v':
    case '\f':
      return 1;
    case '\xC2':
      return rest.substr(1, 1) == "\x85" ? 2 : 0;
    case '\xE2':
      return rest.substr(1, 2) == "\x80\xA8" || rest.substr(1, 2) == "\x80\xA9" ? 3 : 0;
    default:
      return 0;
  }
}

}  // namespace

bool ParseFloat(std::string_view word, float& value) {
  word = WithoutPlus(word);
  if (word.empty()) return false;
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  if (result.ec == std::errc() && result.ptr == end) return true;
  // Too small or too large for a float: the conversion from double gives a zero or an infinity.
  double wide = 0;
  if (!ParseAny(word, wide)) return false;
  value = static_cast<float>(wide);
  return true;
}

bool ParseDouble(std::string_view word, double& value) {
  if (!ParseAny(word, value)) return false;
  const auto narrow = static_cast<float>(value);
  if (static_cast<double>(narrow) == value || !std::isfinite(narrow)) return true;
  // The other float32 beside `value`; both are as far from it exactly where rounding to even has decided.
  const float other = std::nextafter(
      narrow, value > narrow ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity());
  if (value - narrow != static_cast<double>(other) - value) return true;
  float nearest = narrow;
  if (ParseFloat(word, nearest) && nearest == other) value = std::nextafter(value, static_cast<double>(other));
  return true;
}

bool ParseInteger(std::string_view word, std::int64_t& value) {
  word = WithoutPlus(word);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

Status NotANumber(std::string_view word) {
  constexpr std::size_t kMostLetters = 40;
  const std::string shown(word.substr(0, kMostLetters));
  const std::size_t comma = word.find(',');
  if (comma != std::string_view::npos) {
    std::string with_point(word);
    with_point[comma] = '.';
    double ignored = 0;
    if (ParseDouble(with_point, ignored)) {
      return Status::Corrupt("not a number: " + shown + " (a decimal comma; export with decimal points)");
    }
  }
  return Status::Corrupt("not a number: " + shown);
}

Status NormalizeText(std::string& text) {
  const std::string_view mark = std::string_view(text).substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") {
    return Status::Unsupported("text in UTF-16 or UTF-32; save it as UTF-8");
  }
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);
  const std::size_t first = text.find_first_of("\r\v\f\xC2\xE2");
  if (first == std::string::npos) return Status::Ok();
  std::size_t out = first;
  for (std::size_t in = first; in < text.size();) {
    const std::size_t end = LineEnd(std::string_view(text).substr(in));
    text[out++] = end > 0 ? '\n' : text[in];
    in += end > 0 ? end : 1;
  }
  text.resize(out);
  return Status::Ok();
}

std::size_t LineNumber(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

}  // namespace sac
