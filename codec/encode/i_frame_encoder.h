#pragma once

#include <cstdint>
#include <vector>

#include "codec/decode/i_frame.h"
#include "codec/mesh.h"
#include "format/i_frame_syntax.h"
#include "format/sequence_header.h"
#include "format/status.h"

namespace sac {

// Codes the mesh part of an I-frame: fills `syntax` but for the basis, decodes it again into `decoded`, and gives for
// each decoded vertex its index in the input. `grid` holds the input's vertices on the header's grid.
// kInvalidArgument when the mesh cannot be coded.
Status EncodeIFrameMesh(const Mesh& input, const std::vector<GridPosition>& grid, const SequenceHeader& header,
                        IFrameSyntax& syntax, DecodedIFrame& decoded, std::vector<std::uint32_t>& input_of_vertex);

}  // namespace sac
