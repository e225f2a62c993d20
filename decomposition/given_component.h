// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decomposition/rest_alignment.h"
#include "decomposition/surface_distance.h"
#include "sac/sparse_components.h"

namespace sac {

// The component that a stroke with displacements is, vertices x 3, divided by `scale`: at the stroke's vertices what it
// says; elsewhere the displacement of the nearest of them, faded out with the distance from the stroke along the
// surface, from all of it up to settings.near to nothing at settings.far.
std::vector<float> GivenComponent(const Stroke& stroke, const DecompositionSettings& settings,
                                  const SurfaceDistance& distance, const RestAlignment& alignment, double scale);

}  // namespace sac
