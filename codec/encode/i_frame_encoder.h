// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/encode/joined_mesh.h"
#include "codec/i_frame.h"
#include "codec/position_predictor.h"
#include "format/i_frame_syntax.h"
#include "format/sequence_header.h"
#include "sac/status.h"

namespace sac {

// Where the input's vertices are, in cells of the header's grid, and how finely they are wanted.
struct PositionTargets {
  std::vector<std::array<double, 3>> cells;
  PositionSteps steps;
};

// Codes the mesh part of an I-frame: fills `syntax` but for the basis, decodes it again into `decoded`, and gives for
// each vertex that decoders give out its index in the author's mesh. `targets` are those of the joined vertices.
// kInvalidArgument when the mesh cannot be coded.
Status EncodeIFrameMesh(const JoinedMesh& input, const PositionTargets& targets, const SequenceHeader& header,
                        IFrameSyntax& syntax, DecodedIFrame& decoded, std::vector<std::uint32_t>& order);

}  // namespace sac
