// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// Sparse components as an .npz archive, without loss, for numpy and for reading back:
//   domain       |u1 scalar: 0 displacement, 1 gradient
//   positive     |u1 scalar
//   rest         <f4 vertices x 3
//   triangles    <u4 triangles x 3
//   components   <f4 components x nodes x channels
//   weights      <f4 frames x components
//   rotations    <f8 frames x 3 x 3 and moves <f8 frames x 3: the track
//   centres      <u4 components
//   names        |u1 UTF-8, separated by zeros
//   still        <u4 vertices that no component moves
//   rate         <u4 2: frames a second, numerator and denominator; 0 / 1 where unknown

// The bytes of a file.
Status FormatComponents(const SparseComponents& components, std::string& bytes);

// Reads a file that was written so, or by numpy with at least domain, rest, triangles, components and weights.
// kIoError, kCorrupt, kUnsupported; the message starts with the path. What was read is consistent as far as sizes go;
// ComponentPoser::Create() checks the rest.
Status ReadComponents(const std::string& path, SparseComponents& components);

}  // namespace sac
