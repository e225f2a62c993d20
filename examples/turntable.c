// SPDX-License-Identifier: Apache-2.0
/* Draws every frame of a stream into a PNG file while the camera goes once around the shape. It needs no display:
 * Mesa's software renderer draws into memory, and libpng writes the files. */
#include <GL/osmesa.h>
#include <math.h>
#include <png.h>
#include <sac/sac.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kSize = 512 };

struct vertex {
  float position[3], normal[3];
};

struct scene {
  sac_mesh mesh;
  struct vertex* vertices;
  double centre[3], radius; /* of the first frame, model units */
  uint8_t pixels[kSize * kSize * 4];
};

static void draw(const struct scene* s, double turn) {
  const float light[4] = {0.4f, 0.6f, 1, 0}, color[4] = {0.75f, 0.72f, 0.68f, 1};
  glViewport(0, 0, kSize, kSize);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glOrtho(-s->radius, s->radius, -s->radius, s->radius, -4 * s->radius, 4 * s->radius);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  glLightfv(GL_LIGHT0, GL_POSITION, light);
  glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE, color);
  glRotated(15, 1, 0, 0);
  glRotated(360 * turn, 0, 1, 0);
  glTranslated(-s->centre[0], -s->centre[1], -s->centre[2]);
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_NORMAL_ARRAY);
  glVertexPointer(3, GL_FLOAT, sizeof(struct vertex), s->vertices->position);
  glNormalPointer(GL_FLOAT, sizeof(struct vertex), s->vertices->normal);
  glDrawElements(GL_TRIANGLES, (GLsizei)(3 * s->mesh.triangles), GL_UNSIGNED_INT, s->mesh.triangle_vertices);
  glFinish();
}

static int write_png(const struct scene* s, const char* pattern, uint32_t frame) {
  char name[4096];
  png_image image = {0};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = kSize;
  image.format = PNG_FORMAT_RGBA;
  snprintf(name, sizeof name, "%s%04u.png", pattern, frame);
  if (png_image_write_to_file(&image, name, 0, s->pixels, -kSize * 4, NULL)) return 1;
  fprintf(stderr, "turntable: %s: %s\n", name, image.message);
  return 0;
}

/* Allocates the vertices, interleaved as a GPU would have them, and points `buffers` at them. */
static int make_room(struct scene* s, sac_frame_buffers* buffers) {
  const size_t size = s->mesh.vertices * sizeof(struct vertex);
  s->vertices = calloc(1, size);
  if (s->vertices == NULL) return 0;
  buffers->positions.data = s->vertices->position;
  buffers->normals.data = s->vertices->normal;
  buffers->positions.stride = buffers->normals.stride = sizeof(struct vertex);
  buffers->positions.size = size;
  buffers->normals.size = size - offsetof(struct vertex, normal);
  return 1;
}

static void aim(struct scene* s, const sac_frame_info* info) {
  double squares = 0;
  for (int a = 0; a < 3; ++a) {
    const double size = info->box_high[a] - info->box_low[a];
    s->centre[a] = (info->box_low[a] + info->box_high[a]) / 2;
    squares += size * size;
  }
  s->radius = squares > 0 ? 0.6 * sqrt(squares) : 1;
}

static sac_status turn(sac_decoder* decoder, FILE* file, struct scene* s, const char* pattern, double frames_a_turn) {
  uint8_t chunk[65536];
  size_t size;
  sac_status status = SAC_OK;
  sac_frame_buffers buffers = {0};
  while ((size = fread(chunk, 1, sizeof chunk, file)) > 0) {
    const uint8_t* data = chunk;
    while (size > 0) {
      sac_frame_info info;
      if ((status = sac_decoder_send(decoder, &data, &size)) != SAC_OK) return status;
      if (s->vertices == NULL && sac_decoder_mesh(decoder, &s->mesh) == SAC_OK && !make_room(s, &buffers)) {
        return SAC_LIMIT;
      }
      while ((status = sac_decoder_receive(decoder, &buffers, &info)) == SAC_OK) {
        if (s->radius == 0) aim(s, &info);
        draw(s, info.index / frames_a_turn);
        if (!write_png(s, pattern, info.index)) return SAC_INVALID_ARGUMENT;
      }
      if (status != SAC_NEED_MORE_DATA) return status;
    }
  }
  return sac_decoder_finish(decoder);
}

int main(int argc, char** argv) {
  FILE* file = argc == 4 ? fopen(argv[1], "rb") : NULL;
  const double frames_a_turn = argc == 4 ? atof(argv[3]) : 0;
  if (file == NULL || !(frames_a_turn > 0)) {
    fprintf(stderr, "usage: turntable STREAM OUT FRAMES_A_TURN\nwrites OUT0000.png, OUT0001.png and so on\n");
    return 2;
  }
  struct scene* s = calloc(1, sizeof *s);
  OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, NULL);
  sac_decoder* decoder;
  if (s == NULL || context == NULL || sac_decoder_open(&decoder, NULL) != SAC_OK ||
      !OSMesaMakeCurrent(context, s->pixels, GL_UNSIGNED_BYTE, kSize, kSize)) {
    fprintf(stderr, "turntable: cannot draw\n");
    return 1;
  }
  const sac_status status = turn(decoder, file, s, argv[2], frames_a_turn);
  if (status != SAC_OK) fprintf(stderr, "turntable: %s: %s\n", argv[1], sac_decoder_message(decoder));
  sac_decoder_close(decoder);
  OSMesaDestroyContext(context);
  free(s->vertices);
  free(s);
  fclose(file);
  return status == SAC_OK ? 0 : 1;
}
