// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/encode/joined_mesh.h"
#include "codec/i_frame.h"
#include "format/part_scale.h"
#include "sac/mesh.h"

namespace sac {

// The root mean square distance from the mean, model units. Of a single point its distance from the origin, or 1.
double RmsRadius(const Positions& positions);

// The components of a mesh that is to be coded.
struct MeshParts {
  std::vector<std::uint32_t> of_vertex;
  std::vector<PartScale> scales;  // of each; empty when none is much smaller than the mesh
};

// Finds the components that are much smaller than the mesh, whose RMS radius is `rms`, and how much finer each has to
// be so that its error is to its size about as the mesh's to the mesh's. Their origins are left open. 2^19 steps of
// displacement, each `displacement_step` on the whole mesh, reach as far as the `reach` of each vertex, and what the
// choice of a frame's rigid motion leaves; model units. Without `reach` that does not matter.
MeshParts FindParts(const Mesh& mesh, double rms, double displacement_step, std::span<const float> reach);

// The scales of `parts` in the order of the components of `decoded`, whose vertices have the author's numbers `order`.
std::vector<PartScale> ScalesOf(const MeshParts& parts, const JoinedMesh& input, const DecodedMesh& decoded,
                                const std::vector<std::uint32_t>& order);

}  // namespace sac
