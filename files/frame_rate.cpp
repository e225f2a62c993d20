// SPDX-License-Identifier: Apache-2.0
#include "files/frame_rate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <system_error>

namespace sac {
namespace {

constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();

bool ParseDigits(std::string_view digits, std::uint64_t& value) {
  if (digits.empty() || digits.front() == '-') return false;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return result.ec == std::errc() && result.ptr == digits.data() + digits.size();
}

bool Reduce(std::uint64_t numerator, std::uint64_t denominator, FrameRate& rate) {
  if (numerator == 0 || denominator == 0) return false;
  const std::uint64_t divisor = std::gcd(numerator, denominator);
  numerator /= divisor;
  denominator /= divisor;
  if (numerator > kMax || denominator > kMax) return false;
  rate = {static_cast<std::uint32_t>(numerator), static_cast<std::uint32_t>(denominator)};
  return true;
}

}  // namespace

bool ParseFrameRate(std::string_view text, FrameRate& rate) {
  std::uint64_t numerator = 0, denominator = 1;
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    return ParseDigits(text.substr(0, slash), numerator) && ParseDigits(text.substr(slash + 1), denominator) &&
           Reduce(numerator, denominator, rate);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view decimals = text.substr(std::min(point + 1, text.size()));
  std::uint64_t fraction = 0;
  if (!ParseDigits(text.substr(0, point), numerator) || numerator > kMax) return false;
  if (point < text.size() && (decimals.size() > 9 || !ParseDigits(decimals, fraction))) return false;
  for (std::size_t i = 0; i < decimals.size(); ++i) denominator *= 10;
  numerator = numerator * denominator + fraction;
  if (decimals.size() >= 2 && fraction != 0) {
    const std::uint64_t whole = numerator / denominator + 1;
    // Is the text whole * 1000 / 1001, rounded to as many digits?
    if ((2 * whole * 1000 * denominator + 1001) / (2 * 1001) == numerator) return Reduce(whole * 1000, 1001, rate);
  }
  return Reduce(numerator, denominator, rate);
}

FrameRate NearestFrameRate(double fps) {
  FrameRate rate;
  if (!(fps > 0) || fps > 1e6) return rate;
  // Float32 times leave a relative error of about 1e-7; whole and broadcast rates differ by 1e-3.
  constexpr double kTolerance = 1e-5;
  for (const std::uint64_t denominator : {1, 1001, 2, 3, 1000, 1000000}) {
    const double unit = denominator == 1001 ? 1000.0 / 1001 : 1.0 / static_cast<double>(denominator);
    const double count = std::round(fps / unit);
    if (count >= 1 && std::abs(count * unit - fps) <= kTolerance * fps) {
      const auto numerator = static_cast<std::uint64_t>(count);
      Reduce(denominator == 1001 ? numerator * 1000 : numerator, denominator, rate);
      return rate;
    }
  }
  return rate;
}

}  // namespace sac
