// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/warnings.h"
#include "sac/status.h"

namespace sac {

// What becomes of frames whose numbers are missing in a sequence of files.
enum class Gaps {
  kError,
  kHold,  // the frame before stands for them
  kSkip,  // they are left out
};

// The files of a clip's frames.
struct FrameSequence {
  std::vector<std::string> paths;  // one a frame; a path may come several times
  std::int64_t first_number = 0;   // of the first frame, where the files are numbered
  std::int64_t step = 1;           // from number to number
};

// Whether one name stands for the files of a sequence: a pattern or a directory.
bool IsSequenceName(const std::string& name);

// Finds the mesh files that `arguments` name: one pattern (see FramePattern; an existing file of that very name comes
// first), or one directory, whose numbered mesh files must be of one sequence, or the files themselves, one a frame.
// Numbers that are missing in a pattern, or in a directory, are gaps; numbers that go on by a common step have none.
//
// kIoError when nothing is found; kInvalidArgument, naming the frames that are missing, with Gaps::kError. `warnings`
// gets what the user may not expect: a step, gaps held or skipped, a first number other than 0 and 1, files in another
// order than their numbers.
Status FindSequence(const std::vector<std::string>& arguments, Gaps gaps, FrameSequence& sequence, Warnings& warnings);

}  // namespace sac
