// SPDX-License-Identifier: Apache-2.0
#include "conformance/valid_vectors.h"

#include <algorithm>
#include <array>
#include <random>

#include "codec/vertex_copies.h"
#include "conformance/valid_packets.h"
#include "conformance/vector_clips.h"
#include "geometry/components.h"
#include "tests/hard_cube.h"

namespace sac {
namespace {

Bytes Perverse() {
  EncoderSettings settings;
  settings.harmonics = 30;
  settings.motion_step = 1e-5;
  settings.displacement_step = 1e-8;
  settings.level_growth = 2;
  settings.handles_per_harmonic = 3;
  settings.frame_rate_numerator = 30000;
  settings.frame_rate_denominator = 1001;
  settings.detail_step = 1e-8;
  StreamParts parts = Split(Encode(Synth(SynthKind::kVase, 100, 1), settings));
  parts.groups.clear();
  parts.header.patch_size = 20;
  parts.header.correction_step = 1e-8f;
  parts.header.rotation_step = 0.01f;
  parts.header.translation_step = 0.01f;
  Derive(parts);
  std::mt19937 random(5);
  parts.frames = 0;
  for (const std::array<std::uint32_t, 2>& size : {std::array{9u, 8u}, {1u, 1u}, {7u, 3u}, {4u, 1000000000u}}) {
    parts.groups.push_back(CodeGroup(
        parts, size[0], size[1], [&](std::uint32_t i, FrameSyntax& frame) { FillAtRandom(random, nullptr, i, frame); },
        parts.frames));
    parts.frames += size[0];
  }
  return parts.Join();
}

// A stream of components of one vertex each, coded without Draco.
Bytes Rows() {
  constexpr std::uint32_t kVertices = 1030;
  StreamParts parts = SmallStream();
  parts.header.vertices = parts.header.harmonics = kVertices;
  parts.header.triangles = 0;
  parts.i_frame.loose_vertices.clear();
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    parts.i_frame.loose_vertices.push_back({{v % 16, v / 16 % 16, v / 256}, {}, {}});
  }
  parts.i_frame.loose_triangles.clear();
  parts.i_frame.harmonics.assign(kVertices, 1);
  Derive(parts);
  std::mt19937 random(7);
  parts.groups = {CodeGroup(parts, 3, 2, [&](std::uint32_t, FrameSyntax& frame) {
    for (PlaneValues& plane : frame.planes) {
      for (std::int32_t& r : plane) r = random() % 32 == 0 ? static_cast<std::int32_t>(random() % 9) - 4 : 0;
    }
  })};
  return parts.Join();
}

// A pyramid with levels up to 10, whose steps reach their bound on the last two levels, and with large coefficients.
Bytes Deep() {
  StreamParts parts = SmallStream();
  parts.header.level_growth = 120;
  for (float* step : {&parts.header.motion_step, &parts.header.displacement_step, &parts.header.detail_step,
                      &parts.header.correction_step}) {
    *step *= 1e-8f;
  }
  std::mt19937 random(3);
  parts.groups = {CodeGroup(parts, 1025, 1024, [&](std::uint32_t, FrameSyntax& frame) {
    if (random() % 16 != 0) return;
    for (PlaneValues& plane : frame.planes) {
      const std::int32_t most = &plane == &frame.planes[kCorrection] ? 1 << 20 : 1 << (random() % 15);
      for (std::int32_t& r : plane) {
        if (random() % 3 == 0) r = static_cast<std::int32_t>(random() % (2 * most)) - most;
      }
    }
  })};
  parts.frames = 1025;
  return parts.Join();
}

// Open groups after a whole group, with references to any earlier frame; one of them is empty. The stream is coded
// without Draco, so that decoders without Draco can decode it.
Bytes OpenGroups() {
  StreamParts parts = SmallStream();
  std::mt19937 random(9);
  const auto fill = [&](std::uint32_t i, FrameSyntax& frame) { FillAtRandom(random, nullptr, i, frame); };
  const auto still = [](std::uint32_t, FrameSyntax&) {};
  for (float* step : {&parts.header.motion_step, &parts.header.displacement_step, &parts.header.detail_step,
                      &parts.header.correction_step, &parts.header.rotation_step, &parts.header.translation_step}) {
    *step *= 1e-3f;
  }
  for (const std::uint32_t frames : {7u, 0u, 3u, 5u}) {
    parts.open_groups.push_back(frames == 3 ? CodeOpenGroup(parts, frames, still, parts.frames)
                                            : CodeOpenGroup(parts, frames, fill, parts.frames));
    parts.frames += frames;
  }
  return parts.Join();
}

Bytes PerversePrevious() {
  EncoderSettings settings;
  settings.harmonics = 12;
  settings.motion_step = 1e-5;
  settings.displacement_step = 1e-8;
  settings.reference_shape = ReferenceShape::kPrevious;
  StreamParts parts = Split(Encode(Synth(SynthKind::kSphere, 100, 1), settings));
  parts.header.rotation_step = 0.01f;
  parts.header.translation_step = 0.01f;
  parts.header.patch_size = 1;
  parts.header.detail_step = 1e-8f;
  parts.header.correction_step = 1e-8f;
  Derive(parts);
  std::mt19937 random(6);
  parts.groups.clear();
  parts.groups.push_back(CodeGroup(parts, 8, 1, [&](std::uint32_t i, FrameSyntax& frame) {
    const References none;
    FillAtRandom(random, i % 5 == 0 ? &none : &frame.slot.references, i, frame);
  }));
  parts.frames = 8;
  return parts.Join();
}

void Add(std::vector<ValidVector>& vectors, const char* name, const char* covers, const Clip& clip,
         EncoderSettings settings, double quality = 30) {
  settings.quality = quality;
  vectors.push_back({name, covers, Encode(clip, settings)});
}

EncoderSettings Harmonics(std::uint32_t harmonics) {
  EncoderSettings settings;
  settings.harmonics = harmonics;
  return settings;
}

EncoderSettings Chain() {
  EncoderSettings settings = Harmonics(24);
  settings.pyramid = 1;
  settings.group = 8;
  return settings;
}

EncoderSettings Previous() {
  EncoderSettings settings = Harmonics(24);
  settings.reference_shape = ReferenceShape::kPrevious;
  settings.group = 10;
  return settings;
}

// Triangles of few vertices, some degenerate, whose corners have copies at random. The mesh is coded without Draco.
Bytes RandomCopies() {
  constexpr std::uint32_t kVertices = 9, kTriangles = 60;
  StreamParts parts = SmallStream();
  std::mt19937 random(11);
  IFrameSyntax& frame = parts.i_frame;
  parts.header.vertices = kVertices;
  parts.header.triangles = kTriangles;
  frame.loose_vertices.clear();
  frame.loose_triangles.clear();
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    frame.loose_vertices.push_back({{v, v * v % 16, 7 * v % 11}, {}, {}});
  }
  std::vector<std::uint32_t> count(kVertices);
  std::vector<Triangle> copies;
  for (std::uint32_t j = 0; j < kTriangles; ++j) {
    Triangle& t = frame.loose_triangles.emplace_back();
    Triangle& of_corners = copies.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = random() % (kVertices - 1);  // the last has no corner
      of_corners[k] = std::min(count[t[k]], static_cast<std::uint32_t>(random() % 7));
      if (of_corners[k] == count[t[k]]) ++count[t[k]];
    }
  }
  parts.header.copies = 1 - kVertices;
  for (const std::uint32_t n : count) parts.header.copies += n;
  const CornerKinds kinds = KindsOfCorners(frame.loose_triangles, 0, {}, kVertices);
  CopyCoder<RecordedBins>(kVertices, frame.loose_triangles, kinds).Code(frame.positions, parts.header.copies, copies);
  std::uint32_t components = 0;
  const auto labels = LabelComponents(kVertices, frame.loose_triangles, components);
  frame.harmonics.assign(components, 1);
  frame.harmonics[labels[0]] = 3;
  parts.header.harmonics = components + 2;
  Derive(parts);
  parts.groups = {CodeGroup(parts, 3, 2, [&](std::uint32_t i, FrameSyntax& f) {
    if (i == 1) f.planes[kMotion][3] = 2;
  })};
  return parts.Join();
}

// Adds streams of vertices that have copies.
void AddCopies(std::vector<ValidVector>& vectors) {
  EncoderSettings joined = Harmonics(24);
  joined.join = joined.keep_order = true;
  Add(vectors, "copies", "copies of vertices by normals and texture coordinates, an order of copies",
      Wave(SplitMesh(Synth(SynthKind::kVase, 150, 1).mesh, 1), 5), joined, 60);
  Add(vectors, "copies_hard", "copies by normals alone", Wave(SplitMesh(HardCubeMesh(), 1), 4), joined, 60);
  Add(vectors, "copies_odd", "copies by colours, loose triangles of copies, a loose vertex",
      Wave(SplitMesh(OddHardMesh(), 2), 4), joined, 60);
  joined.detail_step = 0.003;
  joined.keep_order = false;
  Mesh plain = SplitMesh(Synth(SynthKind::kSphere, 150, 1).mesh, 3);
  plain.normals.clear();
  Add(vectors, "copies_plain", "copies without attributes, a detail plane", Wave(plain, 4), joined, 60);
  vectors.push_back({"copies_random", "many copies of few vertices, degenerate triangles of copies", RandomCopies()});
}

// Components of all scales, whose grids begin anywhere.
Bytes RandomScales() {
  EncoderSettings settings;
  settings.quality = 30;
  settings.harmonics = 40;
  settings.detail_step = 0.01;
  StreamParts parts = Split(Encode(Synth(SynthKind::kParts, 150, 1), settings));
  std::mt19937 random(13);
  for (std::size_t c = 0; c < parts.i_frame.harmonics.size(); ++c) {
    PartScale& scale = parts.i_frame.scales.emplace_back();
    scale.exponent = c == 0 ? kMaxPartExponent : random() % 4 == 0 ? 0 : static_cast<std::uint32_t>(random() % 20);
    if (scale.exponent == 0) continue;
    for (std::uint32_t& x : scale.origin) x = random() % (1u << parts.header.position_bits);
  }
  Derive(parts);
  parts.groups = {CodeGroup(parts, 5, 4, [&](std::uint32_t i, FrameSyntax& frame) {
    for (PlaneValues& plane : frame.planes) {
      for (std::int32_t& r : plane) r = random() % (8 + 8 * i) == 0 ? static_cast<std::int32_t>(random() % 9) - 4 : 0;
    }
  })};
  parts.frames = 5;
  return parts.Join();
}

// Adds streams with groups, references and meshes of all kinds.
void AddStructures(std::vector<ValidVector>& vectors) {
  vectors.push_back({"small", "spec.md appendix A: no Draco mesh, 3 frames in a pyramid", SmallStream().Join()});
  {
    StreamParts none = SmallStream();
    none.groups.clear();
    none.frames = 0;
    vectors.push_back({"no_frames", "no groups", none.Join()});
  }

  EncoderSettings pyramids = Harmonics(24);
  pyramids.group = 20;
  pyramids.pyramid = 8;
  Add(vectors, "pyramids", "B-frames, several groups, the last one short, reduced basis",
      Synth(SynthKind::kFlag, 200, 45), pyramids);
  Add(vectors, "chain", "P-frames only, texture coordinates, boundary", Synth(SynthKind::kFlag, 200, 12), Chain());
  Add(vectors, "previous", "reference shape of the frame before", Synth(SynthKind::kFlag, 200, 16), Previous());
  EncoderSettings exact = Harmonics(24);
  exact.handles_per_harmonic = 0;
  exact.position_bits = 7;
  Add(vectors, "exact", "exact harmonics of a symmetric shape, normals", Synth(SynthKind::kSphere, 160, 20), exact);
  EncoderSettings kept = Harmonics(24);
  kept.keep_order = true;
  Add(vectors, "components", "many components, colours, kept order", Synth(SynthKind::kParts, 200, 20), kept);
  Add(vectors, "seam", "texture coordinates with a seam, kept order", Synth(SynthKind::kVase, 200, 10), kept);
  Add(vectors, "odd", "welds, loose vertices and triangles, all attributes, kept order", Wave(OddMesh(), 12), kept, 60);
  EncoderSettings moved = kept;
  moved.offset = {500000.1, -5600000, 301};
  Add(vectors, "hard_edges", "normals of corners, an offset", Wave(HardCubeMesh(), 6), moved, 60);
  Add(vectors, "odd_hard", "normals of corners with welds, loose vertices and loose triangles, a seam",
      Wave(OddHardMesh(), 4), kept, 60);
  Add(vectors, "crowded", "vertices of more than 32 edges, edges of many triangles", Wave(CrowdedMesh(), 3),
      Harmonics(24), 60);
  AddCopies(vectors);
  EncoderSettings reaching = Harmonics(40);
  reaching.reach = 2;
  reaching.detail_step = 0.003;
  Add(vectors, "small_part", "a component with a scale", SmallPart(), reaching, 60);
  vectors.push_back({"scales", "components of all scales", RandomScales()});
  Add(vectors, "stand_still", "frames that repeat, within a group and across groups", StandStill(), pyramids);
  Add(vectors, "cuts", "intra frames within a group", Cuts(), pyramids);
}

// Adds streams that use all planes.
void AddPlanes(std::vector<ValidVector>& vectors) {
  EncoderSettings detail = Harmonics(20);
  detail.detail_step = 0.003;
  Add(vectors, "detail", "a detail plane", Synth(SynthKind::kFlag, 205, 6), detail);
  EncoderSettings bounded = Harmonics(20);
  bounded.max_error = 0.01;
  Add(vectors, "bounded", "a correction plane", Synth(SynthKind::kParts, 150, 8), bounded);
  vectors.push_back({"rows", "all planes of more than 1,024 rows, as many components", Rows()});
  EncoderSettings everything = Previous();
  everything.detail_step = 0.01;
  everything.max_error = 0.02;
  Add(vectors, "previous_everything", "all planes against the frame before", Synth(SynthKind::kFlag, 100, 8),
      everything);
  Add(vectors, "one_frame", "a single frame", Synth(SynthKind::kSphere, 100, 1), Harmonics(24));
}

// Adds streams with the smallest and largest values that settings and meshes allow.
void AddExtremes(std::vector<ValidVector>& vectors) {
  EncoderSettings groups_of_one = Harmonics(24);
  groups_of_one.group = 1;
  Add(vectors, "groups_of_one", "key frames only", Synth(SynthKind::kFlag, 100, 4), groups_of_one);
  Mesh points;
  points.positions = {{0, 0, 0}, {1, 2, 3}, {-1, 0, 0.5f}};
  Add(vectors, "points", "vertices without triangles", Wave(points, 6), Harmonics(24), 60);
  Mesh point;
  point.positions = {{5, 6, 7}};
  Add(vectors, "one_vertex", "one vertex", Wave(point, 3), Harmonics(24), 60);
  EncoderSettings coarse = Harmonics(24);
  coarse.position_bits = 1;
  Add(vectors, "coarse", "steps of half the extent: vertices at one position, degenerate areas",
      Synth(SynthKind::kSphere, 60, 3), coarse);
  EncoderSettings fine = Harmonics(24);
  fine.position_bits = 24;
  Add(vectors, "fine", "a grid of 2^24 places, steps of one", Synth(SynthKind::kSphere, 60, 3), fine);
}

// Adds streams with open groups, and streams that no encoder would choose.
void AddOpenGroups(std::vector<ValidVector>& vectors) {
  EncoderSettings low_delay = Harmonics(24);
  low_delay.low_delay = true;
  low_delay.group = 6;
  Add(vectors, "low_delay", "open groups, the last one short, texture coordinates", Synth(SynthKind::kFlag, 200, 16),
      low_delay);
  EncoderSettings low_delay_previous = low_delay;
  low_delay_previous.reference_shape = ReferenceShape::kPrevious;
  Add(vectors, "low_delay_previous", "an open group against the frame before", Synth(SynthKind::kFlag, 100, 5),
      low_delay_previous);
  vectors.push_back({"open_groups", "a whole group, open groups with explicit references, one empty", OpenGroups()});
  AddPacketVectors(vectors);
  EncoderSettings broadcast = Chain();
  broadcast.group = 3;
  broadcast.repeat_start = 2;
  Add(vectors, "broadcast", "the start again before every second group, a Draco mesh", Synth(SynthKind::kFlag, 100, 11),
      broadcast);
  vectors.push_back({"perverse",
                     "explicit references of all kinds, all magnitudes, level growth 2, levels above 2, a pyramid much "
                     "longer than its group",
                     Perverse()});
  vectors.push_back({"deep", "levels to 10, steps at their bound of 4,096, large coefficients", Deep()});
  vectors.push_back({"perverse_previous", "the same against the frame before, with intra frames", PerversePrevious()});
}

}  // namespace

std::vector<ValidVector> ValidVectors() {
  std::vector<ValidVector> vectors;
  for (const auto add : {AddStructures, AddPlanes, AddExtremes, AddOpenGroups}) add(vectors);
  return vectors;
}

}  // namespace sac
