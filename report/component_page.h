// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// What a page says of components beside themselves.
struct ComponentPageFacts {
  std::string title;     // such as the path of the clip
  double erms = 0;       // see ReconstructionError
  double max_error = 0;  // model units
  double fps = 24;       // at which the clip is played
};

// A page in one file: each component as colours on the mesh, its weights as a curve, and a slider that moves the mesh.
// Components of gradients are posed by the browser as by ComponentPoser, but for tolerances of a picture.
//
// kUnsupported where the program was built without Chart.js and three.js; kLimit where browsers could not take the
// page.
Status FormatComponentPage(const SparseComponents& components, const ComponentPageFacts& facts, std::string& page);

}  // namespace sac
