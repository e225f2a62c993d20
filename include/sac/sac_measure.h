// SPDX-License-Identifier: Apache-2.0
/* How near a decoded clip is to its original, for C, and for what speaks C. distortion.h defines the figures for C++.
 *
 *   sac_meter* meter;
 *   if (sac_meter_open(&meter, vertices, triangle_vertices, triangles) != SAC_OK) goto failed;
 *   for (each frame, in order) sac_meter_add(meter, original, decoded);
 *   sac_meter_result(meter, &distortion);
 *   failed: puts(sac_meter_message(meter));
 *   sac_meter_close(meter);
 *
 * A meter holds about 390 bytes a vertex of a closed surface, however many frames there are. It is used by one thread
 * at a time; meters share nothing. What the caller gives is read during the call alone. No function throws or ends the
 * program. */
#ifndef SAC_MEASURE_H
#define SAC_MEASURE_H

#include "sac.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sac_distortion {
  double kg;            /* percent of the original's own spread (Karni and Gotsman 2004); infinite where it has none */
  double sted;          /* without unit (Vasa and Skala 2011), of the next two */
  double sted_spatial;  /* how wrongly edges are stretched */
  double sted_temporal; /* how wrongly that changes; 0 with a single frame */
  double max_error;     /* largest distance between a vertex and its decoded position, model units */
  double seam_gap; /* largest distance between decoded vertices that coincide in every original frame, model units */
  uint32_t frames; /* that were added */
} sac_distortion;

typedef struct sac_meter sac_meter;

/* `triangle_vertices` has 3 indices a triangle and may be null without triangles. After an error *meter is there only
 * to give its message and be closed; it is null when memory is too short even for that. SAC_INVALID_ARGUMENT for a
 * triangle of a missing vertex, SAC_LIMIT when memory is short. */
SAC_API sac_status sac_meter_open(sac_meter** meter, uint32_t vertices, const uint32_t* triangle_vertices,
                                  uint32_t triangles);
/* Null is allowed. */
SAC_API void sac_meter_close(sac_meter* meter);
/* Takes the next frame, as it was and as it was decoded: 3 floats a vertex, in the same order of vertices, model units.
 * Coordinates that are not finite make the results that they enter infinite or NaN. */
SAC_API sac_status sac_meter_add(sac_meter* meter, const float* original, const float* decoded);
/* The distortion of the frames so far, all zeros before the first. */
SAC_API sac_status sac_meter_result(const sac_meter* meter, sac_distortion* distortion);
/* The complaint of the last call that failed, one line; empty when none has. */
SAC_API const char* sac_meter_message(const sac_meter* meter);

#ifdef __cplusplus
}
#endif

#endif
