// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/sac_encode.h"
#include "sac/status.h"

namespace sac {

// Sets `settings` to the defaults and copies over them the members that `from` has. `from` may be null, or come from a
// program built with an older version, whose struct has fewer members. Returns kInvalidArgument when its size or a
// member makes no sense, kUnsupported when it comes from a later version.
Status ReadSettings(const sac_encoder_settings* from, sac_encoder_settings& settings);

// The value of an optional setting: empty when `value` is NaN, which means that the setting is not given.
std::optional<double> Given(double value);

// The C++ settings of an encoder, without the progress callback and the targets.
EncoderSettings ToEncoderSettings(const sac_encoder_settings& settings);

// Copies 3 floats for each vertex. `stride` is the distance of two vertices in bytes; 0 means 12.
Status ReadPositions(const float* from, std::size_t stride, std::span<Vec3f> positions);

// Copies a mesh. Returns kInvalidArgument when an array is missing and kLimit when it is larger than streams allow.
Status ReadMesh(const sac_input_mesh* from, Mesh& mesh);

sac_stream_bytes ToStreamBytes(const StreamBytes& bytes);

}  // namespace sac
