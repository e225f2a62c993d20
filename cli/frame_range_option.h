// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace sac {

// A range of frames by their numbers in a clip, from 0.
struct WantedFrames {
  std::uint32_t begin = 0;
  std::optional<std::uint32_t> end;  // the number after the last; all to the last if not given
};

// Adds an option whose value is `A:B`, `A:`, `:B` or `A`: frames A up to but without B, or the one frame A. A name that
// does not begin with dashes is an argument.
CLI::Option* AddFrameRange(CLI::App& app, const std::string& name, WantedFrames& range, const std::string& help);

}  // namespace sac
