// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/checked_stream.h"
#include "format/stream_splicer.h"
#include "sac/status.h"

namespace sac {

// Gives the stream at `path`, `-` for standard input, to `splicer`, which takes the groups with frames within `wanted`,
// and what comes of it to `output`. Messages about the stream begin with its name.
Status SpliceInput(const std::string& path, const FrameSpan& wanted, StreamSplicer& splicer, CheckedStream& output);

// Adds the options of commands that write streams so.
void AddSplicing(CLI::App& app, SpliceSettings& settings, bool& check);

}  // namespace sac
