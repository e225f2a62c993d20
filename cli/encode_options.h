// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/error_option.h"
#include "cli/frame_range_option.h"
#include "sac/clip_encoder.h"

namespace sac {

// What `sac encode` is asked for.
struct EncodeOptions {
  std::vector<std::string> inputs;  // as for ClipInput
  std::string output;               // `-` is standard output
  std::string order_map;            // the file for the order of the vertices; empty: none
  ClipEncoding encoding;
  std::optional<ErrorLength> max_error;  // becomes the encoder's
  std::optional<double> quality;
  std::string reference = "key";
  std::string gaps = "error";
  std::string up_axis;           // x, y or z; empty: not said
  std::string json_file;         // of the author; empty: none
  std::string animation, scene;  // of a file that holds several
  bool json = false, strict = false, skip_damage = false;
  bool start_only = false;  // write the start alone
  std::string from;         // the file of a start; empty: the clip has its own
  WantedFrames part;        // with `from`: which frames are encoded
};

// Adds the options of `sac encode`, whose values go to `options`.
void AddEncodeOptions(CLI::App& app, EncodeOptions& options);

}  // namespace sac
