// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "sac/encoder.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Returns kInvalidArgument with a message when a member of `settings` is out of its range.
Status CheckSettings(const EncoderSettings& settings);

// Returns kInvalidArgument when `mesh` has no vertices, indices of missing ones, attributes for a part of its vertices
// or triangles, or attributes that Draco cannot take, and kLimit when it is larger than `limits` allow. Positions are
// left to CheckFinite().
Status CheckMesh(const Mesh& mesh, const Limits& limits);

// Returns kInvalidArgument, naming the first such vertex, when a coordinate is not finite.
Status CheckFinite(std::span<const Vec3f> positions);

}  // namespace sac
