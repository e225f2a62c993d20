// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "files/gltf/json_value.h"

namespace sac {

// Decompresses a buffer view: `compression` is its EXT_meshopt_compression or KHR_meshopt_compression object, `bytes`
// what that names. At most `most` bytes come out. Throws GltfError.
std::vector<std::uint8_t> DecodeMeshoptView(const JsonValue& compression, std::span<const std::uint8_t> bytes,
                                            std::uint64_t most);

}  // namespace sac
