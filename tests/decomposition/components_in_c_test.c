// SPDX-License-Identifier: Apache-2.0
/* Takes a clip apart, poses, drags and edits it by the interface of C alone, compiled as C: a plane on which two hills
 * far apart rise and fall. */
#include <math.h>
#include <sac/sac_components.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kSide = 24, kVertices = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1), kFrames = 20 };
enum { kLeft = 6 * kSide + 6, kRight = 17 * kSide + 17 }; /* the tops of the hills */

static int failures = 0;

static void check(int good, int line, const char* what) {
  if (good) return;
  ++failures;
  fprintf(stderr, "line %d: %s\n", line, what);
}
#define CHECK(condition) check((condition) ? 1 : 0, __LINE__, #condition)

struct clip {
  int next;
  int fails_at; /* a frame, or -1 */
};

static float hill(int v, int top) {
  const float x = (float)(v % kSide - top % kSide), y = (float)(v / kSide - top / kSide);
  const float d = sqrtf(x * x + y * y) / 4;
  return d < 1 ? (1 - d * d) * (1 - d * d) : 0;
}

static void frame_at(int frame, float* positions) {
  const float left = sinf(0.5f * (float)frame), right = 1 - cosf(0.9f * (float)frame);
  for (int v = 0; v < kVertices; ++v) {
    positions[3 * v] = (float)(v % kSide);
    positions[3 * v + 1] = (float)(v / kSide);
    positions[3 * v + 2] = left * hill(v, kLeft) + right * hill(v, kRight);
  }
}

static int next_frame(void* user, float* positions, int* end) {
  struct clip* clip = user;
  if (clip->next == clip->fails_at) return 1;
  *end = clip->next == kFrames;
  if (*end == 0) frame_at(clip->next++, positions);
  return 0;
}

static int rewind_clip(void* user) {
  ((struct clip*)user)->next = 0;
  return 0;
}

static const uint32_t* grid(void) {
  static uint32_t triangles[3 * kTriangles];
  uint32_t* t = triangles;
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t a = kSide * y + x, quad[6] = {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide};
      memcpy(t, quad, sizeof quad);
      t += 6;
    }
  }
  return triangles;
}

static int count_to_three(void* user, uint32_t iteration, double objective) {
  CHECK(isfinite(objective));
  *(uint32_t*)user = iteration;
  return iteration >= 3;
}

/* The component whose centre is nearest to `vertex`. */
static uint32_t nearest(const sac_component_set* set, int vertex) {
  uint32_t best = 0;
  double least = INFINITY;
  for (uint32_t k = 0; k < set->count; ++k) {
    const double x = (int)(set->components[k].centre % kSide) - vertex % kSide;
    const double y = (int)(set->components[k].centre / kSide) - vertex / kSide;
    if (x * x + y * y < least) {
      least = x * x + y * y;
      best = k;
    }
  }
  return best;
}

static float largest_difference(const float* a, const float* b) {
  float largest = 0;
  for (int i = 0; i < 3 * kVertices; ++i) largest = fmaxf(largest, fabsf(a[i] - b[i]));
  return largest;
}

static void read_and_store(sac_components* components, const sac_frame_source* source) {
  static float positions[3 * kVertices], again[3 * kVertices], frame[3 * kVertices];
  sac_component_set set, stored;
  sac_decomposition_report report;
  CHECK(sac_components_get(components, &set) == SAC_OK);
  CHECK(set.vertices == kVertices && set.triangles == kTriangles && set.count == 2 && set.frames == kFrames);
  const uint32_t left = nearest(&set, kLeft), right = nearest(&set, kRight);
  CHECK(left != right);
  for (uint32_t k = 0; k < 2; ++k) {
    const sac_component* c = set.components + k;
    CHECK(c->nodes > 0 && c->nodes < kVertices && strlen(c->name) > 0);
    /* No component reaches over to the top of the other hill. */
    for (uint32_t i = 0; i < c->nodes; ++i) CHECK(c->indices[i] != (k == left ? kRight : kLeft));
  }
  CHECK(sac_components_report(components, &report) == SAC_OK);
  CHECK(report.iterations > 0 && report.columns == kFrames && report.residual_share < 0.02);
  for (uint32_t i = 1; i < report.iterations; ++i) CHECK(report.objective[i] <= report.objective[i - 1] * (1 + 1e-4));
  double erms = -1, largest = -1;
  CHECK(sac_components_measure(components, source, &erms, &largest) == SAC_OK);
  CHECK(erms > 0 && erms < 5 && largest < 0.5);
  /* What is stored poses the same. */
  sac_components* opened;
  CHECK(sac_components_open(&opened, &set) == SAC_OK);
  for (uint32_t f = 0; f < set.frames; ++f) {
    const float* weights = set.weights + f * set.count;
    CHECK(sac_components_compose(components, weights, set.track + f, positions) == SAC_OK);
    CHECK(sac_components_compose(opened, weights, set.track + f, again) == SAC_OK);
    CHECK(memcmp(positions, again, sizeof positions) == 0);
    frame_at((int)f, frame);
    CHECK(largest_difference(positions, frame) <= (float)largest * 1.01f);
  }
  CHECK(sac_components_get(opened, &stored) == SAC_OK);
  CHECK(memcmp(stored.weights, set.weights, sizeof(float) * set.count * set.frames) == 0);
  sac_components_close(opened);
}

static void fit_drag_edit(sac_components* components, const sac_frame_source* source) {
  static float positions[3 * kVertices], frame[3 * kVertices], edited[3 * kVertices];
  sac_component_set set, other;
  float weights[2];
  sac_rigid_pose pose;
  CHECK(sac_components_get(components, &set) == SAC_OK);
  const uint32_t left = nearest(&set, kLeft);
  /* A shape that is composed is fitted by the weights that it was composed of. */
  sac_rigid_pose turned = set.track[0];
  turned.rotation[0] = turned.rotation[4] = 0;
  turned.rotation[1] = -1;
  turned.rotation[3] = turned.rotation[8] = 1;
  turned.translation[2] = 7;
  const float given[2] = {0.5f, -0.25f};
  CHECK(sac_components_compose(components, given, &turned, positions) == SAC_OK);
  CHECK(sac_components_fit(components, positions, weights, &pose) == SAC_OK);
  CHECK(fabsf(weights[0] - given[0]) < 1e-2f && fabsf(weights[1] - given[1]) < 1e-2f);
  CHECK(fabs(pose.rotation[1] + 1) < 1e-3 && fabs(pose.translation[2] - 7) < 0.1);
  sac_components* fitted;
  CHECK(sac_components_fit_clip(&fitted, components, source, 1, NULL, NULL) == SAC_OK);
  CHECK(sac_components_get(fitted, &other) == SAC_OK && other.frames == kFrames);
  sac_components_close(fitted);
  /* The hill that is dragged rises, the other stays to the last bit. */
  const sac_drag_target target = {kLeft, {(float)(kLeft % kSide), (float)(kLeft / kSide), 0.5f}};
  CHECK(sac_components_drag(components, &target, 1, NULL, weights) == SAC_OK);
  CHECK(weights[1 - left] == 0 && weights[left] != 0);
  CHECK(sac_components_compose(components, weights, NULL, positions) == SAC_OK);
  CHECK(positions[3 * kLeft + 2] > 0.4f && positions[3 * kRight + 2] == set.rest[3 * kRight + 2]);
  sac_component_edit edits[2] = {{1, 0, NULL}, {1, 0, NULL}};
  frame_at(3, frame);
  memcpy(edited, frame, sizeof frame);
  CHECK(sac_components_edit(components, edits, 3, edited) == SAC_OK && memcmp(edited, frame, sizeof frame) == 0);
  edits[left].gain = 2;
  CHECK(sac_components_edit(components, edits, 3, edited) == SAC_OK);
  CHECK(fabsf(edited[3 * kLeft + 2] - 2 * frame[3 * kLeft + 2]) < 0.2f);
  CHECK(edited[3 * kRight + 2] == frame[3 * kRight + 2]);
  CHECK(sac_components_edit(components, edits, kFrames, edited) == SAC_INVALID_ARGUMENT);
  CHECK(strcmp(sac_components_message(components), "there is no frame 20 among 20") == 0);
  edits[0].offset = NAN;
  CHECK(sac_components_edit(components, edits, 3, edited) == SAC_INVALID_ARGUMENT);
}

static void refuse_poses(sac_components* components) {
  static float positions[3 * kVertices];
  float weights[2] = {0, NAN};
  sac_drag_settings drag;
  sac_drag_settings_init(&drag);
  CHECK(sac_components_compose(components, weights, NULL, positions) == SAC_INVALID_ARGUMENT);
  CHECK(strcmp(sac_components_message(components), "a weight is not finite") == 0);
  CHECK(sac_components_compose(components, NULL, NULL, positions) == SAC_INVALID_ARGUMENT);
  weights[1] = 0;
  CHECK(sac_components_compose(components, weights, NULL, NULL) == SAC_INVALID_ARGUMENT);
  const sac_drag_target missing = {kVertices, {0, 0, 0}};
  CHECK(sac_components_drag(components, &missing, 1, &drag, weights) == SAC_INVALID_ARGUMENT);
  CHECK(strcmp(sac_components_message(components), "there is no vertex 576 among 576") == 0);
  drag.price = -1;
  CHECK(sac_components_drag(components, NULL, 0, &drag, weights) == SAC_INVALID_ARGUMENT);
  drag.price = 0;
  drag.pose.translation[0] = INFINITY;
  CHECK(sac_components_drag(components, NULL, 0, &drag, weights) == SAC_INVALID_ARGUMENT);
  ++drag.struct_size;
  CHECK(sac_components_drag(components, NULL, 0, &drag, weights) == SAC_UNSUPPORTED);
  CHECK(sac_components_fit(components, NULL, weights, NULL) == SAC_INVALID_ARGUMENT);
  CHECK(sac_components_get(components, NULL) == SAC_INVALID_ARGUMENT);
}

/* Decomposes by `settings` and expects a failure, with a message that begins so. */
static void expect(sac_status status, const char* message, const sac_frame_source* source,
                   const sac_decomposition_settings* settings, int line) {
  sac_components* components;
  const sac_status got = sac_components_decompose(&components, kVertices, grid(), kTriangles, source, settings);
  check(got == status, line, "status");
  check(strncmp(sac_components_message(components), message, strlen(message)) == 0, line,
        sac_components_message(components));
  sac_component_set set;
  check(sac_components_get(components, &set) == SAC_INVALID_ARGUMENT, line, "what was not made is given out");
  sac_components_close(components);
}

static void refuse_decompositions(const sac_frame_source* source, struct clip* clip) {
  sac_decomposition_settings s;
  uint32_t iterations = 0;
  sac_decomposition_settings_init(&s);
  s.count = 3;
  s.progress = count_to_three;
  s.user = &iterations;
  expect(SAC_CANCELLED, "cancelled", source, &s, __LINE__);
  CHECK(iterations == 3);
  s.progress = NULL;
  s.count = 0;
  expect(SAC_INVALID_ARGUMENT, "the number of components", source, &s, __LINE__);
  s.count = 3;
  s.domain = 2;
  expect(SAC_INVALID_ARGUMENT, "there is no domain 2", source, &s, __LINE__);
  s.domain = SAC_DISPLACEMENT;
  s.rest_shape = SAC_REST_GIVEN;
  expect(SAC_INVALID_ARGUMENT, "rest: a null pointer", source, &s, __LINE__);
  s.rest_shape = SAC_REST_MEAN;
  const uint32_t far_away = kVertices;
  const sac_stroke stroke = {"brow", 1, &far_away, NULL};
  s.strokes = &stroke;
  s.stroke_count = 1;
  expect(SAC_INVALID_ARGUMENT, "stroke brow: there is no vertex 576", source, &s, __LINE__);
  s.stroke_count = 0;
  s.struct_size += 8;
  expect(SAC_UNSUPPORTED, "settings of a later library", source, &s, __LINE__);
  s.struct_size = 4;
  expect(SAC_INVALID_ARGUMENT, "settings that", source, &s, __LINE__);
  clip->fails_at = 7;
  expect(SAC_INVALID_ARGUMENT, "the source ended it", source, NULL, __LINE__);
  clip->fails_at = -1;
  expect(SAC_INVALID_ARGUMENT, "a null pointer", NULL, NULL, __LINE__);
  sac_components_close(NULL);
  CHECK(sac_components_open(NULL, NULL) == SAC_INVALID_ARGUMENT);
  sac_component_set set;
  memset(&set, 0, sizeof set);
  sac_components* components;
  CHECK(sac_components_open(&components, &set) == SAC_INVALID_ARGUMENT);
  CHECK(strcmp(sac_components_message(components), "the rest shape has no vertices") == 0);
  sac_components_close(components);
}

int main(void) {
  struct clip clip = {0, -1};
  const sac_frame_source source = {&clip, next_frame, rewind_clip};
  sac_decomposition_settings settings;
  sac_decomposition_settings_init(&settings);
  settings.count = 2;
  settings.sparsity = 0.03;
  settings.support_full = 0.3;
  for (uint32_t domain = SAC_DISPLACEMENT; domain <= SAC_GRADIENT; ++domain) {
    sac_components* components;
    settings.domain = domain;
    CHECK(sac_components_decompose(&components, kVertices, grid(), kTriangles, &source, &settings) == SAC_OK);
    CHECK(strcmp(sac_components_message(components), "") == 0);
    if (domain == SAC_DISPLACEMENT) {
      read_and_store(components, &source);
      fit_drag_edit(components, &source);
      refuse_poses(components);
    } else {
      double erms = -1;
      CHECK(sac_components_measure(components, &source, &erms, NULL) == SAC_OK);
      CHECK(erms > 0 && erms < 10);
    }
    sac_components_close(components);
  }
  refuse_decompositions(&source, &clip);
  return failures == 0 ? 0 : 1;
}
