// SPDX-License-Identifier: Apache-2.0
// JavaScript reads and writes the structs of sac.h by offset (bindings/js/src/layout.ts). A change of theirs ends the
// build here, so that the offsets there are changed as well.
#include <cstddef>

#include "sac/sac.h"

#define SAC_AT(type, member, offset) static_assert(offsetof(type, member) == offset, #type "." #member)

SAC_AT(sac_settings, max_vertices, 4);
SAC_AT(sac_settings, max_memory, 8);
SAC_AT(sac_settings, max_work, 16);
SAC_AT(sac_settings, skip_damage, 24);
SAC_AT(sac_settings, frame_step, 28);
SAC_AT(sac_settings, max_triangles, 44);
SAC_AT(sac_settings, max_harmonics, 48);
SAC_AT(sac_settings, max_frames_per_group, 52);
SAC_AT(sac_settings, max_packet_bytes, 56);
SAC_AT(sac_settings, max_group_values, 64);
SAC_AT(sac_settings, max_basis_values, 72);
SAC_AT(sac_settings, max_factor_values, 80);
SAC_AT(sac_settings, max_free_work, 88);
SAC_AT(sac_settings, max_work_per_byte, 96);
SAC_AT(sac_settings, max_frame_work, 104);
SAC_AT(sac_settings, layers, 112);
static_assert(sizeof(sac_settings) <= 256);

SAC_AT(sac_vertex_buffer, size, 4);
SAC_AT(sac_vertex_buffer, stride, 8);
SAC_AT(sac_vertex_buffer, format, 12);
SAC_AT(sac_frame_buffers, normals, 16);
static_assert(sizeof(sac_frame_buffers) == 32);

SAC_AT(sac_frame_info, intra, 4);
SAC_AT(sac_frame_info, time, 8);
SAC_AT(sac_frame_info, box_low, 16);
SAC_AT(sac_frame_info, box_high, 40);
static_assert(sizeof(sac_frame_info) == 64);

SAC_AT(sac_mesh, triangles, 4);
SAC_AT(sac_mesh, uvs, 8);
SAC_AT(sac_mesh, frame_rate_numerator, 12);
SAC_AT(sac_mesh, triangle_vertices, 20);
SAC_AT(sac_mesh, uv_values, 24);
SAC_AT(sac_mesh, triangle_uvs, 28);
SAC_AT(sac_mesh, normals, 32);
SAC_AT(sac_mesh, colors, 36);
SAC_AT(sac_mesh, order, 40);
static_assert(sizeof(sac_mesh) == 44);
