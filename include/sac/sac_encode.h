// SPDX-License-Identifier: Apache-2.0
/* The encoder of sac streams for C, and for what speaks C. encoder.h and clip_encoder.h are the same for C++.
 *
 *   sac_encoder_settings settings;
 *   sac_encoder_settings_init(&settings);
 *   sac_encoder* encoder;
 *   if (sac_encoder_open(&encoder, &mesh, &settings) != SAC_OK) goto failed;
 *   for (each frame, the first one too) {
 *     if (sac_encoder_send(encoder, positions, 0) != SAC_OK) goto failed;
 *     sac_encoder_take(encoder, &data, &size);                  // in order, a group a thread at a time
 *     write(data, size);
 *   }
 *   if (sac_encoder_finish(encoder) != SAC_OK) goto failed;
 *   sac_encoder_take(encoder, &data, &size);
 *   write(data, size);
 *   failed: puts(sac_encoder_message(encoder));
 *   sac_encoder_close(encoder);
 *
 * sac_encode_clip() is for clips that can be read more than once: it searches settings for a size or an error and
 * measures what decoders will show.
 *
 * An encoder is used by one thread at a time; encoders share nothing. What the caller gives is read during the call
 * alone. Pointers that an encoder gives out are its own: bytes and messages stay valid until the next call, the rest
 * until the encoder is closed. No function throws or ends the program. Structs stay as they are but
 * sac_encoder_settings, which knows its size. */
#ifndef SAC_ENCODE_H
#define SAC_ENCODE_H

#include "sac.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Called on the caller's thread between the frames that it codes, and when those of other threads are done. `trial` is
 * the number of a trial encoding, from 1, and 0 in an encoding that is none; `frames` of it are coded. The bytes that
 * sac_encode_clip() gives out may be those of a trial. Anything but 0 ends in SAC_CANCELLED. */
typedef int (*sac_progress)(void* user, uint32_t trial, uint32_t frames);

/* Set it with sac_encoder_settings_init(), then change what is to be different. Doubles that are NaN, and harmonics 0,
 * are chosen by the quality. */
typedef struct sac_encoder_settings {
  uint32_t struct_size;     /* of this struct, set by sac_encoder_settings_init(): later versions may add members */
  double quality;           /* 0 (smallest) to 100 (nearest to the input) */
  double max_error;         /* of any vertex in any frame, model units; NaN: no bound */
  double target_kg;         /* percent; NaN: none. The targets are for sac_encode_clip() alone */
  double target_sted;       /* NaN: none */
  double target_bpvf;       /* bits a vertex and frame; NaN: none */
  double motion_step;       /* radians and strain */
  double displacement_step; /* fraction of the mesh's RMS radius */
  double detail_step;       /* fraction of the mesh's RMS radius; 0: no detail plane */
  double position_bits;     /* of the mesh: log2 of its extent in steps, 1 to 24 */
  double level_growth;      /* of the steps from level to level of a pyramid, 1 to 2 */
  uint32_t harmonics;       /* over all components */
  uint32_t handles_per_harmonic;   /* at most 64, fewer where they would be many; 0: every vertex is a handle */
  uint32_t group;                  /* frames between points of random access */
  uint32_t pyramid;                /* frames of a hierarchy of B-frames; 1: P-frames only */
  uint32_t low_delay;              /* 1: P-frames only, each coded as it is sent */
  uint32_t reference_previous;     /* 1: motion is measured against the frame before instead of the mesh */
  uint32_t frame_rate_numerator;   /* frames per second; 0: unknown */
  uint32_t frame_rate_denominator; /* not 0 */
  uint32_t keep_order;             /* 1: the order of the vertices is in the stream */
  uint32_t index;                  /* 1: streams of several groups end with an index */
  uint32_t repeat_start;           /* header and mesh come again before every that many groups; 0: never */
  uint32_t unmeasured;             /* 1: sac_encode_clip() neither decodes nor measures, unless there are targets */
  uint64_t max_memory;             /* bytes that the decoders it is for may hold (spec.md 9) */
  sac_progress progress;           /* null: none */
  void* user;                      /* given to `progress` */
  double offset[3]; /* taken from the author's coordinates before; carried to the decoders: sac_decoder_offset() */
  /* For sac_encode_clip() alone. Rounds of fitting the shape that motion is measured against to all frames; it is used
   * where the clip costs less with it. Encoding takes 2 to 3 times as long, with targets as many trials more as there
   * are rounds. 0: the shape is the first frame. It is also the first frame with max_error, low_delay or
   * reference_previous, and in clips of three frames or fewer. Negative: 2, or 0 where nothing is measured. */
  int32_t reference_rounds;
  /* Groups are coded in layers that can be dropped from the end, a coarser stream each time: in a group's own packet
   * this many levels of the pyramid, then the others one by one, then detail and correction. 0: no layers. Not with
   * low_delay or reference_previous. */
  uint32_t base_levels;
  /* What the stream says of the clip, as in sac_metadata; texts may be null, and are read in the call alone. */
  const char* name;
  const char* json;
  double metres_per_unit;   /* 0: not said */
  int32_t up_axis;          /* 0, 1, 2: x, y, z; -1: not said */
  int32_t loops;            /* 1, 0; -1: not said */
  int32_t first_frame;      /* the author's number of frame 0 */
  uint32_t has_first_frame; /* 1: it is said */
  uint32_t bounds;          /* 1: puts the box of all frames, and of each group, at the end of the stream */
  /* Vertices that coincide are coded as one, so that no seam opens between them; decoders give out as many as the mesh
   * has. -1: those that coincide in all frames, for sac_encode_clip() alone; 1: also those that coincide in the mesh of
   * sac_encoder_open(), and frames in which they part are refused; 0: none. */
  int32_t join;
  /* How many groups are coded at the same time, at most 1024; their frames are held then. 0: as many as the machine has
   * processors; 1: all work is done by the caller's thread. The bytes are the same with any number. Not with low_delay,
   * where frames come one by one. */
  uint32_t threads;
  /* The job system that codes groups, called with at most `threads` jobs. Null: threads that live as long as the call.
   * SAC_INVALID_ARGUMENT when it runs no job. */
  sac_run_jobs run_jobs;
  void* run_jobs_user;
  /* How far a vertex moves at most from its place in the mesh, the rigid motion of the whole taken away; model units.
   * Where it is known, components much smaller than the mesh are coded finer, so that their error is in proportion to
   * their own size; frames that go twice as far may be refused. NaN: sac_encode_clip() measures it, sac_encoder_open()
   * does without. Not with max_error. */
  double reach;
} sac_encoder_settings;

/* The mesh of a clip; set all of it to 0 before. Its positions are the first frame's, or any near them for
 * sac_encoder_open(); its normals are the first frame's. Pointers that may be null are null where the mesh has no such
 * attribute. */
typedef struct sac_input_mesh {
  uint32_t vertices;
  uint32_t triangles;
  uint32_t uvs;
  const float* positions;            /* 3 a vertex, model units */
  size_t position_stride;            /* bytes from vertex to vertex; 0: 12 */
  const uint32_t* triangle_vertices; /* 3 a triangle */
  const float* uv_values;            /* 2 a texture coordinate; may be null */
  const uint32_t* triangle_uvs;      /* 3 a triangle: indices of texture coordinates; may be null */
  const float* normals;              /* 3 a vertex, or 3 for each of corner_normals; may be null */
  const uint8_t* colors;             /* red, green, blue, alpha of a vertex; may be null */
  /* Where corners of a vertex have normals of their own (hard edges): how many there are, else 0, and 3 a triangle, the
   * indices of its corners' normals, else null. */
  uint32_t corner_normals;
  const uint32_t* triangle_normals;
} sac_input_mesh;

/* The bytes of a stream by what they say; they add up to its size. */
typedef struct sac_stream_bytes {
  double header;  /* magic, sequence header, end and index */
  double i_frame; /* connectivity, positions and attributes of the mesh */
  double motion;
  double displacement;
  double detail;
  double correction;
  double side; /* rigid motion, frame types, packet framing of groups */
} sac_stream_bytes;

typedef struct sac_encoder sac_encoder;

/* Does nothing to a null pointer. */
SAC_API void sac_encoder_settings_init(sac_encoder_settings* settings);

/* Codes the mesh and computes the harmonics, which may take seconds for a large mesh. Null `settings` are those
 * of sac_encoder_settings_init(). After an error *encoder is there only to give its message and be closed; it is null
 * when memory is too short even for that. SAC_INVALID_ARGUMENT for settings out of range and a mesh that cannot be
 * coded; SAC_UNSUPPORTED for settings of a later library; SAC_LIMIT where decoders would refuse the stream or memory is
 * short; SAC_CANCELLED. */
SAC_API sac_status sac_encoder_open(sac_encoder** encoder, const sac_input_mesh* mesh,
                                    const sac_encoder_settings* settings);
/* Null is allowed. */
SAC_API void sac_encoder_close(sac_encoder* encoder);

/* The next frame, the mesh's own first: 3 floats a vertex in the order of the mesh, `stride` bytes from vertex to
 * vertex, 0 for 12. SAC_INVALID_ARGUMENT for a coordinate that is not finite, and the encoder goes on with another
 * frame; after other errors it cannot go on. */
SAC_API sac_status sac_encoder_send(sac_encoder* encoder, const float* positions, size_t stride);
/* Goes on with frames of another mesh: a new segment of the stream. sac_encoder_order() is then that of this mesh.
 * After an error in the mesh the encoder goes on with the mesh before. */
SAC_API sac_status sac_encoder_begin_segment(sac_encoder* encoder, const sac_input_mesh* mesh);
/* Ends the stream. */
SAC_API sac_status sac_encoder_finish(sac_encoder* encoder);
/* The bytes that have been coded since the last call, *size of them, which may be 0. */
SAC_API sac_status sac_encoder_take(sac_encoder* encoder, const uint8_t** data, size_t* size);

/* Per decoded vertex its index in the mesh. */
SAC_API sac_status sac_encoder_order(const sac_encoder* encoder, const uint32_t** order);
SAC_API sac_status sac_encoder_stream_bytes(const sac_encoder* encoder, sac_stream_bytes* bytes);

/* The complaint of the last call that failed, one line; empty when none has. */
SAC_API const char* sac_encoder_message(const sac_encoder* encoder);

/* Reads a clip, as often as a search needs. Functions return 0, or anything else to end the encoding. */
typedef struct sac_frame_source {
  void* user;
  /* Writes the next frame, the first one first, 3 floats a vertex; sets *end instead after the last. */
  int (*next)(void* user, float* positions, int* end);
  /* Begins again with the first frame. */
  int (*rewind)(void* user);
} sac_frame_source;

/* Gets the bytes of a stream in order. Returns 0, or anything else to end the encoding. */
typedef int (*sac_byte_sink)(void* user, const uint8_t* data, size_t size);

/* What sac_encode_clip() came to. */
typedef struct sac_clip_result {
  uint64_t bytes;
  uint32_t frames;
  uint32_t trials; /* trial encodings: for targets, and for the shape of the mesh */
  double bpvf;     /* bits a vertex and frame */
  double kg;       /* percent */
  double sted;
  double max_error; /* model units */
  sac_stream_bytes parts;
  char message[256]; /* the complaint, one line, cut to fit; empty without an error */
} sac_clip_result;

/* Encodes a whole clip, searching settings where there are targets, and measures what a decoder makes of the stream.
 * `sink` may get all bytes at the end.
 * SAC_INVALID_ARGUMENT also where `source` or `sink` ended the encoding, and for targets that cannot be met. */
SAC_API sac_status sac_encode_clip(const sac_input_mesh* mesh, const sac_frame_source* source,
                                   const sac_encoder_settings* settings, sac_byte_sink sink, void* sink_user,
                                   sac_clip_result* result);

/* What else there is to say of a clip that was encoded. Set `order` before, the rest is set by the call. */
typedef struct sac_clip_details {
  uint32_t* order; /* null, or memory for one number a vertex: per decoded vertex its index in the mesh */
  uint32_t lost_texture_coordinates; /* 1: those of the mesh could not be coded; known where it was measured */
  uint32_t lost_normals;             /* the same of normals */
  double sted_spatial;               /* the parts of the result's STED */
  double sted_temporal;
  double seam_gap; /* largest distance between decoded vertices that coincide in every frame, model units */
} sac_clip_details;

/* sac_encode_clip() with details, which may be null. */
SAC_API sac_status sac_encode_clip_details(const sac_input_mesh* mesh, const sac_frame_source* source,
                                           const sac_encoder_settings* settings, sac_byte_sink sink, void* sink_user,
                                           sac_clip_result* result, sac_clip_details* details);

#ifdef __cplusplus
}
#endif

#endif
