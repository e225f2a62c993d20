// SPDX-License-Identifier: Apache-2.0
#include "files/frame_sequence.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "files/frame_pattern.h"
#include "files/mesh_file.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

using NumberedFiles = std::map<std::int64_t, std::string>;

// The greatest number that divides all distances between neighbours, 1 for a single file.
std::int64_t CommonStep(const NumberedFiles& files) {
  std::int64_t step = 0, last = files.begin()->first;
  for (const auto& [number, path] : files) {
    step = std::gcd(step, number - last);
    last = number;
  }
  return std::max<std::int64_t>(step, 1);
}

// A run of numbers in words.
std::string Run(std::int64_t first, std::int64_t last) {
  return first == last ? std::to_string(first) : std::to_string(first) + " to " + std::to_string(last);
}

// The numbers that are missing, in words; empty if there are none.
std::string Missing(const NumberedFiles& files, std::int64_t step) {
  constexpr int kMostRuns = 8;
  std::string text;
  std::int64_t last = files.begin()->first;
  int runs = 0;
  for (const auto& [number, path] : files) {
    if (number - last > step && ++runs <= kMostRuns) {
      text += (text.empty() ? "" : ", ") + Run(last + step, number - step);
    }
    last = number;
  }
  if (runs > kMostRuns) text += " and in " + std::to_string(runs - kMostRuns) + " more gaps";
  return text;
}

Status TakeNumbered(const std::string& name, const NumberedFiles& files, Gaps gaps, FrameSequence& sequence,
                    Warnings& warnings) {
  sequence = {{}, files.begin()->first, CommonStep(files)};
  const std::string missing = Missing(files, sequence.step);
  if (!missing.empty() && gaps == Gaps::kError) {
    return Status::InvalidArgument(name + ": no file has the number " + missing +
                                   "; --gaps hold repeats the frame before each gap, --gaps skip leaves gaps out");
  }
  std::int64_t last = sequence.first_number;
  for (const auto& [number, path] : files) {
    if (gaps == Gaps::kHold) {
      for (; last + sequence.step < number; last += sequence.step) sequence.paths.push_back(sequence.paths.back());
    }
    sequence.paths.push_back(path);
    last = number;
  }
  if (sequence.step > 1) {
    warnings.push_back(name + ": its numbers go from " + std::to_string(sequence.first_number) + " to " +
                       std::to_string(last) + " in steps of " + std::to_string(sequence.step) +
                       "; each file is one frame of the stream");
  }
  if (!missing.empty()) {
    warnings.push_back(name + ": no file has the number " + missing + "; " +
                       (gaps == Gaps::kHold ? "the frame before the gap stands in" : "the stream goes on without"));
  }
  if (sequence.first_number != 0 && sequence.first_number != 1) {
    warnings.push_back(name + ": its first frame has the number " + std::to_string(sequence.first_number) +
                       ", which the stream does not keep; decode --first-number " +
                       std::to_string(sequence.first_number) + " brings it back");
  }
  return Status::Ok();
}

// A path with its last run of digits cut out, and their number.
struct Numbered {
  std::string before, after;
  std::optional<std::int64_t> number;  // nothing where it is too large
};

std::optional<Numbered> SplitNumber(const std::string& path) {
  const std::size_t name = path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1;
  const std::size_t stem = std::max(path.rfind('.') == std::string::npos ? path.size() : path.rfind('.'), name);
  const std::size_t last = path.find_last_of("0123456789", stem == 0 ? 0 : stem - 1);
  if (last == std::string::npos || last < name) return std::nullopt;
  std::size_t first = last;
  while (first > name && path[first - 1] >= '0' && path[first - 1] <= '9') --first;
  std::int64_t number = 0;
  const bool fits = std::from_chars(path.data() + first, path.data() + last + 1, number).ec == std::errc();
  return Numbered{path.substr(0, first), path.substr(last + 1), fits ? std::optional(number) : std::nullopt};
}

// The numbered mesh files of a directory, which must be of one sequence.
Status ListDirectory(const std::string& directory, std::string& name, NumberedFiles& files) {
  std::map<std::pair<std::string, std::string>, NumberedFiles> sequences;
  std::error_code error;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string path = entry->path().string();
    if (!IsReadableMeshName(path)) continue;
    const std::optional<Numbered> split = SplitNumber(path);
    if (!split) continue;
    if (!split->number) return Status::InvalidArgument(path + ": its frame number is too large");
    const auto [other, added] = sequences[{split->before, split->after}].try_emplace(*split->number, path);
    if (!added) {
      // A directory has no order of its own.
      const auto& [first, second] = std::minmax(other->second, path);
      return Status::InvalidArgument(directory + ": " + first + " and " + second + " have the same number");
    }
  }
  if (error) return Status::IoError(directory + ": " + error.message());
  if (sequences.empty()) return Status::IoError(directory + ": no numbered mesh files (.obj, .ply, .off, .stl, .om)");
  if (sequences.size() > 1) {
    std::string patterns;
    for (const auto& [parts, of_it] : sequences) patterns += " " + parts.first + "*" + parts.second;
    return Status::InvalidArgument(directory + ": several sequences; name one, in quotes:" + patterns);
  }
  name = sequences.begin()->first.first + "*" + sequences.begin()->first.second;
  files = sequences.begin()->second;
  return Status::Ok();
}

// Tells when files that a shell has sorted are not in the order of their numbers.
void CheckOrder(const std::vector<std::string>& paths, Warnings& warnings) {
  std::optional<Numbered> last;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    std::optional<Numbered> next = SplitNumber(paths[i]);
    if (!next || (last && (next->before != last->before || next->after != last->after))) return;
    if (last && next->number < last->number) {
      warnings.push_back(paths[i] + ": comes after " + paths[i - 1] +
                         ", against the order of their numbers; the pattern '" + next->before + "*" + next->after +
                         "' in quotes reads them in that order");
      return;
    }
    last = std::move(next);
  }
}

}  // namespace

bool IsSequenceName(const std::string& name) {
  std::error_code ignored;
  if (fs::exists(name, ignored)) return fs::is_directory(name, ignored);
  return FramePattern::IsPattern(name);
}

Status FindSequence(const std::vector<std::string>& arguments, Gaps gaps, FrameSequence& sequence, Warnings& warnings) {
  sequence = {};
  const std::string& name = arguments.front();
  if (arguments.size() > 1 || !IsSequenceName(name)) {
    sequence.paths = arguments;
    CheckOrder(arguments, warnings);
    return Status::Ok();
  }
  NumberedFiles files;
  std::string title = name;
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) {
    SAC_RETURN_IF_ERROR(ListDirectory(name, title, files));
  } else {
    FramePattern pattern;
    SAC_RETURN_IF_ERROR(FramePattern::Parse(name, pattern));
    SAC_RETURN_IF_ERROR(pattern.List(files));
  }
  return TakeNumbered(title, files, gaps, sequence, warnings);
}

}  // namespace sac
