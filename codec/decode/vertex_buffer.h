#pragma once

#include <cstddef>
#include <vector>

#include "sac/decoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Whether `buffers` hold so many vertices: kInvalidArgument if not.
Status CheckBuffers(const FrameBuffers& buffers, std::size_t vertices);

// Fills what is wanted. `box`: of the positions.
void FillBuffers(const Positions& positions, const std::vector<Triangle>& triangles, const Box& box,
                 const FrameBuffers& buffers);

}  // namespace sac
