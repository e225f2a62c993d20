// SPDX-License-Identifier: Apache-2.0
#include "cli/component_output.h"

#include <deque>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/component_file.h"
#include "files/component_tables.h"
#include "files/gltf/component_gltf.h"
#include "files/output_file.h"
#include "files/path.h"
#include "report/component_page.h"

namespace sac {
namespace {

constexpr double kFpsOfUnknown = 24;

double Fps(const SparseComponents& components) {
  return components.rate.per_second() > 0 ? components.rate.per_second() : kFpsOfUnknown;
}

Status Format(const SparseComponents& components, const std::string& path, std::string& bytes, double& rounding) {
  if (Extension(path) == ".npz") return FormatComponents(components, bytes);
  if (Extension(path) == ".csv") {
    bytes = FormatWeights(components);
    return Status::Ok();
  }
  return FormatComponentGltf(components, Fps(components), bytes, rounding);
}

// The directory of a report, which goes again where it was made for nothing.
class ReportDirectory {
 public:
  explicit ReportDirectory(std::string path) : path_(std::move(path)) {}
  ReportDirectory(const ReportDirectory&) = delete;
  ReportDirectory& operator=(const ReportDirectory&) = delete;
  ~ReportDirectory() {
    std::error_code ignored;
    if (made_) std::filesystem::remove(path_, ignored);
  }

  std::string page() const { return PageOfReport(path_); }
  Status Make() {
    std::error_code error;
    made_ = std::filesystem::create_directories(path_, error);
    return error ? Status::IoError(path_ + ": " + error.message()) : Status::Ok();
  }
  void Keep() { made_ = false; }

 private:
  std::string path_;
  bool made_ = false;
};

}  // namespace

std::string PageOfReport(const std::string& directory) {
  return (std::filesystem::path(directory) / "components.html").string();
}

Status CheckComponentOutput(const std::string& path) {
  const std::string extension = Extension(path);
  if (extension == ".npz" || extension == ".glb" || extension == ".csv") return Status::Ok();
  return Status::InvalidArgument(path + ": not a file for components by its name (.npz, .glb or .csv)");
}

Status WriteComponentOutputs(const SparseComponents& components, const std::vector<std::string>& paths,
                             const std::string& report, const ReportedClip& clip, double& rounding) {
  rounding = 0;
  std::deque<OutputFile> files;
  const auto write = [&files](const std::string& path, const Status& formatted, const std::string& bytes) -> Status {
    if (!formatted.ok()) return {formatted.code(), path + ": " + formatted.message()};
    OutputFile& file = files.emplace_back();
    SAC_RETURN_IF_ERROR(file.Open(path));
    SAC_RETURN_IF_ERROR(file.Write(bytes));
    return file.Close();
  };
  for (const std::string& path : paths) {
    std::string bytes;
    const Status formatted = Format(components, path, bytes, rounding);
    SAC_RETURN_IF_ERROR(write(path, formatted, bytes));
  }
  ReportDirectory directory(report);
  if (!report.empty()) {
    std::string page;
    const Status formatted =
        FormatComponentPage(components, {clip.name, clip.error.erms, clip.error.max, Fps(components)}, page);
    if (formatted.ok()) SAC_RETURN_IF_ERROR(directory.Make());
    SAC_RETURN_IF_ERROR(write(directory.page(), formatted, page));
  }
  for (OutputFile& file : files) SAC_RETURN_IF_ERROR(file.Commit());
  directory.Keep();
  return Status::Ok();
}

}  // namespace sac
