// SPDX-License-Identifier: Apache-2.0
/* Encodes a clip of a tetrahedron that turns, and writes the stream to the file that is named. */
#include <math.h>
#include <sac/sac_encode.h>
#include <stdio.h>
#include <stdlib.h>

static int take(sac_encoder* encoder, FILE* file) {
  const uint8_t* data;
  size_t size;
  return sac_encoder_take(encoder, &data, &size) == SAC_OK && fwrite(data, 1, size, file) == size;
}

int main(int argc, char** argv) {
  static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  sac_input_mesh mesh = {0};
  FILE* file = argc == 3 ? fopen(argv[2], "wb") : NULL;
  int frame, good;
  sac_encoder* encoder;
  if (file == NULL) return 2;
  mesh.vertices = 4;
  mesh.triangles = 4;
  mesh.positions = positions;
  mesh.triangle_vertices = triangles;
  good = sac_encoder_open(&encoder, &mesh, NULL) == SAC_OK;
  for (frame = 0; good && frame < atoi(argv[1]); ++frame) {
    const float angle = 0.1f * (float)frame;
    positions[3] = positions[7] = cosf(angle);
    positions[4] = sinf(angle);
    positions[6] = -sinf(angle);
    good = sac_encoder_send(encoder, positions, 0) == SAC_OK && take(encoder, file);
  }
  good = good && sac_encoder_finish(encoder) == SAC_OK && take(encoder, file);
  if (!good) fprintf(stderr, "%s\n", sac_encoder_message(encoder));
  sac_encoder_close(encoder);
  return fclose(file) == 0 && good ? 0 : 1;
}
