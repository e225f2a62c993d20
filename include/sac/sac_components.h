// SPDX-License-Identifier: Apache-2.0
/* Sparse localized components of a clip for C, and for what speaks C. sparse_components.h and component_poser.h are the
 * same for C++; docs/decomposition.md says what is minimized.
 *
 *   sac_decomposition_settings settings;
 *   sac_decomposition_settings_init(&settings);
 *   settings.count = 20;
 *   sac_components* components;
 *   if (sac_components_decompose(&components, vertices, triangle_vertices, triangles, &source, &settings) != SAC_OK)
 *     goto failed;
 *   sac_components_get(components, &set);                         // all that was found, to read or to store
 *   sac_components_compose(components, weights, NULL, positions); // a shape of weights
 *   failed: puts(sac_components_message(components));
 *   sac_components_close(components);
 *
 * sac_components_open() makes components of a set that was stored.
 *
 * Components are used by one thread at a time; those of different handles share nothing. What the caller gives is read
 * during the call alone. Pointers that components give out are their own: a message stays valid until the next call,
 * the rest until they are closed. No function throws or ends the program. Structs stay as they are but settings, which
 * know their size. */
#ifndef SAC_COMPONENTS_H
#define SAC_COMPONENTS_H

#include "sac.h"
#include "sac_encode.h" /* sac_frame_source */

#ifdef __cplusplus
extern "C" {
#endif

typedef enum sac_component_domain {
  SAC_DISPLACEMENT = 0, /* nodes are vertices, 3 channels: the displacement from the rest shape, model units */
  /* Nodes are triangles, 9 channels: rotation vector (radians), then xx, yy, zz, xy, xz, yz of the stretch less one. */
  SAC_GRADIENT = 1
} sac_component_domain;

/* What displacements and gradients are measured from. */
typedef enum sac_rest_shape {
  SAC_REST_FIRST_FRAME = 0,
  SAC_REST_MEAN = 1, /* of all frames, each brought onto the first by a rigid motion */
  SAC_REST_GIVEN = 2 /* `rest` of the settings */
} sac_rest_shape;

/* x becomes rotation x + translation. */
typedef struct sac_rigid_pose {
  double rotation[9];    /* row by row */
  double translation[3]; /* model units */
} sac_rigid_pose;

/* A component that the user asks for: its support grows from these vertices and does not move away. */
typedef struct sac_stroke {
  const char* name; /* UTF-8; null or empty: "stroke 0" and so on */
  uint32_t count;   /* vertices, at least one */
  const uint32_t* vertices;
  /* Null, or 3 floats a vertex, model units: then the component itself is given. It moves the vertices by these at
   * weight 1 and fades out around them, and only its weights are found. Displacement domain only. */
  const float* displacements;
} sac_stroke;

/* Called on the caller's thread after each iteration, from 1, with the objective after it. Anything but 0 ends in
 * SAC_CANCELLED. While the weights of gradients are fitted to positions, it is called after each frame with the last
 * iteration. */
typedef int (*sac_decomposition_progress)(void* user, uint32_t iteration, double objective);

/* Set it with sac_decomposition_settings_init(), then change what is to be different. */
typedef struct sac_decomposition_settings {
  uint32_t struct_size; /* of this struct, set by the call: later versions may add members */
  uint32_t domain;      /* a sac_component_domain */
  uint32_t count;       /* components, strokes included, 1 to 4096 */
  uint32_t positive;    /* 1: weights from 0 to 1; 0: from -1 to 1 */
  double sparsity;      /* lambda by the number of frames; larger: more local, less exact. At least 0 */
  /* Where a component's support begins to cost and where it costs full price, in square roots of the rest shape's
   * area; beyond, the price grows up to `steep` times. 0 <= begin < full, steep >= 1. */
  double support_begin;
  double support_full;
  double steep;
  double tolerance;     /* relative fall of the objective below which it ends, once centres rest */
  uint32_t iterations;  /* at most; at least 1 */
  uint32_t moving;      /* iterations in which centres move */
  uint32_t threads;     /* 0: as many as the machine has. The result does not depend on it */
  uint32_t rest_shape;  /* a sac_rest_shape */
  const float* rest;    /* 3 a vertex, model units, with SAC_REST_GIVEN; else null */
  uint32_t fit_weights; /* 1: weights of gradients are found anew by the positions they lead to; 0: they are not */
  uint32_t stroke_count;
  const sac_stroke* strokes; /* at most `count` */
  const uint32_t* still;     /* vertices that no component moves; may be null */
  uint32_t still_count;
  uint64_t field_memory;               /* bytes for all frames' values; more are reduced by a randomized SVD */
  sac_decomposition_progress progress; /* null: none */
  void* user;                          /* given to `progress` */
} sac_decomposition_settings;

/* One component. At weight w it adds w times its values to the nodes it has, and nothing elsewhere. */
typedef struct sac_component {
  const char* name;        /* UTF-8 */
  uint32_t centre;         /* a node */
  uint32_t nodes;          /* how many there are */
  const uint32_t* indices; /* vertices or triangles, ascending */
  const float* values;     /* 3 or 9 a node, see sac_component_domain */
} sac_component;

/* A clip taken apart. Frame f is the rest shape, deformed by the sum over k of weights[f * count + k] * component k,
 * then moved by track[f]. Arrays without members may be null. */
typedef struct sac_component_set {
  uint32_t domain;   /* a sac_component_domain */
  uint32_t positive; /* 1: weights from 0 to 1; 0: from -1 to 1 */
  uint32_t vertices;
  uint32_t triangles;
  uint32_t count; /* components */
  uint32_t frames;
  uint32_t still_count;
  const float* rest;                 /* 3 a vertex, model units */
  const uint32_t* triangle_vertices; /* 3 a triangle */
  const sac_component* components;
  const float* weights;        /* frames x count */
  const sac_rigid_pose* track; /* one a frame */
  const uint32_t* still;       /* vertices that no component moves */
} sac_component_set;

/* What a decomposition came to; all 0 for components that come from elsewhere. */
typedef struct sac_decomposition_report {
  const double* objective; /* after each iteration, `iterations` of them; of values scaled to a mean square of 1 */
  uint32_t iterations;     /* that were made */
  uint32_t converged;      /* 1: the objective fell by less than the tolerance */
  double residual_share;   /* |X - W C|^2 / |X|^2, weighted by area */
  double nonzero_share;    /* of all pairs of a node and a component, those where the component is not 0 */
  double dropped_energy;   /* share of |X|^2 that the randomized SVD left out, exact; 0 if there was none */
  uint32_t columns;        /* frames, or what they were reduced to */
  uint32_t loose_vertices; /* in no triangle with area; in the gradient domain they only move rigidly */
} sac_decomposition_report;

typedef struct sac_components sac_components;

/* Does nothing to a null pointer. */
SAC_API void sac_decomposition_settings_init(sac_decomposition_settings* settings);

/* Takes a clip apart. `triangle_vertices` has 3 indices a triangle and may be null without triangles; `source` gives
 * the frames, 3 floats a vertex, two to four times. Null `settings` are those of sac_decomposition_settings_init().
 * After an error *components is there only to give its message and be closed; it is null when memory is too short even
 * for that.
 *
 * SAC_INVALID_ARGUMENT for settings out of range, strokes or still vertices that the mesh does not have, no vertices,
 * no frames, a coordinate that is not finite, in the gradient domain a mesh without area, and where `source` ended it;
 * SAC_UNSUPPORTED for settings of a later library; SAC_LIMIT where memory does not suffice; SAC_CANCELLED. */
SAC_API sac_status sac_components_decompose(sac_components** components, uint32_t vertices,
                                            const uint32_t* triangle_vertices, uint32_t triangles,
                                            const sac_frame_source* source, const sac_decomposition_settings* settings);
/* Makes components of a set, such as one that was stored; `set` is copied. Errors leave *components as those of
 * sac_components_decompose() do. SAC_INVALID_ARGUMENT for a set that contradicts itself, with what is wrong;
 * SAC_LIMIT where it is too large. */
SAC_API sac_status sac_components_open(sac_components** components, const sac_component_set* set);
/* Null is allowed. */
SAC_API void sac_components_close(sac_components* components);

/* All that there is of the components, their weights and the clip's rigid motion. */
SAC_API sac_status sac_components_get(sac_components* components, sac_component_set* set);
SAC_API sac_status sac_components_report(sac_components* components, sac_decomposition_report* report);
/* How far the clip that the components were made from, or were fitted to, is from what they say of it: *erms is 1000
 * times the root mean square error of a coordinate, the longest side of the box of all frames being 1; *max_error the
 * largest distance of a vertex, model units. Either may be null. Errors as of sac_components_decompose(). */
SAC_API sac_status sac_components_measure(sac_components* components, const sac_frame_source* source, double* erms,
                                          double* max_error);

/* The rest shape deformed by `weights`, one a component, then moved by `pose`, null for no motion; 3 floats a vertex
 * into `positions`, model units. Weights may exceed their bounds. A vertex that no component of weight other than 0 has
 * stays exactly where it is (SAC_DISPLACEMENT). SAC_INVALID_ARGUMENT for what is not finite. */
SAC_API sac_status sac_components_compose(sac_components* components, const float* weights, const sac_rigid_pose* pose,
                                          float* positions);
/* The weights within their bounds, one a component, and the pose with which sac_components_compose() comes nearest to
 * `shape`, 3 floats a vertex, in the least squares weighted by area. `pose` may be null. */
SAC_API sac_status sac_components_fit(sac_components* components, const float* shape, float* weights,
                                      sac_rigid_pose* pose);
/* The same for each frame of another clip of the mesh: *fitted are the components with its weights and its rigid
 * motion, to be closed like others; errors are those of sac_components_decompose(), and leave *fitted as they do.
 * `threads` as in the settings. `progress` may be null; it is called after each frame with how many are done and the
 * objective 0. */
SAC_API sac_status sac_components_fit_clip(sac_components** fitted, sac_components* components,
                                           const sac_frame_source* source, uint32_t threads,
                                           sac_decomposition_progress progress, void* user);

/* Where a vertex is dragged to, model units. */
typedef struct sac_drag_target {
  uint32_t vertex;
  float position[3];
} sac_drag_target;

/* Set it with sac_drag_settings_init(), then change what is to be different. */
typedef struct sac_drag_settings {
  uint32_t struct_size; /* of this struct, set by the call: later versions may add members */
  uint32_t sparse;      /* 1: few components move (prices of |w|); 0: many by little (of w^2) */
  uint32_t bounded;     /* 1: weights keep their bounds; 0: a drag may go beyond what the clip showed */
  double price;         /* of moving a component, against missing the targets; 0 or more */
  /* The weights that the shape has before it is dragged, one a component, whose change is priced; null: all 0. */
  const float* start;
  sac_rigid_pose pose; /* of the shape */
} sac_drag_settings;

/* Does nothing to a null pointer. */
SAC_API void sac_drag_settings_init(sac_drag_settings* settings);
/* Direct manipulation (Lewis and Anjyo 2010): the weights, one a component, that bring `count` dragged vertices near
 * their targets, at a price for each component in proportion to its size. Null `settings` are those of
 * sac_drag_settings_init(). SAC_INVALID_ARGUMENT for a vertex that is not there and for what is not finite. */
SAC_API sac_status sac_components_drag(sac_components* components, const sac_drag_target* targets, uint32_t count,
                                       const sac_drag_settings* settings, float* weights);

/* What becomes of a component's weights: gain * weight + offset + curve[frame]. */
typedef struct sac_component_edit {
  double gain; /* 1: as it is */
  double offset;
  const float* curve; /* null, or one a frame */
} sac_component_edit;

/* Edits frame `frame` of the clip whose weights the components have: `positions`, 3 floats a vertex as they were
 * captured, move by the difference of what the edited and the clip's own weights pose, so that whatever the components
 * do not say stays, and a frame without edits stays as it is to the last bit. `edits` has one a component.
 * SAC_INVALID_ARGUMENT for a frame that is not there and for what is not finite. */
SAC_API sac_status sac_components_edit(sac_components* components, const sac_component_edit* edits, uint32_t frame,
                                       float* positions);

/* The complaint of the last call that failed, one line; empty when none has. */
SAC_API const char* sac_components_message(const sac_components* components);

#ifdef __cplusplus
}
#endif

#endif
