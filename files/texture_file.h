// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The bytes of images of `width` x `height` texels of red, green and blue, the first row at the top. Messages name no
// file.

// PNG of 16 bits, without a gamma; values are clamped to 0..1.
Status FormatPng16(const std::vector<Vec3f>& texels, std::size_t width, std::size_t height, std::string& bytes);

// OpenEXR of 32-bit floats, compressed by zip.
Status FormatExr(const std::vector<Vec3f>& texels, std::size_t width, std::size_t height, std::string& bytes);

}  // namespace sac
