// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/encode/i_frame_encoder.h"
#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Puts the header's grid around the positions of the first frame, and finds the I-frame's steps. `bits`: log2 of the
// extent in steps at edges of median length. `by_edges`: whether steps follow the edges' lengths. kInvalidArgument when
// the coordinates span more than floats take.
Status ChooseGrid(const Mesh& mesh, double bits, bool by_edges, SequenceHeader& header, PositionTargets& targets);

}  // namespace sac
