// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "files/polygon_mesh.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Wavefront OBJ, read and written here and not by OpenMesh. Its reader drops degenerate triangles and every vertex it
// cannot parse (which shifts all later indices), aborts on `f /1`, gives colours only to vertices that a face uses, and
// opens the material files a mesh names; its writer has no vertex colours and looks corner UVs up by vertex, so
// a degenerate triangle loses one.

// Parses the text of an OBJ file, normalized (NormalizeText): v (with an optional colour: r g b, or r g b a), vt, vn,
// f. Other statements are counted as losses. Messages are of the form "line 12: ..." and do not name the file.
Status ParseObj(std::string_view text, PolygonMesh& parsed);

// Takes a statement off the text: one line, or several joined by a backslash at the end. Adds the lines to
// `line_count`.
std::string_view TakeObjStatement(std::string_view& text, std::size_t& line_count);

// The text of an OBJ file. Positions are written with `offset` added, model units. Every number is written with the
// digits that bring back the identical float32, and coordinates that the offset has moved the identical double.
std::string FormatObj(const Mesh& mesh, const std::array<double, 3>& offset = {});

}  // namespace sac
