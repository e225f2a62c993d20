// SPDX-License-Identifier: Apache-2.0
/* A player without a display: reads a stream from a file in small pieces and prints the positions of a vertex. It plays
 * the clip twice, to show how a clip is played again. */
#include <sac/sac.h>
#include <stdio.h>
#include <stdlib.h>

static sac_status play(sac_decoder* decoder, FILE* file, sac_frame_buffers* buffers) {
  uint8_t chunk[4096];
  size_t size;
  sac_status status;
  while ((size = fread(chunk, 1, sizeof chunk, file)) > 0) {
    const uint8_t* data = chunk;
    while (size > 0) {
      sac_frame_info info;
      sac_mesh mesh;
      status = sac_decoder_send(decoder, &data, &size);
      if (status != SAC_OK) return status;
      if (buffers->positions.data == NULL && sac_decoder_mesh(decoder, &mesh) == SAC_OK) {
        buffers->positions.stride = 3 * sizeof(float);
        buffers->positions.size = mesh.vertices * buffers->positions.stride;
        buffers->positions.data = malloc(buffers->positions.size);
        if (buffers->positions.data == NULL) return SAC_LIMIT;
      }
      while ((status = sac_decoder_receive(decoder, buffers, &info)) == SAC_OK) {
        const float* v = buffers->positions.data;
        printf("frame %u, %.3f seconds: vertex 0 is at %g %g %g\n", info.index, info.time, v[0], v[1], v[2]);
      }
      if (status != SAC_NEED_MORE_DATA) return status;
    }
  }
  return sac_decoder_finish(decoder);
}

int main(int argc, char** argv) {
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) {
    fprintf(stderr, "usage: play_c STREAM\n");
    return 2;
  }
  sac_decoder* decoder;
  sac_frame_buffers buffers = {0};
  uint64_t byte = 0;
  sac_status status = sac_decoder_open(&decoder, NULL);
  if (status == SAC_OK) status = play(decoder, file, &buffers);
  if (status == SAC_OK) status = sac_decoder_seek(decoder, 0, &byte);
  if (status == SAC_OK && fseek(file, (long)byte, SEEK_SET) == 0) status = play(decoder, file, &buffers);
  if (status != SAC_OK) fprintf(stderr, "play_c: %s: %s\n", argv[1], sac_decoder_message(decoder));
  sac_decoder_close(decoder);
  free(buffers.positions.data);
  fclose(file);
  return status == SAC_OK ? 0 : 1;
}
