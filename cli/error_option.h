// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace sac {

// A length in model units or, with the suffix d, in diagonals of the first frame's bounding box.
struct ErrorLength {
  double value = 0;
  bool in_diagonals = false;
};

// Adds `--max-error`.
void AddMaxError(CLI::App& app, std::optional<ErrorLength>& target);

}  // namespace sac
