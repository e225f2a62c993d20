// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/normals.h"
#include "sac/decoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Checks that `buffers` have room for `vertices` vertices. Returns kInvalidArgument when one has not.
Status CheckBuffers(const FrameBuffers& buffers, std::size_t vertices);

// Fills those of `buffers` that are not null. `box` is the bounding box of `positions`. `normals` computes the normals
// when their buffer is wanted.
void FillBuffers(const Positions& positions, const std::vector<Triangle>& triangles, const Box& box,
                 const FrameBuffers& buffers, NormalField& normals);

}  // namespace sac
