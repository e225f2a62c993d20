// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// kInvalidArgument where the name is not that of a file for components: .npz, .glb or .csv.
Status CheckComponentOutput(const std::string& path);

// Writes components to each of `paths`, all files or none. `rounding` becomes the most by which the 16-bit integers of
// a .glb move a vertex, model units; 0 without one.
Status WriteComponentOutputs(const SparseComponents& components, const std::vector<std::string>& paths,
                             double& rounding);

}  // namespace sac
