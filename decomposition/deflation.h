// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decomposition/alternation.h"
#include "decomposition/node_field.h"

namespace sac {

// The first guess of weights and components, one after the other (Neumann et al. 2013, section 3.2): what the node with
// most energy left does, fading out along the surface. `state` has its sizes and, for the first components, its sites.
void Deflate(const NodeField& field, const AlternationSettings& settings, Alternation& state);

// lambda times ramp at every node, for a component at `nodes`; infinite at the nodes that must be still.
std::vector<float> SupportCost(const NodeField& field, const AlternationSettings& settings,
                               const std::vector<std::uint32_t>& nodes);

}  // namespace sac
