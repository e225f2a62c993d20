// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "conformance/stream_parts.h"
#include "sac/mesh.h"
#include "synth/synth.h"

namespace sac {

// A synthetic clip. A failure ends the program.
Clip Synth(SynthKind kind, std::uint32_t vertices, std::uint32_t frames);

// A clip in which `mesh` waves and turns.
Clip Wave(const Mesh& mesh, std::uint32_t frames);

// A mesh with everything that Draco cannot keep: two fans joined at one vertex, three triangles at an edge, a loose
// vertex, a degenerate triangle, a duplicate triangle and one with the opposite orientation. It has all attributes and
// a seam of texture coordinates.
Mesh OddMesh();

// The same with normals of corners, in all that 5.3 says of them: smooth and hard vertices, normals that are equal once
// quantized, hard ones at a weld and at loose triangles.
Mesh OddHardMesh();

// A mesh with more neighbours of a vertex, and more triangles at an edge, than the prediction of positions uses
// (spec.md 5.5): double cones around 31, 32 and 33 vertices, joined to each other, 25 triangles at one edge, and random
// triangles.
Mesh CrowdedMesh();

// `mesh` as programs of games have it: no two corners of a vertex that differ in texture coordinate, normal or colour
// share one, so that each vertex becomes several at one place. Corners of triangles by `parts` in turn have colours of
// their own, where the mesh has colours. All attributes are those of vertices; vertices without triangles stay.
Mesh SplitMesh(const Mesh& mesh, std::uint32_t parts);

// A sphere of a radius of 500 that turns, and far from it a flag of a size of about 1 that waves.
Clip SmallPart();

// A clip that repeats its first frame, then moves, then repeats the last frame of the motion.
Clip StandStill();

// A clip whose parts jump and turn between frames 8 and 16.
Clip Cuts();

}  // namespace sac
