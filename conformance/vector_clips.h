// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "conformance/stream_parts.h"
#include "sac/mesh.h"
#include "synth/synth.h"

namespace sac {

// A synthetic clip; a failure ends the program.
Clip Synth(SynthKind kind, std::uint32_t vertices, std::uint32_t frames);

// Frames that wave the mesh and turn it.
Clip Wave(const Mesh& mesh, std::uint32_t frames);

// All that Draco cannot keep: two fans joined at one vertex, three triangles at an edge, a loose vertex, a degenerate
// and a duplicate triangle, one turned around; with all attributes and a seam of texture coordinates.
Mesh OddMesh();

// The same with normals of corners, in all that 5.3 says of them: smooth and hard vertices, normals that are equal once
// quantized, hard ones at a weld and at loose triangles.
Mesh OddHardMesh();

// More neighbours, and more triangles at an edge, than the code of positions looks at (spec.md 5.5): double cones
// around 31, 32 and 33 vertices, joined to each other, a book of 25 pages, and triangles at random.
Mesh CrowdedMesh();

// The first frame again and again, then motion, then its last frame again and again.
Clip StandStill();

// Parts that jump and turn between frames 8 and 16.
Clip Cuts();

}  // namespace sac
