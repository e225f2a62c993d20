// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sac/sparse_components.h"

namespace sac {

// Decomposes `clip` with the fewest components, within a tenth, whose Erms is at most `erms`: their number grows by
// half until they suffice, then the gap is halved. kInvalidArgument, saying what was reached, where 1024 do not
// suffice.
Status DecomposeToError(ClipReader& clip, const DecompositionSettings& settings, double erms, SparseComponents& result,
                        DecompositionReport& report, ReconstructionError& error, std::uint32_t& decompositions);

}  // namespace sac
