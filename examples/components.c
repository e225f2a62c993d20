// SPDX-License-Identifier: Apache-2.0
/* Takes a clip of two hills apart into local components, then drags a vertex, using only the C interface. */
#include <math.h>
#include <sac/sac_components.h>
#include <stdio.h>
#include <string.h>

enum { kSide = 24, kVertices = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1), kFrames = 20 };

static float hill(int v, int x, int y) {
  const float dx = (float)(v % kSide - x), dy = (float)(v / kSide - y), d = (dx * dx + dy * dy) / 16;
  return d < 1 ? (1 - d) * (1 - d) : 0;
}

/* `user` is the number of the next frame. */
static int next_frame(void* user, float* positions, int* end) {
  const int frame = (*(int*)user)++;
  *end = frame == kFrames;
  for (int v = 0; v < kVertices; ++v) {
    positions[3 * v] = (float)(v % kSide);
    positions[3 * v + 1] = (float)(v / kSide);
    positions[3 * v + 2] =
        sinf(0.5f * (float)frame) * hill(v, 6, 6) + (1 - cosf(0.9f * (float)frame)) * hill(v, 17, 17);
  }
  return 0;
}

static int rewind_clip(void* user) {
  *(int*)user = 0;
  return 0;
}

int main(void) {
  static uint32_t triangles[3 * kTriangles];
  uint32_t* t = triangles;
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t a = kSide * y + x, quad[6] = {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide};
      memcpy(t, quad, sizeof quad);
      t += 6;
    }
  }
  int next = 0;
  const sac_frame_source source = {&next, next_frame, rewind_clip};
  sac_decomposition_settings settings;
  sac_decomposition_settings_init(&settings);
  settings.count = 2;
  sac_components* components;
  sac_status status = sac_components_decompose(&components, kVertices, triangles, kTriangles, &source, &settings);
  sac_component_set set = {0};
  if (status == SAC_OK) status = sac_components_get(components, &set);
  for (uint32_t k = 0; k < set.count; ++k) {
    printf("%s: %u of %u vertices around (%u, %u)\n", set.components[k].name, set.components[k].nodes, set.vertices,
           set.components[k].centre % kSide, set.components[k].centre / kSide);
  }

  /* The top of the first hill, dragged half way up. */
  static float positions[3 * kVertices];
  const sac_drag_target target = {6 * kSide + 6, {6, 6, 0.5f}};
  float weights[2] = {0, 0};
  if (status == SAC_OK) status = sac_components_drag(components, &target, 1, NULL, weights);
  if (status == SAC_OK) status = sac_components_compose(components, weights, NULL, positions);
  if (status != SAC_OK) fprintf(stderr, "%s\n", sac_components_message(components));
  printf("dragged to 0.5, is at %.3f; weights %.3f %.3f\n", (double)positions[3 * target.vertex + 2],
         (double)weights[0], (double)weights[1]);
  sac_components_close(components);
  return status == SAC_OK && positions[3 * target.vertex + 2] > 0.3f ? 0 : 1;
}
