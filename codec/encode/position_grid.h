// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/encode/i_frame_encoder.h"
#include "codec/encode/part_scales.h"
#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Sets the header's position grid such that it encloses the first frame, and chooses the steps of the I-frame's
// positions. `bits` is log2 of the largest extent divided by the step at edges of median length. With `by_edges` steps
// grow with the lengths of edges. `parts` get the origins of their grids, and coarser ones where theirs would not hold
// them. `targets` gets the positions, in cells of these, and the steps. Returns kInvalidArgument when the coordinates
// span more than 1e37.
Status ChooseGrid(const Mesh& mesh, double bits, bool by_edges, SequenceHeader& header, MeshParts& parts,
                  PositionTargets& targets);

}  // namespace sac
