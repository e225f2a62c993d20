// SPDX-License-Identifier: Apache-2.0
// The vertex of a clip in vertex animation textures, as `sac decode clip.sac -o clip.vat` writes them, at any time. To
// be put into a vertex shader of GLSL 3.30, or of GLSL ES 3.00 (WebGL 2) with highp floats, after its #version.
//
// The textures are loaded without mipmaps, without conversion from sRGB, and not upside down: the first row of the file
// is row 0. What browsers decode of a PNG has 8 bits; there, take OpenEXR, or a decoder of one's own.

uniform highp sampler2D sac_positions;  // the file of `positions` in the JSON
uniform highp sampler2D sac_normals;    // the file of `normals`
uniform highp vec3 sac_position_scale;  // positions.scale
uniform highp vec3 sac_position_bias;   // positions.bias
uniform highp vec3 sac_normal_scale;    // normals.scale
uniform highp vec3 sac_normal_bias;     // normals.bias
uniform int sac_width;                  // width
uniform int sac_rows;                   // rows
uniform int sac_frames;                 // frames

// Position and normal of `vertex` (gl_VertexID of the mesh of the JSON) at `time`, in frames from the first. Before the
// first and after the last frame the clip stands still; between two frames positions go straight.
void SacVertex(int vertex, highp float time, out highp vec3 position, out highp vec3 normal) {
  highp float frame = clamp(time, 0.0, float(sac_frames - 1));
  int first = min(int(frame), max(sac_frames - 2, 0));
  int second = min(first + 1, sac_frames - 1);
  ivec2 place = ivec2(vertex % sac_width, vertex / sac_width);
  ivec2 a = ivec2(place.x, place.y + first * sac_rows), b = ivec2(place.x, place.y + second * sac_rows);
  highp float blend = frame - float(first);
  position = sac_position_bias +
             sac_position_scale * mix(texelFetch(sac_positions, a, 0).xyz, texelFetch(sac_positions, b, 0).xyz, blend);
  highp vec3 sum = sac_normal_bias +
                   sac_normal_scale * mix(texelFetch(sac_normals, a, 0).xyz, texelFetch(sac_normals, b, 0).xyz, blend);
  highp float size = length(sum);
  normal = size > 0.0 ? sum / size : sum;
}
