// SPDX-License-Identifier: Apache-2.0
#include "cli/error_option.h"

#include <charconv>
#include <system_error>

namespace sac {
namespace {

constexpr double kLeast = 1e-30, kLargest = 1e30;

bool Parse(const std::string& word, ErrorLength& length) {
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, length.value);
  length.in_diagonals = result.ptr + 1 == end && *result.ptr == 'd';
  return result.ec == std::errc() && (result.ptr == end || length.in_diagonals) && length.value >= kLeast &&
         length.value <= kLargest;
}

}  // namespace

void AddMaxError(CLI::App& app, std::optional<ErrorLength>& target) {
  const auto parse = [&target](const CLI::results_t& words) {
    ErrorLength length;
    if (!Parse(words.front(), length)) {
      throw CLI::ValidationError(
          "--max-error", "'" + words.front() + "' is not a number from 1e-30 to 1e+30, with or without the suffix d");
    }
    target = length;
    return true;
  };
  app.add_option("--max-error", parse,
                 "no vertex of any frame is decoded farther off than this: model units or, as 1e-4d, diagonals of the "
                 "first frame's bounding box. Steps and bits come from it unless they are given [no bound]")
      ->option_text("X[d]");
}

}  // namespace sac
