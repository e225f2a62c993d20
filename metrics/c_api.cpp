// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "metrics/error_meter.h"
#include "sac/sac_measure.h"

struct sac_meter {
  std::unique_ptr<sac::ErrorMeter> meter;  // null when sac_meter_open() failed
  sac::Positions original, decoded;        // the frame that is being added
  std::string message;                     // message of the last call that failed
};

namespace {

// Runs `step` and turns exceptions into a status, since none may enter C code.
template <class Step>
sac_status Run(sac_meter* meter, Step&& step) {
  try {
    return step();
  } catch (const std::exception&) {
    meter->message.clear();
    return SAC_LIMIT;
  }
}

sac_status Complain(sac_meter& meter, std::string message) {
  meter.message = std::move(message);
  return SAC_INVALID_ARGUMENT;
}

sac_status Open(sac_meter& meter, std::uint32_t vertices, const std::uint32_t* indices, std::uint32_t count) {
  if (count > 0 && indices == nullptr) return Complain(meter, "triangles: a null pointer");
  std::vector<sac::Triangle> triangles(count);
  if (count > 0) std::memcpy(triangles.data(), indices, triangles.size() * sizeof(sac::Triangle));
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (const std::uint32_t v : triangles[j]) {
      if (v < vertices) continue;
      return Complain(meter, "triangle " + std::to_string(j) + " has vertex " + std::to_string(v) + " of " +
                                 std::to_string(vertices));
    }
  }
  meter.original.resize(vertices);
  meter.decoded.resize(vertices);
  meter.meter = std::make_unique<sac::ErrorMeter>(std::move(triangles), vertices);
  return SAC_OK;
}

}  // namespace

sac_status sac_meter_open(sac_meter** meter, uint32_t vertices, const uint32_t* triangle_vertices, uint32_t triangles) {
  if (meter == nullptr) return SAC_INVALID_ARGUMENT;
  *meter = new (std::nothrow) sac_meter;
  if (*meter == nullptr) return SAC_LIMIT;
  return Run(*meter, [&] { return Open(**meter, vertices, triangle_vertices, triangles); });
}

void sac_meter_close(sac_meter* meter) { delete meter; }

sac_status sac_meter_add(sac_meter* meter, const float* original, const float* decoded) {
  if (meter == nullptr) return SAC_INVALID_ARGUMENT;
  return Run(meter, [&] {
    if (!meter->meter) return Complain(*meter, "the meter could not be opened");
    const std::size_t bytes = meter->original.size() * sizeof(sac::Vec3f);
    if (bytes > 0) {
      if (original == nullptr || decoded == nullptr) return Complain(*meter, "positions: a null pointer");
      std::memcpy(meter->original.data(), original, bytes);
      std::memcpy(meter->decoded.data(), decoded, bytes);
    }
    meter->meter->Add(meter->original, meter->decoded);
    return SAC_OK;
  });
}

sac_status sac_meter_result(const sac_meter* meter, sac_distortion* distortion) {
  if (meter == nullptr || !meter->meter || distortion == nullptr) return SAC_INVALID_ARGUMENT;
  try {
    const sac::DistortionMetrics m = meter->meter->Result();
    *distortion = {m.kg, m.sted, m.sted_s, m.sted_t, m.max_error, m.seam_gap, static_cast<std::uint32_t>(m.frames)};
    return SAC_OK;
  } catch (const std::exception&) {
    return SAC_LIMIT;
  }
}

const char* sac_meter_message(const sac_meter* meter) { return meter == nullptr ? "no meter" : meter->message.c_str(); }
