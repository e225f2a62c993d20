// SPDX-License-Identifier: Apache-2.0
#include "files/overwriting.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "files/cache_file.h"
#include "files/frame_pattern.h"

namespace sac {
namespace {

std::vector<std::string> Expand(const std::string& path) {
  std::vector<std::string> files;
  FramePattern pattern;
  if (FramePattern::IsPattern(path) && FramePattern::Parse(path, pattern).ok() && pattern.List(files).ok()) {
    return files;
  }
  return {path};
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

std::vector<std::string> FilesOfOutput(const std::string& path) {
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

bool IsStandardOutput(const std::string& path) {
  if (path == "-") return true;
  struct stat file {
  }, standard{};
  if (stat(path.c_str(), &file) != 0 || fstat(STDOUT_FILENO, &standard) != 0) return false;
  return file.st_dev == standard.st_dev && file.st_ino == standard.st_ino;
}

}  // namespace sac
