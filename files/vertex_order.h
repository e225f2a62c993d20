// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The order of a clip's vertices before it was encoded: for each decoded vertex its index in the input. A permutation.
using VertexOrder = std::vector<std::uint32_t>;

// Decoded positions in the order of the input. `order` is of the same length.
Positions ToInputOrder(const Positions& decoded, const VertexOrder& order);

// The same for a mesh with all that refers to its vertices. Triangles stay where they are.
Mesh ToInputOrder(const Mesh& decoded, const VertexOrder& order);

// An order map: a text file of the line `# sac order map, N vertices` and an index a line. Lines that begin with # are
// comments.
std::string FormatOrderMap(const VertexOrder& order);

// kIoError, kCorrupt: the file cannot be read, or is no permutation of `vertices` indices; the message starts with the
// path.
Status ReadOrderMap(const std::string& path, std::size_t vertices, VertexOrder& order);

}  // namespace sac
