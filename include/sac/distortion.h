// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace sac {

// The connected component that is worst against its own size.
struct PartDistortion {
  double kg = 0;                   // percent of the component's own spread about its mean in each frame
  double max_error = 0;            // largest distance between one of its vertices and its decoded position, model units
  std::uint32_t first_vertex = 0;  // its smallest vertex
  std::uint32_t vertices = 0;      // how many it has; 0: no component has an extent
};

// The distortion of a decoded animation against its original.
struct DistortionMetrics {
  // Percent of the original's own spread (Karni and Gotsman 2004). Infinite only if the original has no spread; write
  // null in JSON.
  double kg = 0;
  double sted = 0;       // spatio-temporal edge difference without unit (Vasa and Skala 2011), of the next two
  double sted_s = 0;     // its spatial part
  double sted_t = 0;     // its temporal part; 0 with a single frame
  double max_error = 0;  // largest distance between a vertex and its decoded position, model units
  // Largest distance between the decoded positions of vertices that coincide in every original frame, model units.
  double seam_gap = 0;
  PartDistortion worst_part;
  std::size_t frames = 0;
};

}  // namespace sac
