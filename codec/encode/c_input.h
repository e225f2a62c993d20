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

// Takes `from`, which may be null or of an older library with fewer members, over the defaults. kInvalidArgument when
// its size or a member makes no sense, kUnsupported when it is of a later library.
Status ReadSettings(const sac_encoder_settings* from, sac_encoder_settings& settings);

// A setting that may be left out: nothing where it is NaN.
std::optional<double> Given(double value);

// The settings of an encoder, without its progress callback. Targets are not among them.
EncoderSettings ToEncoderSettings(const sac_encoder_settings& settings);

// Copies 3 floats a vertex; `stride` is in bytes, 0 for 12.
Status ReadPositions(const float* from, std::size_t stride, std::span<Vec3f> positions);

// Copies a mesh. kInvalidArgument for missing arrays.
Status ReadMesh(const sac_input_mesh* from, Mesh& mesh);

sac_stream_bytes ToStreamBytes(const StreamBytes& bytes);

}  // namespace sac
