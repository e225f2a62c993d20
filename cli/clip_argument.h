// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "files/warnings.h"
#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

// A clip that a command reads: files as for `sac encode`, or one .sac stream, whose frames are decoded first.
struct ClipArgument {
  std::unique_ptr<ClipReader> reader;
  std::array<double, 3> offset = {};  // is to be added to positions, model units
  Warnings warnings;                  // of opening it
};

// True if the arguments name a stream.
bool IsStreamName(const std::vector<std::string>& arguments);

Status OpenClip(const std::vector<std::string>& arguments, ClipArgument& clip);

// Adds the option INPUT.
void AddClipArgument(CLI::App& app, std::vector<std::string>& arguments, bool required);

}  // namespace sac
