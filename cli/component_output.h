// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// kInvalidArgument where the name is not that of a file for components: .npz, .glb or .csv.
Status CheckComponentOutput(const std::string& path);

// What a report says of the clip.
struct ReportedClip {
  std::string name;
  ReconstructionError error;
};

// The file in the directory of a report.
std::string PageOfReport(const std::string& directory);

// Writes the components as files of these names and, unless `report` is empty, a page into that directory, which is
// made if need be. All files get their names at the end. `rounding` becomes the most by which a .glb moves a vertex,
// model units; 0 where there is none.
Status WriteComponentOutputs(const SparseComponents& components, const std::vector<std::string>& paths,
                             const std::string& report, const ReportedClip& clip, double& rounding);

}  // namespace sac
