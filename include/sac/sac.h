// SPDX-License-Identifier: Apache-2.0
/* The decoder of sac streams for C, and for what speaks C. decoder.h says more, for C++.
 *
 *   sac_settings settings;
 *   sac_settings_init(&settings);
 *   sac_decoder* decoder;
 *   if (sac_decoder_open(&decoder, &settings) != SAC_OK) return;
 *   while ((size = read(chunk)) > 0) {                           // in any chunking
 *     const uint8_t* data = chunk;
 *     while (size > 0) {
 *       status = sac_decoder_send(decoder, &data, &size);         // takes at most a packet from the front
 *       if (status != SAC_OK) goto failed;
 *       while ((status = sac_decoder_receive(decoder, &buffers, &info)) == SAC_OK) show(&info);
 *       if (status != SAC_NEED_MORE_DATA) goto failed;
 *     }
 *   }
 *   status = sac_decoder_finish(decoder);
 *   failed: puts(sac_decoder_message(decoder));
 *   sac_decoder_close(decoder);
 *
 * A decoder is used by one thread at a time; decoders share nothing. Pointers that a decoder gives out are its own and
 * stay valid until it is reset or closed, a message until the next call. No function throws or ends the program.
 * Structs stay as they are but sac_settings, which knows its size: what else a later version tells, it tells by new
 * functions. */
#ifndef SAC_H
#define SAC_H

#include <stddef.h>
#include <stdint.h>

#include "export.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum sac_status {
  SAC_OK = 0,
  SAC_NEED_MORE_DATA = 1,   /* not an error: send more bytes and ask again */
  SAC_INVALID_ARGUMENT = 2, /* what the caller gave cannot be used */
  SAC_UNSUPPORTED = 3,      /* a stream of another version, or what a stream cannot give */
  SAC_CORRUPT = 4,          /* the bytes break a rule of spec.md */
  SAC_LIMIT = 5,            /* a limit of the settings, or of memory */
  SAC_CANCELLED = 6         /* the progress callback asked to stop */
} sac_status;

/* Runs jobs 0 to jobs - 1: calls job(context, i) once for each i, in any order and on any threads, and returns when all
 * calls have returned. `user` is that of the settings. It must not throw or jump out. */
typedef void (*sac_run_jobs)(void* user, size_t jobs, void (*job)(void* context, size_t i), void* context);

/* Set it with sac_settings_init(), then change what is to be different. */
typedef struct sac_settings {
  uint32_t struct_size; /* of this struct, set by sac_settings_init(): later versions may add members */
  /* What a stream may ask for (spec.md 9); a stream that asks for more is refused before anything is allocated. */
  uint32_t max_vertices;
  uint64_t max_memory; /* bytes of all that a decoder holds at a time, approximately */
  double max_work;     /* multiplications for what is derived from the first frame, approximately */

  uint32_t skip_damage; /* 1: go on after damage at the next sound group; 0: errors are final */
  uint32_t frame_step;  /* sac_decoder_receive() gives the frames whose number is a multiple of this, not 0 */
  uint32_t threads;     /* frames of a group that are reconstructed at the same time, 1 to 1024; see run_jobs */
  /* The job system that reconstructs them, called with at most `threads` jobs from within sac_decoder_receive(). Null:
   * threads that live as long as the call. SAC_INVALID_ARGUMENT when it leaves a job out. */
  sac_run_jobs run_jobs;
  void* run_jobs_user;

  /* Expert limits, of single sizes, as spec.md 9 defines them: what is above bounds them already for usual clips. */
  uint32_t max_triangles;
  uint32_t max_harmonics;
  uint32_t max_frames_per_group;
  uint32_t max_packet_bytes;
  uint64_t max_group_values;
  uint64_t max_basis_values;
  uint64_t max_factor_values;
  double max_free_work; /* of the first frame, beside max_work_per_byte for each byte of its packet */
  double max_work_per_byte;
  double max_frame_work;

  uint32_t layers; /* of each group that are decoded, at least one; a stream may have none but that (spec.md 6.1) */
} sac_settings;

typedef enum sac_format {
  SAC_FLOAT32 = 0, /* three floats */
  /* Three integers of 16 bits. Positions: unsigned, low + (high - low) * x / 65535 of the frame's box. Normals: signed,
   * x / 32767. */
  SAC_INT16 = 1
} sac_format;

/* The caller's memory for three components of each vertex: of vertex v at byte v * stride. */
typedef struct sac_vertex_buffer {
  void* data;    /* null: not wanted */
  size_t size;   /* bytes */
  size_t stride; /* bytes, at least those of a vertex */
  uint32_t format;
} sac_vertex_buffer;

typedef struct sac_frame_buffers {
  sac_vertex_buffer positions; /* model units, without sac_decoder_offset() */
  sac_vertex_buffer normals;   /* of length 1, computed from the frame's triangles */
} sac_frame_buffers;

typedef struct sac_frame_info {
  uint32_t index;    /* in the clip, from 0 */
  uint32_t intra;    /* 1: needed no other frame */
  double time;       /* seconds from the clip's begin; 0 when the stream has no frame rate */
  double box_low[3]; /* of the positions */
  double box_high[3];
} sac_frame_info;

/* What does not move. Arrays that the stream does not have are null. */
typedef struct sac_mesh {
  uint32_t vertices;
  uint32_t triangles;
  uint32_t uvs;
  uint32_t frame_rate_numerator; /* frames per second; 0: unknown */
  uint32_t frame_rate_denominator;
  const uint32_t* triangle_vertices; /* 3 a triangle */
  const float* uv_values;            /* 2 a texture coordinate */
  const uint32_t* triangle_uvs;      /* 3 a triangle: indices of texture coordinates */
  const float* normals;  /* 3 a vertex, of the first frame; null also where corners have normals of their own */
  const uint8_t* colors; /* red, green, blue, alpha of a vertex */
  const uint32_t* order; /* per vertex its index in the encoder's input */
} sac_mesh;

typedef struct sac_decoder sac_decoder;

/* The version of the library, such as "0.1.0", and of the streams that it decodes, such as "0.9". */
SAC_API const char* sac_version(void);
SAC_API const char* sac_stream_version(void);

/* Sets all members to the defaults. Null is allowed and nothing happens. */
SAC_API void sac_settings_init(sac_settings* settings);

/* Null `settings` are those of sac_settings_init(). Else *decoder is null: SAC_INVALID_ARGUMENT when the settings
 * cannot be used, SAC_UNSUPPORTED when they are of a later library, SAC_LIMIT when memory is short. */
SAC_API sac_status sac_decoder_open(sac_decoder** decoder, const sac_settings* settings);
/* Null is allowed. */
SAC_API void sac_decoder_close(sac_decoder* decoder);
/* Forgets everything but the settings: another stream may begin. Needs no memory. Null is allowed. */
SAC_API void sac_decoder_reset(sac_decoder* decoder);

/* Takes bytes from *data, at most until a packet is complete, and moves *data and *size on. Takes nothing while frames
 * wait to be received. With the last byte of a segment's first group it computes all that follows from the mesh, unless
 * sac_decoder_prepare() has done so, which may take a second for a large mesh: not on a thread that must not wait. */
SAC_API sac_status sac_decoder_send(sac_decoder* decoder, const uint8_t** data, size_t* size);
/* The next frame into the caller's memory. SAC_NEED_MORE_DATA when none is ready; SAC_INVALID_ARGUMENT, and the frame
 * still waits, when a buffer is too small. Either pointer may be null. */
SAC_API sac_status sac_decoder_receive(sac_decoder* decoder, const sac_frame_buffers* buffers, sac_frame_info* info);
/* Declares the end of the bytes: SAC_CORRUPT when the stream is not complete. With skip_damage, more frames may be
 * received afterwards; called again after the last of them, it tells whether the stream was complete. */
SAC_API sac_status sac_decoder_finish(sac_decoder* decoder);

/* The triangles and attributes; SAC_NEED_MORE_DATA before they have been sent. In a stream of several segments these
 * are of the frames that sac_decoder_receive() gives next: after a call of sac_decoder_send() that changes
 * sac_decoder_segment() they are others, and the pointers given out before are no longer valid. */
SAC_API sac_status sac_decoder_mesh(sac_decoder* decoder, sac_mesh* mesh);
/* The number of the segment whose mesh this is, from 0; SAC_NEED_MORE_DATA before it is known. */
SAC_API sac_status sac_decoder_segment(sac_decoder* decoder, uint32_t* segment);
/* The positions of sac_decoder_mesh(), 3 floats a vertex: a still to be shown before the first frame is there. It is
 * the shape that frames are measured from, which is near the first frame. */
SAC_API sac_status sac_decoder_still(sac_decoder* decoder, const float** positions);
/* Computes what frames need beside the mesh, once that is there; the next call that needs it does so otherwise. It may
 * take a second for a large mesh, and may be made on another thread than the calls before and after it. */
SAC_API sac_status sac_decoder_prepare(sac_decoder* decoder);
/* Makes the frames of a group ready whose layers are still coming, without those that have not come: what has come is
 * shown in time, coarser. */
SAC_API sac_status sac_decoder_flush(sac_decoder* decoder);

/* What a stream says of its clip. Texts are UTF-8 and null where the stream has none. */
typedef struct sac_metadata {
  const char* name;
  const char* json;       /* the author's own */
  double metres_per_unit; /* 0: unknown */
  int32_t up_axis;        /* 0, 1, 2: x, y, z; -1: unknown */
  int32_t first_frame;    /* the author's number of frame 0; 0 where it is unknown */
  int32_t loops;          /* 1: made to be played in a loop; 0: not; -1: unknown */
  uint32_t has_bounds;    /* 1: the box of all frames as they were encoded is known */
  double box_low[3];
  double box_high[3];
} sac_metadata;

/* What the stream has said so far; all of it may come at its end. SAC_NEED_MORE_DATA before anything. */
SAC_API sac_status sac_decoder_metadata(sac_decoder* decoder, sac_metadata* metadata);

/* The first frame's normals where corners of a vertex have normals of their own (hard edges): 3 floats for each of
 * *count normals, and 3 a triangle in *triangle_normals, the indices of its corners' normals. Both are null, and *count
 * is 0, where sac_mesh has the normals of vertices or there are none. SAC_NEED_MORE_DATA as sac_decoder_mesh(). */
SAC_API sac_status sac_decoder_corner_normals(sac_decoder* decoder, const float** normals, uint32_t* count,
                                              const uint32_t** triangle_normals);

/* What to add to all positions, x, y and z, to have the author's coordinates, model units; zeros in most streams. They
 * may be so large that a float cannot hold the sum. SAC_NEED_MORE_DATA before the sequence header has been sent. */
SAC_API sac_status sac_decoder_offset(sac_decoder* decoder, double offset[3]);

/* Goes to a frame, or to the one that is shown at so many seconds: the next bytes sent must be those of the stream from
 * *byte on, which counts from the first byte that was sent, or that an index counts from. With a frame_step the next of
 * its multiples is received. SAC_NEED_MORE_DATA before the mesh has been sent; SAC_INVALID_ARGUMENT beyond the end,
 * where it is known. A clip is played again by seeking frame 0. */
SAC_API sac_status sac_decoder_seek(sac_decoder* decoder, uint32_t frame, uint64_t* byte);
SAC_API sac_status sac_decoder_seek_time(sac_decoder* decoder, double seconds, uint64_t* byte);
/* Tells where groups begin, from the last bytes of the stream. SAC_NEED_MORE_DATA: *needed of them are needed, 8 at
 * first. SAC_INVALID_ARGUMENT: the stream has no index; likewise when *needed comes to be more than the stream has. */
SAC_API sac_status sac_decoder_add_index(sac_decoder* decoder, const uint8_t* tail, size_t size, size_t* needed);

/* The shape at a time between frames, in frames from the clip's begin; the last frame is held for its time. Frames
 * before it count as received. SAC_NEED_MORE_DATA when the frame after has not been sent; SAC_INVALID_ARGUMENT when the
 * one before is gone: seek it; or beyond the end, where it is known. SAC_CORRUPT when one of them is lost, go on with a
 * later time; SAC_UNSUPPORTED when the stream's frames are measured against the frame before. */
SAC_API sac_status sac_decoder_interpolate(sac_decoder* decoder, double frame_time, const sac_frame_buffers* buffers,
                                           sac_frame_info* info);

/* How the mesh follows its handles, what a skin is to joints (spec.md 6.4.5), so that a GPU can move it: vertex v is at
 * the sum, over the entries i from first[v] to before first[v + 1], of weights[i] * (matrix of handles[i] * (x, y, z,
 * 1)), x, y, z its place in sac_decoder_still(). Weights are positive; those of a vertex add up to 1, its nearest
 * handle comes first. */
typedef struct sac_blend {
  uint32_t handle_count;
  uint32_t entries;
  const uint32_t* first; /* of each vertex, and one more */
  const uint32_t* handles;
  const float* weights;
} sac_blend;

/* The blend of the mesh that is there now; does what sac_decoder_prepare() does if need be. The pointers are valid
 * until the next call, or sac_decoder_segment() changes. SAC_UNSUPPORTED when the stream's frames are measured against
 * the frame before; SAC_NEED_MORE_DATA before the mesh has been sent. */
SAC_API sac_status sac_decoder_blend(sac_decoder* decoder, sac_blend* blend);
/* The next frame as matrices of the handles instead of positions: 12 floats each, three rows of four columns; `count`
 * is how many floats there is room for, 12 a handle. *exact is 1 when the frame is no more than the blend; if it is 0,
 * its detail and correction planes, which only sac_decoder_receive() adds, are left out. The box holds the blended
 * mesh, but may be larger. Otherwise as sac_decoder_receive(). `info` and `exact` may be null. */
SAC_API sac_status sac_decoder_receive_handles(sac_decoder* decoder, float* matrices, size_t count,
                                               sac_frame_info* info, uint32_t* exact);
/* The same at a time between frames, as sac_decoder_interpolate(). */
SAC_API sac_status sac_decoder_interpolate_handles(sac_decoder* decoder, double frame_time, float* matrices,
                                                   size_t count, sac_frame_info* info, uint32_t* exact);

/* The most layers that a group so far may have (spec.md 6.1), those counted that were dropped: 1 where groups have no
 * layers, 0 before the first group. A smaller sac_settings.layers gives a coarser clip. */
SAC_API uint32_t sac_decoder_layers(const sac_decoder* decoder);
/* How many frames the clip has. SAC_NEED_MORE_DATA before the end or sac_decoder_add_index() has told. */
SAC_API sac_status sac_decoder_frames(sac_decoder* decoder, uint32_t* frames);

/* With skip_damage: how many runs of frames are lost so far, and the one of that index. */
SAC_API size_t sac_decoder_lost_count(const sac_decoder* decoder);
SAC_API sac_status sac_decoder_lost(const sac_decoder* decoder, size_t index, uint32_t* first, uint32_t* count);

/* What the last call that failed complained of, one line, until the next call; empty when none has. */
SAC_API const char* sac_decoder_message(const sac_decoder* decoder);

#ifdef __cplusplus
}
#endif

#endif
