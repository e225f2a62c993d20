// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace sac {

// The shape that a frame's motion is measured against (spec.md 4).
enum class ReferenceShape : std::uint8_t {
  kKey = 0,       // the decoded I-frame
  kPrevious = 1,  // the reconstruction of the frame before, as published (Wang et al. 2015)
};

// What a stream says of itself before its first frame.
struct StreamInfo {
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
  std::uint32_t harmonics = 0;             // sum over the connected components
  std::uint32_t frame_rate_numerator = 0;  // frames per second are numerator / denominator; 0: unknown
  std::uint32_t frame_rate_denominator = 1;
  ReferenceShape reference_shape = ReferenceShape::kKey;
  double position_step = 0;      // between neighbouring positions of the I-frame, model units
  double motion_step = 0;        // radians (rotation), strain (stretch)
  double rotation_step = 0;      // of a frame's rigid motion, radians
  double displacement_step = 0;  // model units
  double detail_step = 0;        // model units; 0: the stream has no detail plane
  double correction_step = 0;    // model units; 0: the stream has no correction plane
  // What to add to all positions to have the author's coordinates, model units. They may be so large that a float
  // cannot hold the sum.
  std::array<double, 3> offset = {};

  // 0 where the frame rate is unknown.
  double frames_per_second() const {
    return static_cast<double>(frame_rate_numerator) / static_cast<double>(frame_rate_denominator);
  }
};

// The bytes of a stream by what they say. They add up to its size.
struct StreamBytes {
  double header = 0;        // magic, sequence header, end and index
  double i_frame = 0;       // connectivity, positions and attributes of the mesh
  double motion = 0;        // rotation and stretch of the surface
  double displacement = 0;  // smooth correction of where it is
  double detail = 0;        // correction within patches
  double correction = 0;    // correction of single vertices
  double side = 0;          // rigid motion, frame types, packet framing of groups
};

}  // namespace sac
