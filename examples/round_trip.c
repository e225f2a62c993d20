// SPDX-License-Identifier: Apache-2.0
/* Encodes a waving grid and decodes it again, using only the C interface. */
#include <math.h>
#include <sac/sac.h>
#include <sac/sac_encode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kSide = 20, kVertices = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1), kFrames = 30 };

static void frame_at(int frame, float* positions) {
  for (int v = 0; v < kVertices; ++v) {
    positions[3 * v] = (float)(v % kSide);
    positions[3 * v + 1] = (float)(v / kSide);
    positions[3 * v + 2] = 2 * sinf(0.4f * (float)(v % kSide) + 0.2f * (float)frame);
  }
}

/* Takes the bytes that the encoder has ready and appends them to the stream. */
static sac_status take(sac_encoder* encoder, uint8_t** stream, size_t* size) {
  const uint8_t* data;
  size_t more;
  sac_status status = sac_encoder_take(encoder, &data, &more);
  uint8_t* grown = status == SAC_OK && more > 0 ? realloc(*stream, *size + more) : NULL;
  if (status != SAC_OK || more == 0) return status;
  if (grown == NULL) return SAC_LIMIT;
  memcpy(grown + *size, data, more);
  *stream = grown;
  *size += more;
  return SAC_OK;
}

int main(void) {
  static float positions[3 * kVertices], decoded[3 * kVertices];
  static uint32_t triangles[3 * kTriangles];
  uint32_t* t = triangles;
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t a = kSide * y + x, quad[6] = {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide};
      memcpy(t, quad, sizeof quad);
      t += 6;
    }
  }
  frame_at(0, positions);
  sac_input_mesh mesh = {.vertices = kVertices, .triangles = kTriangles, .positions = positions};
  mesh.triangle_vertices = triangles;

  uint8_t* stream = NULL;
  size_t size = 0;
  sac_encoder* encoder;
  sac_status status = sac_encoder_open(&encoder, &mesh, NULL);
  for (int frame = 0; status == SAC_OK && frame < kFrames; ++frame) {
    frame_at(frame, positions);
    status = sac_encoder_send(encoder, positions, 0);
    if (status == SAC_OK) status = take(encoder, &stream, &size);
  }
  if (status == SAC_OK) status = sac_encoder_finish(encoder);
  if (status == SAC_OK) status = take(encoder, &stream, &size);
  if (status != SAC_OK) fprintf(stderr, "encoding: %s\n", sac_encoder_message(encoder));
  sac_encoder_close(encoder);

  sac_decoder* decoder = NULL;
  sac_frame_buffers buffers = {{decoded, sizeof decoded, 3 * sizeof(float), SAC_FLOAT32}, {NULL, 0, 0, SAC_FLOAT32}};
  unsigned frames = 0;
  const uint8_t* rest = stream;
  if (status == SAC_OK) status = sac_decoder_open(&decoder, NULL);
  for (size_t left = size; status == SAC_OK && left > 0;) {
    status = sac_decoder_send(decoder, &rest, &left);
    while (status == SAC_OK && sac_decoder_receive(decoder, &buffers, NULL) == SAC_OK) ++frames;
  }
  if (status == SAC_OK) status = sac_decoder_finish(decoder);
  if (status != SAC_OK && decoder != NULL) fprintf(stderr, "decoding: %s\n", sac_decoder_message(decoder));
  printf("%u frames of %d vertices in %zu bytes, raw are %zu\n", frames, kVertices, size, kFrames * sizeof positions);
  sac_decoder_close(decoder);
  free(stream);
  return status == SAC_OK && frames == kFrames ? 0 : 1;
}
