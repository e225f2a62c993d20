// SPDX-License-Identifier: Apache-2.0
// The decoder's C interface, against the C++ one.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "sac/sac.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

constexpr std::size_t kFrames = 12;

std::vector<std::uint8_t> Stream() {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = 5;
  settings.frame_rate_numerator = 10;
  settings.keep_order = true;
  return Encode(BendingClip(kFrames), settings).bytes;
}

struct Player {
  sac_decoder* decoder = nullptr;
  std::vector<float> memory;
  sac_frame_buffers buffers = {};
  std::vector<sac_frame_info> shown;
  std::vector<std::vector<float>> frames;

  explicit Player(const sac_settings* settings = nullptr) { EXPECT_EQ(sac_decoder_open(&decoder, settings), SAC_OK); }
  ~Player() { sac_decoder_close(decoder); }

  sac_status Play(const std::vector<std::uint8_t>& stream, std::size_t from, std::size_t chunk) {
    for (std::size_t at = from; at < stream.size(); at += chunk) {
      const std::uint8_t* data = stream.data() + at;
      std::size_t size = std::min(chunk, stream.size() - at);
      while (size > 0) {
        sac_status status = sac_decoder_send(decoder, &data, &size);
        if (status != SAC_OK) return status;
        sac_mesh mesh;
        if (memory.empty() && sac_decoder_mesh(decoder, &mesh) == SAC_OK) {
          memory.resize(3 * mesh.vertices);
          buffers.positions = {memory.data(), memory.size() * sizeof(float), 12, SAC_FLOAT32};
        }
        sac_frame_info info;
        while ((status = sac_decoder_receive(decoder, &buffers, &info)) == SAC_OK) {
          shown.push_back(info);
          frames.push_back(memory);
        }
        if (status != SAC_NEED_MORE_DATA) return status;
      }
    }
    return sac_decoder_finish(decoder);
  }
};

TEST(CApi, GivesWhatTheOtherGives) {
  const std::vector<std::uint8_t> stream = Stream();
  const Decoded whole = Decode(stream);
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{7}, std::size_t{4096}, stream.size()}) {
    Player player;
    ASSERT_NE(player.decoder, nullptr);
    ASSERT_EQ(player.Play(stream, 0, chunk), SAC_OK) << sac_decoder_message(player.decoder);
    ASSERT_EQ(player.frames.size(), kFrames);
    for (std::size_t t = 0; t < kFrames; ++t) {
      EXPECT_EQ(player.shown[t].index, t);
      EXPECT_DOUBLE_EQ(player.shown[t].time, t / 10.0);
      EXPECT_EQ(player.shown[t].intra != 0, whole.frames[t].intra);
      for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(player.shown[t].box_low[a], whole.frames[t].box.low[a]);
      EXPECT_EQ(
          std::memcmp(player.frames[t].data(), whole.frames[t].positions.data(), 12 * whole.mesh.positions.size()), 0);
    }
    sac_mesh mesh;
    ASSERT_EQ(sac_decoder_mesh(player.decoder, &mesh), SAC_OK);
    ASSERT_EQ(mesh.vertices, whole.mesh.positions.size());
    ASSERT_EQ(mesh.triangles, whole.mesh.triangles.size());
    EXPECT_EQ(std::memcmp(mesh.triangle_vertices, whole.mesh.triangles.data(), 12 * whole.mesh.triangles.size()), 0);
    EXPECT_EQ(mesh.uv_values, nullptr);
    ASSERT_NE(mesh.order, nullptr);
    EXPECT_EQ(mesh.order[5], whole.order[5]);
    EXPECT_EQ(mesh.frame_rate_numerator, 10u);
  }
}

TEST(CApi, SeeksAndInterpolates) {
  const std::vector<std::uint8_t> stream = Stream();
  const Decoded whole = Decode(stream);
  Player player;
  std::uint64_t byte = 0;
  EXPECT_EQ(sac_decoder_seek(player.decoder, 0, &byte), SAC_NEED_MORE_DATA);
  ASSERT_EQ(player.Play(stream, 0, stream.size()), SAC_OK);
  std::size_t needed = 0;
  EXPECT_EQ(sac_decoder_add_index(player.decoder, stream.data(), 0, &needed), SAC_NEED_MORE_DATA);
  EXPECT_EQ(needed, 8u);
  EXPECT_EQ(sac_decoder_add_index(player.decoder, stream.data(), stream.size(), &needed), SAC_OK);
  for (const double seconds : {0.7, 1.1, 0.0}) {
    player.shown.clear();
    ASSERT_EQ(sac_decoder_seek_time(player.decoder, seconds, &byte), SAC_OK);
    ASSERT_EQ(player.Play(stream, byte, stream.size()), SAC_OK);
    EXPECT_DOUBLE_EQ(player.shown.at(0).time, seconds);
  }
  EXPECT_EQ(sac_decoder_seek(player.decoder, kFrames, &byte), SAC_INVALID_ARGUMENT);
  EXPECT_NE(std::string(sac_decoder_message(player.decoder)), "");

  sac_frame_info info;
  ASSERT_EQ(sac_decoder_seek(player.decoder, 2, &byte), SAC_OK);
  const std::uint8_t* data = stream.data() + byte;
  std::size_t size = stream.size() - byte;
  sac_status status;
  while ((status = sac_decoder_interpolate(player.decoder, 2.5, &player.buffers, &info)) == SAC_NEED_MORE_DATA) {
    ASSERT_EQ(sac_decoder_send(player.decoder, &data, &size), SAC_OK);
  }
  ASSERT_EQ(status, SAC_OK);
  EXPECT_DOUBLE_EQ(info.time, 0.25);
}

TEST(CApi, SettingsCount) {
  const std::vector<std::uint8_t> stream = Stream();
  sac_settings settings;
  sac_settings_init(&settings);
  EXPECT_EQ(settings.struct_size, sizeof settings);
  settings.frame_step = 5;
  Player fraction(&settings);
  ASSERT_EQ(fraction.Play(stream, 0, 100), SAC_OK);
  EXPECT_EQ(fraction.frames.size(), 3u);

  sac_settings_init(&settings);
  settings.max_vertices = 10;
  Player small(&settings);
  EXPECT_EQ(small.Play(stream, 0, 100), SAC_LIMIT);
  EXPECT_NE(std::string(sac_decoder_message(small.decoder)).find("vertices"), std::string::npos);

  sac_settings_init(&settings);
  settings.max_frame_work = 1000;
  Player hurried(&settings);
  EXPECT_EQ(hurried.Play(stream, 0, 100), SAC_LIMIT);

  sac_settings_init(&settings);
  settings.skip_damage = 1;
  std::vector<std::uint8_t> damaged = stream;
  damaged[damaged.size() - 60] ^= 1;  // in the last group
  Player survivor(&settings);
  EXPECT_EQ(survivor.Play(damaged, 0, 100), SAC_OK);
  EXPECT_EQ(survivor.frames.size(), 10u);
  std::uint32_t first = 0, count = 0;
  ASSERT_EQ(sac_decoder_lost_count(survivor.decoder), 1u);
  ASSERT_EQ(sac_decoder_lost(survivor.decoder, 0, &first, &count), SAC_OK);
  EXPECT_EQ(first, 10u);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(sac_decoder_lost(survivor.decoder, 1, &first, &count), SAC_INVALID_ARGUMENT);

  sac_settings_init(&settings);
  settings.struct_size += 8;  // of a library to come
  sac_decoder* none = nullptr;
  EXPECT_EQ(sac_decoder_open(&none, &settings), SAC_UNSUPPORTED);
  settings.struct_size = 8;  // before there was one
  EXPECT_EQ(sac_decoder_open(&none, &settings), SAC_INVALID_ARGUMENT);
  sac_settings_init(&settings);
  settings.frame_step = 0;
  EXPECT_EQ(sac_decoder_open(&none, &settings), SAC_INVALID_ARGUMENT);
  sac_settings_init(&settings);
  settings.max_work = std::nan("");
  EXPECT_EQ(sac_decoder_open(&none, &settings), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_decoder_open(nullptr, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(none, nullptr);
}

TEST(CApi, TellsHowManyFramesThereAre) {
  const std::vector<std::uint8_t> stream = Stream();
  Player player;
  std::uint32_t frames = 0;
  EXPECT_EQ(sac_decoder_frames(player.decoder, &frames), SAC_NEED_MORE_DATA);
  EXPECT_EQ(player.Play(stream, 0, 100), SAC_OK);
  EXPECT_EQ(sac_decoder_frames(player.decoder, &frames), SAC_OK);
  EXPECT_EQ(frames, kFrames);
  EXPECT_EQ(sac_decoder_frames(player.decoder, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_STREQ(sac_decoder_message(player.decoder), "a null pointer");
}

TEST(CApi, NothingIsTakenForGranted) {
  std::size_t size = 3;
  const std::uint8_t* data = nullptr;
  EXPECT_EQ(sac_decoder_send(nullptr, &data, &size), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_decoder_receive(nullptr, nullptr, nullptr), SAC_INVALID_ARGUMENT);
  sac_decoder_close(nullptr);
  sac_decoder_reset(nullptr);
  Player player;
  EXPECT_EQ(sac_decoder_send(player.decoder, nullptr, &size), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_decoder_send(player.decoder, &data, &size), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(sac_decoder_receive(player.decoder, nullptr, nullptr), SAC_NEED_MORE_DATA);
  EXPECT_EQ(sac_decoder_mesh(player.decoder, nullptr), SAC_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(sac_version()).empty(), false);
  EXPECT_EQ(std::string(sac_stream_version()), std::to_string(kVersionMajor) + "." + std::to_string(kVersionMinor));
}

}  // namespace
}  // namespace sac
