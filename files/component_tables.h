// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sac/component_poser.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// The text files of components. Every message starts with the path, and the line where one is at fault.

// Weights as comma-separated values: a line of names, `frame` first, then a line a frame.
std::string FormatWeights(const SparseComponents& components);

// Reads weights, frames x `count`. The first line may hold names; a column named `frame` is left out.
Status ReadWeights(const std::string& path, std::size_t count, std::vector<float>& weights);

// A stroke: a line for each vertex, its index from 0 and, for a component that is given, its displacement x y z in
// model units; all lines have one or none. # begins a comment. Its name is that of the file without the suffix.
Status ReadStroke(const std::string& path, Stroke& stroke);

// Vertices that are dragged: lines of an index from 0 and the position x y z that it shall have, model units.
Status ReadDrag(const std::string& path, std::vector<DragTarget>& targets);

}  // namespace sac
