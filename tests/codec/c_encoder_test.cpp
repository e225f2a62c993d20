// SPDX-License-Identifier: Apache-2.0
// The encoder's C interface, against the C++ one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "sac/sac_encode.h"
#include "tests/hard_cube.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

constexpr std::size_t kFrames = 12;

sac_encoder_settings Settings() {
  sac_encoder_settings settings;
  sac_encoder_settings_init(&settings);
  settings.harmonics = 20;
  settings.group = 5;
  return settings;
}

EncoderSettings SameSettings() {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = 5;
  return settings;
}

sac_input_mesh InputOf(const Mesh& mesh) {
  sac_input_mesh input = {};
  input.vertices = static_cast<std::uint32_t>(mesh.positions.size());
  input.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  input.uvs = static_cast<std::uint32_t>(mesh.uvs.size());
  input.positions = mesh.positions.empty() ? nullptr : mesh.positions[0].data();
  input.triangle_vertices = mesh.triangles.empty() ? nullptr : mesh.triangles[0].data();
  input.uv_values = mesh.uvs.empty() ? nullptr : mesh.uvs[0].data();
  input.triangle_uvs = mesh.uv_triangles.empty() ? nullptr : mesh.uv_triangles[0].data();
  input.normals = mesh.normals.empty() ? nullptr : mesh.normals[0].data();
  input.colors = mesh.colors.empty() ? nullptr : mesh.colors[0].data();
  if (!mesh.normal_triangles.empty()) {
    input.corner_normals = static_cast<std::uint32_t>(mesh.normals.size());
    input.triangle_normals = mesh.normal_triangles[0].data();
  }
  return input;
}

// Encodes through C; `bytes` are what came out up to an error.
struct CEncoding {
  sac_status status = SAC_OK;
  std::string message;
  std::vector<std::uint8_t> bytes;

  CEncoding(const Clip& clip, const sac_encoder_settings* settings) {
    const sac_input_mesh mesh = InputOf(clip.mesh);
    sac_encoder* encoder = nullptr;
    status = sac_encoder_open(&encoder, &mesh, settings);
    const auto take = [&] {
      const std::uint8_t* data = nullptr;
      std::size_t size = 0;
      if (status == SAC_OK) status = sac_encoder_take(encoder, &data, &size);
      bytes.insert(bytes.end(), data, data + size);
    };
    for (const Positions& frame : clip.frames) {
      if (status == SAC_OK) status = sac_encoder_send(encoder, frame[0].data(), 0);
      take();
    }
    if (status == SAC_OK) status = sac_encoder_finish(encoder);
    take();
    message = sac_encoder_message(encoder);
    sac_encoder_close(encoder);
  }
};

TEST(CEncoder, GivesTheBytesOfTheCxxEncoder) {
  const Clip clip = BendingClip(kFrames);
  const sac_encoder_settings settings = Settings();
  const CEncoding encoding(clip, &settings);
  EXPECT_EQ(encoding.status, SAC_OK) << encoding.message;
  EXPECT_EQ(encoding.message, "");
  EXPECT_EQ(encoding.bytes, Encode(clip, SameSettings()).bytes);
  EXPECT_EQ(CEncoding(clip, nullptr).bytes, Encode(clip, {}).bytes);
}

TEST(CEncoder, PassesEachSettingOn) {
  const Clip clip = BendingClip(kFrames);
  struct Change {
    std::function<void(sac_encoder_settings&)> c;
    std::function<void(EncoderSettings&)> cxx;
  };
  const std::vector<Change> changes = {
      {[](auto& s) { s.quality = 70; }, [](auto& s) { s.quality = 70; }},
      {[](auto& s) { s.max_error = 0.01; }, [](auto& s) { s.max_error = 0.01; }},
      {[](auto& s) { s.motion_step = 0.1; }, [](auto& s) { s.motion_step = 0.1; }},
      {[](auto& s) { s.displacement_step = 0.01; }, [](auto& s) { s.displacement_step = 0.01; }},
      {[](auto& s) { s.detail_step = 0.01; }, [](auto& s) { s.detail_step = 0.01; }},
      {[](auto& s) { s.position_bits = 9; }, [](auto& s) { s.position_bits = 9; }},
      {[](auto& s) { s.level_growth = 1.5; }, [](auto& s) { s.level_growth = 1.5; }},
      {[](auto& s) { s.harmonics = 9; }, [](auto& s) { s.harmonics = 9; }},
      {[](auto& s) { s.handles_per_harmonic = 0; }, [](auto& s) { s.handles_per_harmonic = 0; }},
      {[](auto& s) { s.group = 4; }, [](auto& s) { s.group = 4; }},
      {[](auto& s) { s.pyramid = 1; }, [](auto& s) { s.pyramid = 1; }},
      {[](auto& s) { s.low_delay = 1; }, [](auto& s) { s.low_delay = true; }},
      {[](auto& s) { s.reference_previous = 1; }, [](auto& s) { s.reference_shape = ReferenceShape::kPrevious; }},
      {[](auto& s) { s.frame_rate_numerator = 30; }, [](auto& s) { s.frame_rate_numerator = 30; }},
      {[](auto& s) { s.frame_rate_numerator = s.frame_rate_denominator = 7; },
       [](auto& s) { s.frame_rate_numerator = s.frame_rate_denominator = 7; }},
      {[](auto& s) { s.keep_order = 1; }, [](auto& s) { s.keep_order = true; }},
      {[](auto& s) { s.index = 0; }, [](auto& s) { s.index = false; }},
      {[](auto& s) { s.repeat_start = 1; }, [](auto& s) { s.repeat_start = 1; }},
      {[](auto& s) { s.offset[1] = 5.6e6; },
       [](auto& s) {
         s.offset = {0, 5.6e6, 0};
       }},
  };
  const std::vector<std::uint8_t> plain = Encode(clip, SameSettings()).bytes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(i);
    sac_encoder_settings c = Settings();
    EncoderSettings cxx = SameSettings();
    changes[i].c(c);
    changes[i].cxx(cxx);
    const std::vector<std::uint8_t> bytes = CEncoding(clip, &c).bytes;
    EXPECT_EQ(bytes, Encode(clip, cxx).bytes);
    EXPECT_NE(bytes, plain);
  }
}

TEST(CEncoder, TakesNormalsOfCorners) {
  const Mesh cube = HardCubeMesh();
  const Clip clip{cube, {cube.positions}};
  const std::vector<std::uint8_t> bytes = CEncoding(clip, nullptr).bytes;
  EXPECT_EQ(bytes, Encode(clip, {}).bytes);
  sac_decoder* decoder = nullptr;
  ASSERT_EQ(sac_decoder_open(&decoder, nullptr), SAC_OK);
  const float* normals = nullptr;
  const std::uint32_t* corners = nullptr;
  std::uint32_t count = 0;
  EXPECT_EQ(sac_decoder_corner_normals(decoder, &normals, &count, &corners), SAC_NEED_MORE_DATA);
  const std::uint8_t* data = bytes.data();
  for (std::size_t size = bytes.size(); size > 0 && sac_decoder_receive(decoder, nullptr, nullptr) != SAC_OK;) {
    ASSERT_EQ(sac_decoder_send(decoder, &data, &size), SAC_OK);
  }
  sac_mesh mesh;
  ASSERT_EQ(sac_decoder_mesh(decoder, &mesh), SAC_OK);
  EXPECT_EQ(mesh.normals, nullptr);  // of vertices there are none
  ASSERT_EQ(sac_decoder_corner_normals(decoder, &normals, &count, &corners), SAC_OK);
  EXPECT_EQ(count, 24u);
  const Mesh decoded = Decode(bytes).mesh;
  EXPECT_EQ(std::memcmp(normals, decoded.normals.data(), sizeof(Vec3f) * count), 0);
  EXPECT_EQ(std::memcmp(corners, decoded.normal_triangles.data(), sizeof(Triangle) * mesh.triangles), 0);
  EXPECT_EQ(sac_decoder_corner_normals(decoder, nullptr, &count, &corners), SAC_INVALID_ARGUMENT);
  sac_decoder_close(decoder);
}

TEST(CEncoder, TakesAttributesAndStrides) {
  Clip clip = BendingClip(2);
  clip.mesh.normals.assign(clip.mesh.positions.size(), {0, 0, 1});
  clip.mesh.colors.assign(clip.mesh.positions.size(), {1, 2, 3, 4});
  clip.mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  clip.mesh.uv_triangles.assign(clip.mesh.triangles.size(), {0, 1, 2});
  EXPECT_EQ(CEncoding(clip, nullptr).bytes, Encode(clip, {}).bytes);

  std::vector<float> wide(5 * clip.mesh.positions.size());
  for (std::size_t v = 0; v < clip.mesh.positions.size(); ++v) {
    std::memcpy(&wide[5 * v], clip.mesh.positions[v].data(), 12);
  }
  sac_input_mesh mesh = InputOf(clip.mesh);
  mesh.positions = wide.data();
  mesh.position_stride = 20;
  sac_encoder* encoder = nullptr;
  ASSERT_EQ(sac_encoder_open(&encoder, &mesh, nullptr), SAC_OK);
  EXPECT_EQ(sac_encoder_send(encoder, wide.data(), 20), SAC_OK);
  EXPECT_EQ(sac_encoder_send(encoder, wide.data(), 8), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_encoder_message(encoder)), "a stride of 8 bytes, a vertex has 12");
  EXPECT_EQ(sac_encoder_send(encoder, clip.frames[1][0].data(), 0), SAC_OK);  // goes on
  EXPECT_EQ(sac_encoder_finish(encoder), SAC_OK);
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(sac_encoder_take(encoder, &data, &size), SAC_OK);
  EXPECT_EQ(std::vector<std::uint8_t>(data, data + size), Encode(clip, {}).bytes);
  sac_stream_bytes parts;
  ASSERT_EQ(sac_encoder_stream_bytes(encoder, &parts), SAC_OK);
  EXPECT_EQ(
      parts.header + parts.i_frame + parts.motion + parts.displacement + parts.detail + parts.correction + parts.side,
      static_cast<double>(size));
  const std::uint32_t* order = nullptr;
  ASSERT_EQ(sac_encoder_order(encoder, &order), SAC_OK);
  EXPECT_EQ(std::vector<std::uint32_t>(order, order + mesh.vertices), Encode(clip, {}).order);
  sac_encoder_close(encoder);
}

TEST(CEncoder, RefusesWhatCannotBeCoded) {
  const Clip clip = BendingClip(1);
  const auto message_of = [&](const std::function<void(sac_encoder_settings&)>& change, sac_status status) {
    sac_encoder_settings settings = Settings();
    change(settings);
    const CEncoding encoding(clip, &settings);
    EXPECT_EQ(encoding.status, status);
    return encoding.message;
  };
  EXPECT_EQ(message_of([](auto& s) { s.quality = 101; }, SAC_INVALID_ARGUMENT), "quality must be from 0 to 100");
  EXPECT_EQ(message_of([](auto& s) { s.group = 0; }, SAC_INVALID_ARGUMENT), "a group holds from 1 to 4096 frames");
  EXPECT_EQ(message_of([](auto& s) { s.struct_size = 8; }, SAC_INVALID_ARGUMENT),
            "settings that sac_encoder_settings_init() has not set");
  EXPECT_EQ(message_of([](auto& s) { s.struct_size += 8; }, SAC_UNSUPPORTED), "settings of a later library");
  EXPECT_EQ(message_of([](auto& s) { s.target_kg = 1; }, SAC_INVALID_ARGUMENT),
            "targets take the whole clip: call sac_encode_clip()");
  EXPECT_NE(message_of([](auto& s) { s.max_memory = 100000; }, SAC_LIMIT), "");

  Clip broken = clip;
  broken.mesh.triangles[0][1] = 80;
  EXPECT_EQ(CEncoding(broken, nullptr).status, SAC_INVALID_ARGUMENT);
  EXPECT_EQ(CEncoding(broken, nullptr).message, "a triangle of a missing vertex");
}

TEST(CEncoder, NullsAreErrorsAtMost) {
  const Clip clip = BendingClip(1);
  const sac_input_mesh mesh = InputOf(clip.mesh);
  sac_encoder_settings_init(nullptr);
  EXPECT_EQ(sac_encoder_open(nullptr, &mesh, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_send(nullptr, nullptr, 0), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_finish(nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_take(nullptr, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_order(nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_stream_bytes(nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_encoder_message(nullptr)), "no encoder");
  sac_encoder_close(nullptr);

  sac_encoder* encoder = nullptr;
  EXPECT_EQ(sac_encoder_open(&encoder, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_encoder_message(encoder)), "mesh: a null pointer");
  EXPECT_EQ(sac_encoder_send(encoder, clip.frames[0][0].data(), 0), SAC_INVALID_ARGUMENT);
  sac_encoder_close(encoder);
  for (const auto& change : std::vector<std::function<void(sac_input_mesh&)>>{
           [](auto& m) { m.positions = nullptr; }, [](auto& m) { m.triangle_vertices = nullptr; },
           [](auto& m) { m.uvs = 3; }, [](auto& m) { m.triangle_uvs = m.triangle_vertices; }}) {
    sac_input_mesh changed = mesh;
    change(changed);
    EXPECT_EQ(sac_encoder_open(&encoder, &changed, nullptr), SAC_INVALID_ARGUMENT);
    EXPECT_NE(std::string(sac_encoder_message(encoder)), "");
    sac_encoder_close(encoder);
  }
  ASSERT_EQ(sac_encoder_open(&encoder, &mesh, nullptr), SAC_OK);
  EXPECT_EQ(sac_encoder_send(encoder, nullptr, 0), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encoder_take(encoder, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  sac_encoder_close(encoder);
}

TEST(CEncoder, CanBeCancelledAnywhere) {
  const Clip clip = BendingClip(kFrames);
  struct Countdown {
    int left, calls;
  };
  const auto progress = [](void* user, std::uint32_t trial, std::uint32_t) {
    EXPECT_EQ(trial, 0u);
    auto& c = *static_cast<Countdown*>(user);
    ++c.calls;
    return c.left-- > 0 ? 0 : 1;
  };
  sac_encoder_settings settings = Settings();
  settings.threads = 1;  // so that it is called after each frame
  settings.progress = progress;
  Countdown all{1000, 0};
  settings.user = &all;
  EXPECT_EQ(CEncoding(clip, &settings).status, SAC_OK);
  EXPECT_GE(all.calls, static_cast<int>(kFrames));
  for (int calls = 0; calls < all.calls; ++calls) {
    Countdown some{calls, 0};
    settings.user = &some;
    const CEncoding encoding(clip, &settings);
    EXPECT_EQ(encoding.status, SAC_CANCELLED);
    EXPECT_EQ(encoding.message, "cancelled");
    EXPECT_EQ(some.calls, calls + 1);
  }
}

// A clip that sac_encode_clip() reads.
struct Source {
  const Clip& clip;
  std::size_t next = 0;
  std::size_t fail_at = 1000000;
  int rewinds = 0;

  sac_frame_source Functions() {
    const auto read = [](void* user, float* positions, int* end) {
      auto& s = *static_cast<Source*>(user);
      if (s.next == s.fail_at) return 1;
      *end = s.next == s.clip.frames.size() ? 1 : 0;
      if (*end == 0) std::memcpy(positions, s.clip.frames[s.next++][0].data(), 12 * s.clip.mesh.positions.size());
      return 0;
    };
    const auto rewind = [](void* user) {
      auto& s = *static_cast<Source*>(user);
      s.next = 0;
      ++s.rewinds;
      return 0;
    };
    return {this, read, rewind};
  }
};

int Append(void* user, const std::uint8_t* data, std::size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(user);
  bytes.insert(bytes.end(), data, data + size);
  return 0;
}

TEST(EncodeClipInC, EncodesAndMeasures) {
  const Clip clip = BendingClip(kFrames);
  const sac_input_mesh mesh = InputOf(clip.mesh);
  sac_encoder_settings settings = Settings();
  EXPECT_EQ(settings.reference_rounds, -1);
  settings.reference_rounds = 0;
  Source source{clip};
  const sac_frame_source functions = source.Functions();
  std::vector<std::uint8_t> bytes;
  sac_clip_result result;
  ASSERT_EQ(sac_encode_clip(&mesh, &functions, &settings, Append, &bytes, &result), SAC_OK) << result.message;
  EXPECT_EQ(bytes, Encode(clip, SameSettings()).bytes);
  EXPECT_EQ(result.bytes, bytes.size());
  EXPECT_EQ(result.frames, kFrames);
  EXPECT_EQ(result.trials, 0u);
  EXPECT_GT(result.kg, 0);
  EXPECT_GT(result.sted, 0);
  EXPECT_GT(result.max_error, 0);
  EXPECT_EQ(result.bpvf, 8.0 * static_cast<double>(bytes.size()) / (mesh.vertices * kFrames));

  settings.reference_rounds = 1;
  bytes.clear();
  std::vector<std::uint32_t> order(mesh.vertices);
  sac_clip_details details = {};
  details.order = order.data();
  ASSERT_EQ(sac_encode_clip_details(&mesh, &functions, &settings, Append, &bytes, &result, &details), SAC_OK);
  EXPECT_EQ(result.trials, 2u);
  EXPECT_EQ(result.bytes, bytes.size());
  EXPECT_GT(details.sted_temporal, 0);
  EXPECT_EQ(details.lost_texture_coordinates + details.lost_normals, 0u);
  const auto decoded = Decode(bytes).frames;
  ASSERT_EQ(decoded.size(), kFrames);
  for (std::size_t v = 0; v < order.size(); ++v) {
    const Vec3f &a = clip.frames[3][order[v]], &b = decoded[3].positions[v];
    EXPECT_LE(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 1.0001 * result.max_error);
  }
}

TEST(EncodeClipInC, SearchesTargetsAndCanBeCancelledInBetween) {
  const Clip clip = BendingClip(kFrames);
  const sac_input_mesh mesh = InputOf(clip.mesh);
  sac_encoder_settings settings = Settings();
  settings.target_kg = 2;
  Source source{clip};
  const sac_frame_source functions = source.Functions();
  std::vector<std::uint8_t> bytes;
  sac_clip_result result;
  ASSERT_EQ(sac_encode_clip(&mesh, &functions, &settings, Append, &bytes, &result), SAC_OK) << result.message;
  EXPECT_LE(result.kg, 2);
  EXPECT_GT(result.trials, 0u);
  EXPECT_EQ(source.rewinds, static_cast<int>(result.trials) + 1);

  settings.progress = [](void*, std::uint32_t trial, std::uint32_t) { return trial == 2 ? 1 : 0; };
  bytes.clear();
  EXPECT_EQ(sac_encode_clip(&mesh, &functions, &settings, Append, &bytes, &result), SAC_CANCELLED);
  EXPECT_EQ(std::string(result.message), "cancelled");
  EXPECT_TRUE(bytes.empty());
}

TEST(EncodeClipInC, TellsWhatWentWrong) {
  const Clip clip = BendingClip(kFrames);
  const sac_input_mesh mesh = InputOf(clip.mesh);
  Source source{clip};
  source.fail_at = 3;
  const sac_frame_source functions = source.Functions();
  std::vector<std::uint8_t> bytes;
  sac_clip_result result;
  EXPECT_EQ(sac_encode_clip(&mesh, &functions, nullptr, Append, &bytes, &result), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(result.message), "the source ended it");
  EXPECT_EQ(sac_encode_clip(&mesh, nullptr, nullptr, Append, &bytes, &result), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_encode_clip(&mesh, &functions, nullptr, nullptr, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  source.fail_at = 1000000;
  const auto refuse = [](void*, const std::uint8_t*, std::size_t) { return 1; };
  EXPECT_EQ(sac_encode_clip(&mesh, &functions, nullptr, refuse, nullptr, &result), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(result.message), "the sink ended it");
}

}  // namespace
}  // namespace sac
