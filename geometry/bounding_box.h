#pragma once

#include "sac/mesh.h"

namespace sac {

// A point at the origin for no positions.
Box BoundingBox(const Positions& positions);

}  // namespace sac
