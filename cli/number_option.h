// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <sstream>
#include <string>
#include <system_error>
#include <type_traits>

namespace sac {

// Adds an option whose value is a decimal number from `low` to `high`; `target` is a T or an optional<T>. CLI11's own
// numbers take octal ("010"), NaN and blanks.
template <class T, class Target>
CLI::Option* AddNumber(CLI::App& app, const std::string& name, Target& target, T low, T high, const std::string& help) {
  const auto parse = [name, low, high, &target](const CLI::results_t& words) {
    const std::string& word = words.front();
    T value{};
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = result.ec == std::errc() && result.ptr == word.data() + word.size();
    if (!whole || !(value >= low && value <= high)) {
      std::ostringstream reason;
      reason << "'" << word << "' is not a " << (std::is_integral_v<T> ? "whole " : "") << "number from " << low
             << " to " << high;
      throw CLI::ValidationError(name, reason.str());
    }
    target = value;
    return true;
  };
  return app.add_option(name, parse, help)->option_text(std::is_integral_v<T> ? "N" : "X");
}

}  // namespace sac
