// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "codec/encode/operating_point.h"
#include "sac/mesh.h"

namespace sac {

// The quality beyond which streams have a detail plane.
inline constexpr double kDetailQuality = 78;

// The most harmonics that qualities give a mesh of so many vertices, 200 at least. In a small mesh more pay less than
// detail does, as they approach a code for every vertex; in a large mesh decoders would take too long to start, or too
// much memory.
double MostHarmonics(std::uint32_t vertices);

// The position bits that a mesh takes beyond the table's. STED is relative to its edges: the same error of positions is
// worse where they are shorter. 0 without edges.
double BitsOfDensity(const Mesh& mesh);

// The size of a mesh's edges. Detail steps follow it.
struct EdgeScale {
  double median = 1.0 / 30;  // of the edges' lengths, fraction of the RMS radius
  double more_bits = 0;      // BitsOfDensity()
};
// The scale of the first frame `mesh`, whose RMS radius is `rms` model units. Typical values where it has no edges.
EdgeScale EdgeScaleOf(const Mesh& mesh, double rms);

// `quality` from 0 to 100, and beyond with the last rows' ratios: from a table measured on several clips
// (docs/quality.md), interpolated between its rows. The result has at most `max_harmonics`, or 200.
OperatingPoint PointOfQuality(double quality, double max_harmonics, const EdgeScale& scale = {});

// The same without a detail plane: beyond kDetailQuality the other steps become finer instead.
OperatingPoint SmoothPointOfQuality(double quality, double max_harmonics);

// The same with a detail plane from 60 on, which begins so coarse that it codes next to nothing. STED may rise there.
OperatingPoint DetailPointOfQuality(double quality, double max_harmonics);

}  // namespace sac
