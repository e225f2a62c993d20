// SPDX-License-Identifier: Apache-2.0
#include "cli/component_output.h"

#include <deque>

#include "files/component_file.h"
#include "files/component_tables.h"
#include "files/gltf/component_gltf.h"
#include "files/output_file.h"
#include "files/path.h"

namespace sac {
namespace {

constexpr double kFpsOfUnknown = 24;

Status Format(const SparseComponents& components, const std::string& path, std::string& bytes, double& rounding) {
  if (Extension(path) == ".npz") return FormatComponents(components, bytes);
  if (Extension(path) == ".csv") {
    bytes = FormatWeights(components);
    return Status::Ok();
  }
  const double fps = components.rate.per_second() > 0 ? components.rate.per_second() : kFpsOfUnknown;
  return FormatComponentGltf(components, fps, bytes, rounding);
}

}  // namespace

Status CheckComponentOutput(const std::string& path) {
  const std::string extension = Extension(path);
  if (extension == ".npz" || extension == ".glb" || extension == ".csv") return Status::Ok();
  return Status::InvalidArgument(path + ": not a file for components by its name (.npz, .glb or .csv)");
}

Status WriteComponentOutputs(const SparseComponents& components, const std::vector<std::string>& paths,
                             double& rounding) {
  rounding = 0;
  std::deque<OutputFile> files;
  for (const std::string& path : paths) {
    std::string bytes;
    const Status formatted = Format(components, path, bytes, rounding);
    if (!formatted.ok()) return {formatted.code(), path + ": " + formatted.message()};
    OutputFile& file = files.emplace_back();
    SAC_RETURN_IF_ERROR(file.Open(path));
    SAC_RETURN_IF_ERROR(file.Write(bytes));
    SAC_RETURN_IF_ERROR(file.Close());
  }
  for (OutputFile& file : files) SAC_RETURN_IF_ERROR(file.Commit());
  return Status::Ok();
}

}  // namespace sac
