// SPDX-License-Identifier: Apache-2.0
#include "files/overwriting.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "files/cache_file.h"
#include "files/frame_sequence.h"
#include "files/vat_writer.h"

namespace sac {
namespace {

// The files that there are of a sequence.
std::vector<std::string> Expand(const std::string& path) {
  FrameSequence sequence;
  Warnings ignored;
  if (!FindSequence({path}, Gaps::kSkip, sequence, ignored).ok()) return {path};
  return std::move(sequence.paths);
}

bool SameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  if (std::filesystem::exists(a, error) && std::filesystem::exists(b, error)) {
    return std::filesystem::equivalent(a, b, error) && std::filesystem::is_regular_file(a, error);
  }
  // Absolute first, because the canonical form of a relative path that does not exist stays relative.
  const auto canonical = [&error](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  return canonical(a) == canonical(b) && !error;
}

}  // namespace

std::vector<std::string> FilesOfInput(const std::vector<std::string>& arguments) {
  return arguments.size() == 1 ? Expand(arguments.front()) : arguments;
}

std::vector<std::string> FilesOfOutput(const std::string& path, bool exr) {
  if (IsVatName(path)) return FilesOfVat(path, exr);
  if (IsCacheName(path)) return {path, std::filesystem::path(path).replace_extension(".obj").string()};
  return Expand(path);
}

Status CheckOverwriting(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i] == "-") continue;
    for (const std::string& input : inputs) {
      if (input != "-" && SameFile(input, outputs[i])) {
        return Status::InvalidArgument(outputs[i] + ": would be overwritten while it is read");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (outputs[j] != "-" && SameFile(outputs[j], outputs[i])) {
        return Status::InvalidArgument(outputs[i] + ": would be written twice");
      }
    }
  }
  return Status::Ok();
}

Status CheckUnnamed(const std::string& path, const std::string& bytes) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, error))) return Status::Ok();
  std::ifstream file(path, std::ios::binary);
  if (file && std::filesystem::file_size(path, error) == bytes.size() &&
      std::equal(bytes.begin(), bytes.end(), std::istreambuf_iterator<char>(file))) {
    return Status::Ok();
  }
  return Status::InvalidArgument(path +
                                 ": is there already, and another mesh would replace it, although it was not named; "
                                 "give another name for the output, or --force");
}

bool IsStandardOutput(const std::string& path) {
  if (path == "-") return true;
  struct stat file {
  }, standard{};
  if (stat(path.c_str(), &file) != 0 || fstat(STDOUT_FILENO, &standard) != 0) return false;
  return file.st_dev == standard.st_dev && file.st_ino == standard.st_ino;
}

}  // namespace sac
