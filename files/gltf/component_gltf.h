// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// Components of displacements as a binary glTF 2.0 file: the rest shape as a mesh whose morph targets are the
// components, by their names, with sparse accessors; their weights and the track as an animation of `fps` frames a
// second. Values are 16-bit integers (KHR_mesh_quantization); `error` becomes the most by which that moves a vertex at
// weights of 1 at most, model units.
//
// kUnsupported for components of gradients, which a morph target cannot be: baked as displacements they lose what they
// are for. kLimit for more than 4 GB.
Status FormatComponentGltf(const SparseComponents& components, double fps, std::string& bytes, double& error);

}  // namespace sac
