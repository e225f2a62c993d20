// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "files/losses.h"
#include "sac/status.h"

namespace sac {

// What stands between an OM file and OpenMesh 9's reader of it, which trusts what it reads: it asserts on chunk types
// it does not expect, resizes to whatever a custom property says, and prints to std::cerr. `cleaned` holds only the
// chunks that make a Mesh (positions, normals, texture coordinates, colours, topology), each checked against the size
// of the file; `losses` has the others. Messages do not name the file.
Status CleanOm(std::string_view bytes, std::string& cleaned, Losses& losses);

}  // namespace sac
