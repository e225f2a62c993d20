// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// What a stream says of its clip besides meshes and frames (spec.md 3.3). Nothing of it influences decoding. All of it
// may be left out; text is UTF-8.
struct Metadata {
  std::string name;                                       // of the clip
  std::optional<double> metres_per_unit;                  // length of a model unit, above 0
  std::optional<std::uint8_t> up_axis;                    // 0, 1, 2: x, y, z points up
  std::optional<std::int32_t> first_frame;                // the author's number of frame 0
  std::optional<bool> loops;                              // whether the clip is made to be played in a loop
  std::string json;                                       // the author's own
  std::optional<Box> bounds;                              // of what was encoded, over all frames, model units
  std::vector<std::array<std::uint8_t, 6>> group_bounds;  // of each group: see GroupBounds()

  bool empty() const {
    return name.empty() && !metres_per_unit && !up_axis && !first_frame && !loops && json.empty() && !bounds;
  }
  // The box of group `i`, which the stream has in 1/255 of `bounds`, rounded outwards. Needs `bounds`.
  Box GroupBounds(std::size_t i) const {
    Box box;
    for (std::size_t a = 0; a < 3; ++a) {
      const double unit = bounds->size()[a] / 255;
      box.low[a] = bounds->low[a] + unit * group_bounds[i][a];
      box.high[a] = bounds->low[a] + unit * group_bounds[i][a + 3];
    }
    return box;
  }
};

}  // namespace sac
