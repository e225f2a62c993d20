#include "conformance/valid_vectors.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "format/stream_index.h"
#include "synth/synth.h"

namespace sac {
namespace {

Clip Synth(SynthKind kind, std::uint32_t vertices, std::uint32_t frames) {
  SynthClip synth;
  if (const Status status = SynthClip::Create({kind, vertices, frames, 1}, synth); !status.ok()) {
    std::fprintf(stderr, "make_vectors: %s\n", status.message().c_str());
    std::exit(1);
  }
  Clip clip{synth.mesh(), {}};
  for (std::uint32_t f = 0; f < frames; ++f) clip.frames.push_back(synth.Frame(f));
  return clip;
}

// Frames that wave the mesh and turn it.
Clip Wave(const Mesh& mesh, std::uint32_t frames) {
  Clip clip{mesh, {}};
  for (std::uint32_t f = 0; f < frames; ++f) {
    const double t = 0.2 * f;
    Positions& positions = clip.frames.emplace_back(mesh.positions);
    for (Vec3f& p : positions) {
      const double x = static_cast<double>(p[0]), y = static_cast<double>(p[1]), z = static_cast<double>(p[2]);
      p = {static_cast<float>(x * std::cos(t) - y * std::sin(t)), static_cast<float>(x * std::sin(t) + y * std::cos(t)),
           static_cast<float>(z + 0.3 * std::sin(t) * x * x)};
    }
  }
  return clip;
}

// All that Draco cannot keep: two fans joined at one vertex, three triangles at an edge, a loose vertex, a degenerate
// and a duplicate triangle, one turned around; with all attributes and a seam of texture coordinates.
Mesh OddMesh() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0},     {1, 0, 0},    {1, 1, 0},     {0, 1, 0},        {-1, 0, 0},     {-1, -1, 0.5f},
                    {0, -1, 0.5f}, {2, 0.5f, 1}, {2, 0.5f, -1}, {0.5f, 2, 0.25f}, {1.5f, 2, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 6}, {1, 2, 7},   {2, 1, 8},
                    {3, 2, 9}, {3, 3, 2}, {0, 1, 2}, {2, 9, 3}, {10, 10, 10}};
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto i = static_cast<std::uint8_t>(v);
    mesh.normals.push_back(v % 2 ? Vec3f{0, 0, 1} : Vec3f{0.6f, 0, 0.8f});
    mesh.colors.push_back({static_cast<std::uint8_t>(20 * i), 100, static_cast<std::uint8_t>(255 - i), 255});
  }
  for (std::size_t i = 0; i < 12; ++i) mesh.uvs.push_back({static_cast<float>(i) / 11, static_cast<float>(i % 3) / 2});
  for (const Triangle& t : mesh.triangles) mesh.uv_triangles.push_back(t);
  mesh.uv_triangles[1] = {0, 2, 11};  // the seam
  return mesh;
}

// More neighbours, and more triangles at an edge, than the code of positions looks at (spec.md 5.5): double cones
// around 31, 32 and 33 vertices, joined to each other, a book of 25 pages, and triangles at random.
Mesh CrowdedMesh() {
  Mesh mesh;
  std::mt19937 random(2);
  const auto jitter = [&] { return static_cast<float>(random() % 1000) / 1000; };
  const auto size = [&] { return static_cast<std::uint32_t>(mesh.positions.size()); };
  for (std::uint32_t ring = 31; ring <= 33; ++ring) {
    const std::uint32_t top = size(), bottom = top + 1, first = top + 2;
    const float x = 3 * static_cast<float>(ring - 31);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 1}, {x, 0, -1}});
    for (std::uint32_t i = 0; i < ring; ++i) {
      const float turn = 6.2831853f * static_cast<float>(i) / static_cast<float>(ring);
      mesh.positions.push_back({x + std::cos(turn), std::sin(turn), 0.1f * jitter()});
      const std::uint32_t a = first + i, b = first + (i + 1) % ring;
      mesh.triangles.insert(mesh.triangles.end(), {{top, a, b}, {bottom, b, a}});
    }
    if (ring > 31) mesh.triangles.push_back({top + 2, top - 1, top - 2});
  }
  const std::uint32_t spine = size();
  mesh.positions.insert(mesh.positions.end(), {{0, 3, 0}, {0, 3, 1}});
  for (std::uint32_t page = 0; page < 25; ++page) {
    const float turn = 0.25f * static_cast<float>(page), length = 1 + jitter();
    mesh.triangles.push_back({spine, spine + 1, size()});
    if (page > 0) mesh.triangles.push_back({size() - 1, size(), spine});
    mesh.positions.push_back({length * std::cos(turn), 3 + length * std::sin(turn), jitter()});
  }
  const std::uint32_t tangle = size();
  for (int i = 0; i < 30; ++i) mesh.positions.push_back({3 + jitter(), 3 + jitter(), jitter()});
  for (int i = 0; i < 120; ++i) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::uint32_t& corner : t) corner = tangle + random() % 30;
  }
  return mesh;
}

// The first frame again and again, then motion, then its last frame again and again.
Clip StandStill() {
  Clip clip = Synth(SynthKind::kFlag, 120, 12);
  clip.frames.insert(clip.frames.begin(), 9, clip.frames.front());
  clip.frames.insert(clip.frames.end(), 9, clip.frames.back());
  return clip;
}

Clip Cuts() {
  Clip clip = Synth(SynthKind::kParts, 200, 24);
  for (std::size_t f = 8; f < 16; ++f) {
    for (Vec3f& p : clip.frames[f]) p = {p[1] + 3, -p[0], 0.5f * p[2]};
  }
  return clip;
}

// Residuals that no encoder would choose: of any magnitude, predicted from anything.
void FillAtRandom(std::mt19937& random, const References* references, std::uint32_t index, FrameSyntax& frame) {
  const auto residual = [&](std::uint32_t one_in, int most_bits) {
    std::int32_t value = 0;
    for (int bit = 0; bit < most_bits && random() % one_in == 0; ++bit) {
      value = 2 * value + 1 + static_cast<std::int32_t>(random() % 2);
    }
    return random() % 2 ? value : -value;
  };
  if (references) {
    frame.slot.references = *references;
  } else if (index > 0 && random() % 2) {
    frame.slot.references.resize(random() % 3);
    for (std::uint32_t& r : frame.slot.references) r = random() % index;
  }
  if (random() % 4 == 0) return;
  const std::uint32_t one_in = 2 + random() % 5;
  for (std::int32_t& r : frame.rigid) r = residual(2, 9);
  for (PlaneValues& plane : frame.planes) {
    if (plane.empty() || random() % 3 == 0) continue;
    for (std::int32_t& r : plane) r = residual(one_in, 8);
    if (random() % 4 == 0) plane[random() % plane.size()] = random() % 2 ? 1 << 16 : -(1 << 16);
  }
}

Bytes Perverse() {
  EncoderSettings settings;
  settings.harmonics = 30;
  settings.motion_step = 1e-5;
  settings.displacement_step = 1e-8;
  settings.level_growth = 2;
  settings.samples_per_harmonic = 3;
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
  for (const std::array<std::uint32_t, 2>& size : {std::array{9u, 8u}, {1u, 1u}, {7u, 3u}, {4u, 4000000000u}}) {
    parts.groups.push_back(CodeGroup(
        parts, size[0], size[1], [&](std::uint32_t i, FrameSyntax& frame) { FillAtRandom(random, nullptr, i, frame); },
        parts.frames));
    parts.frames += size[0];
  }
  return parts.Join();
}

// As many components of one vertex. Without Draco, too.
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

// A pyramid of levels to 10, of which the last two have steps at their bound, and large coefficients.
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

// Open groups beside a whole one, with references to any earlier frame; one is empty. Without Draco, for decoders that
// do not have it yet.
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

// The start comes again and again, and an index ends it: groups of all kinds, one of no frames. Without Draco, too.
Bytes RepeatedStart() {
  StreamParts parts = SmallStream();
  const auto still = [](std::uint32_t, FrameSyntax&) {};
  const Bytes header = WriteSequenceHeader(parts.header), i_frame = WriteIFrame(parts.i_frame, parts.header);
  Bytes stream = Magic();
  const auto start = [&] {
    AppendPacket(stream, PacketType::kHeader, header);
    AppendPacket(stream, PacketType::kIFrame, i_frame);
  };
  start();
  EndSyntax end{0, StreamIndex{static_cast<std::uint32_t>(stream.size()), {}}};
  std::size_t begin = stream.size();
  // What follows the last group is the next one's start.
  const auto group_ends = [&](std::uint32_t frames, bool again) {
    if (again) start();
    end.index->groups.push_back({static_cast<std::uint32_t>(stream.size() - begin), frames});
    begin = stream.size();
    end.frames += frames;
  };
  AppendPacket(stream, PacketType::kGroup, parts.groups[0]);
  group_ends(3, true);
  for (const std::uint32_t frames : {0u, 2u}) {
    const Bytes open = CodeOpenGroup(parts, frames, still, end.frames);
    stream.insert(stream.end(), open.begin(), open.end());
    group_ends(frames, frames == 2);
  }
  AppendPacket(stream, PacketType::kGroup, CodeGroup(parts, 200, 16, still, end.frames));
  group_ends(200, false);
  AppendPacket(stream, PacketType::kEnd, WriteEnd(end));
  return stream;
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

}  // namespace

std::vector<ValidVector> ValidVectors() {
  std::vector<ValidVector> vectors;
  const auto encode = [&](const char* name, const char* covers, const Clip& clip, EncoderSettings settings,
                          double quality = 30) {
    settings.quality = quality;
    vectors.push_back({name, covers, Encode(clip, settings)});
  };
  EncoderSettings s;
  s.harmonics = 24;

  vectors.push_back({"small", "spec.md appendix A: no Draco mesh, 3 frames in a pyramid", SmallStream().Join()});
  {
    StreamParts none = SmallStream();
    none.groups.clear();
    none.frames = 0;
    vectors.push_back({"no_frames", "no groups", none.Join()});
  }

  EncoderSettings pyramids = s;
  pyramids.group = 20;
  pyramids.pyramid = 8;
  encode("pyramids", "B-frames, several groups, the last one short, reduced basis", Synth(SynthKind::kFlag, 200, 45),
         pyramids);
  EncoderSettings chain = s;
  chain.pyramid = 1;
  chain.group = 8;
  encode("chain", "P-frames only, texture coordinates, boundary", Synth(SynthKind::kFlag, 200, 12), chain);
  EncoderSettings previous = s;
  previous.reference_shape = ReferenceShape::kPrevious;
  previous.group = 10;
  encode("previous", "reference shape of the frame before", Synth(SynthKind::kFlag, 200, 16), previous);
  EncoderSettings exact = s;
  exact.samples_per_harmonic = 0;
  exact.position_bits = 7;
  encode("exact", "exact harmonics of a symmetric shape, normals", Synth(SynthKind::kSphere, 160, 20), exact);
  EncoderSettings kept = s;
  kept.keep_order = true;
  encode("components", "many components, colours, kept order", Synth(SynthKind::kParts, 200, 20), kept);
  encode("seam", "texture coordinates with a seam, kept order", Synth(SynthKind::kVase, 200, 10), kept);
  encode("odd", "welds, loose vertices and triangles, all attributes, kept order", Wave(OddMesh(), 12), kept, 60);
  encode("crowded", "vertices of more than 32 edges, edges of many triangles", Wave(CrowdedMesh(), 3), s, 60);
  encode("stand_still", "frames that repeat, within a group and across groups", StandStill(), pyramids);
  encode("cuts", "intra frames within a group", Cuts(), pyramids);
  EncoderSettings detail = s;
  detail.harmonics = 20;
  detail.detail_step = 0.003;
  encode("detail", "a detail plane", Synth(SynthKind::kFlag, 205, 6), detail);
  EncoderSettings bounded = s;
  bounded.harmonics = 20;
  bounded.max_error = 0.01;
  encode("bounded", "a correction plane", Synth(SynthKind::kParts, 150, 8), bounded);
  vectors.push_back({"rows", "all planes of more than 1,024 rows, as many components", Rows()});
  EncoderSettings everything = previous;
  everything.detail_step = 0.01;
  everything.max_error = 0.02;
  encode("previous_everything", "all planes against the frame before", Synth(SynthKind::kFlag, 100, 8), everything);
  encode("one_frame", "a single frame", Synth(SynthKind::kSphere, 100, 1), s);

  EncoderSettings groups_of_one = s;
  groups_of_one.group = 1;
  encode("groups_of_one", "key frames only", Synth(SynthKind::kFlag, 100, 4), groups_of_one);
  Mesh points;
  points.positions = {{0, 0, 0}, {1, 2, 3}, {-1, 0, 0.5f}};
  encode("points", "vertices without triangles", Wave(points, 6), s, 60);
  Mesh point;
  point.positions = {{5, 6, 7}};
  encode("one_vertex", "one vertex", Wave(point, 3), s, 60);
  EncoderSettings coarse = s;
  coarse.position_bits = 1;
  encode("coarse", "steps of half the extent: vertices at one position, degenerate areas",
         Synth(SynthKind::kSphere, 60, 3), coarse);
  EncoderSettings fine = s;
  fine.position_bits = 24;
  encode("fine", "a grid of 2^24 places, steps of one", Synth(SynthKind::kSphere, 60, 3), fine);

  EncoderSettings low_delay = s;
  low_delay.low_delay = true;
  low_delay.group = 6;
  encode("low_delay", "open groups, the last one short, texture coordinates", Synth(SynthKind::kFlag, 200, 16),
         low_delay);
  EncoderSettings low_delay_previous = low_delay;
  low_delay_previous.reference_shape = ReferenceShape::kPrevious;
  encode("low_delay_previous", "an open group against the frame before", Synth(SynthKind::kFlag, 100, 5),
         low_delay_previous);
  vectors.push_back({"open_groups", "a whole group, open groups with explicit references, one empty", OpenGroups()});
  vectors.push_back({"repeated_start", "the start again between groups, an index, an empty group", RepeatedStart()});
  EncoderSettings broadcast = chain;
  broadcast.group = 3;
  broadcast.repeat_start = 2;
  encode("broadcast", "the start again before every second group, a Draco mesh", Synth(SynthKind::kFlag, 100, 11),
         broadcast);
  vectors.push_back({"perverse",
                     "explicit references of all kinds, all magnitudes, level growth 2, levels above 2, a pyramid much "
                     "longer than its group",
                     Perverse()});
  vectors.push_back({"deep", "levels to 10, steps at their bound of 4,096, large coefficients", Deep()});
  vectors.push_back({"perverse_previous", "the same against the frame before, with intra frames", PerversePrevious()});
  return vectors;
}

}  // namespace sac
