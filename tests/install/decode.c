// SPDX-License-Identifier: Apache-2.0
/* Counts the frames of the stream that is named. */
#include <sac/sac.h>
#include <stdio.h>

int main(int argc, char** argv) {
  uint8_t chunk[1000];
  size_t size;
  unsigned frames = 0;
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  sac_decoder* decoder;
  if (file == NULL || sac_decoder_open(&decoder, NULL) != SAC_OK) return 2;
  while ((size = fread(chunk, 1, sizeof chunk, file)) > 0) {
    const uint8_t* data = chunk;
    while (size > 0) {
      if (sac_decoder_send(decoder, &data, &size) != SAC_OK) return 1;
      while (sac_decoder_receive(decoder, NULL, NULL) == SAC_OK) ++frames;
    }
  }
  if (sac_decoder_finish(decoder) != SAC_OK) return 1;
  sac_decoder_close(decoder);
  fclose(file);
  printf("%u\n", frames);
  return 0;
}
