// SPDX-License-Identifier: Apache-2.0
// Alembic files as the input and the output of the codec, and those that other programs have written.
#include "files/alembic/alembic_clip.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "files/clip_output.h"
#include "tests/files/alembic_files.h"
#include "tests/files/clip_files.h"
#include "tests/hard_cube.h"

namespace sac {
namespace {

class AlembicClipTest : public ClipFileTest {
 protected:
  std::string WriteClip(const std::string& name, const Mesh& mesh, const std::vector<Positions>& frames,
                        const ClipOutput::Settings& settings, std::int64_t first_number = 0) {
    std::unique_ptr<ClipOutput> output;
    const std::string path = directory_.Path(name);
    Status status = ClipOutput::Open(path, mesh, settings, output);
    for (std::size_t f = 0; status.ok() && f < frames.size(); ++f) {
      status = output->Write(first_number + static_cast<std::int64_t>(f), frames[f]);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
    if (status.ok()) status = output->Commit();
    EXPECT_TRUE(status.ok()) << status.message();
    return path;
  }

  static ClipOutput::Settings Rate(double fps) {
    ClipOutput::Settings settings;
    settings.fps = fps;
    return settings;
  }

  static std::vector<Positions> ReadFrames(ClipInput& input) {
    std::vector<Positions> frames;
    for (bool end = false; !end;) {
      Positions frame;
      const Status status = input.Next(frame, end);
      EXPECT_TRUE(status.ok()) << status.message();
      if (!status.ok()) break;
      if (!end) frames.push_back(frame);
    }
    return frames;
  }

  // A file that another program has written; skips the test where these files are not there.
  static std::string Foreign(const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(SAC_FOREIGN_FILES) / "abc" / name;
    return std::filesystem::exists(path) ? path.string() : "";
  }
};

TEST_F(AlembicClipTest, WhatIsWrittenIsRead) {
  Mesh mesh = HardCubeMesh();
  mesh.uvs = {{0, 0}, {0.5F, 1}, {1, 0.25F}};
  mesh.uv_triangles.assign(mesh.triangles.size(), {0, 1, 2});
  for (std::uint8_t v = 0; v < mesh.positions.size(); ++v) mesh.colors.push_back({v, 100, 200, 255});
  std::vector<Positions> frames(5, mesh.positions);
  for (std::size_t f = 1; f < frames.size(); ++f) frames[f][0][0] += static_cast<float>(f);
  frames[3] = frames[2];
  const std::string path = WriteClip("cube.abc", mesh, frames, Rate(30), 10);
  const auto input = Open({path});
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->rate().per_second(), 30);
  EXPECT_EQ(input->frame_count(), 5U);
  EXPECT_EQ(input->mesh().triangles, mesh.triangles);
  EXPECT_EQ(input->mesh().uvs, mesh.uvs);
  EXPECT_EQ(input->mesh().uv_triangles, mesh.uv_triangles);
  EXPECT_EQ(input->mesh().colors, mesh.colors);
  EXPECT_EQ(ReadFrames(*input), frames);
  ASSERT_EQ(input->warnings().size(), 1U);
  EXPECT_EQ(Short(input->warnings()[0]), "cube.abc: its first time 0.333333 s is not kept; frames begin at 0 s");
  // Each corner has the normal that it had.
  const Mesh& read = input->mesh();
  ASSERT_EQ(read.normal_triangles.size(), mesh.normal_triangles.size());
  for (std::size_t j = 0; j < read.normal_triangles.size(); ++j) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(read.normals[read.normal_triangles[j][k]], mesh.normals[mesh.normal_triangles[j][k]]);
    }
  }
}

TEST_F(AlembicClipTest, AStillClipHasOneStoredFrame) {
  const Mesh mesh = HardCubeMesh();
  const std::string one = WriteClip("one.abc", mesh, {mesh.positions}, {});
  const std::string many = WriteClip("many.abc", mesh, std::vector<Positions>(300, mesh.positions), {});
  EXPECT_LT(std::filesystem::file_size(many), std::filesystem::file_size(one) + 64);
  EXPECT_EQ(ReadFrames(*Open({many})).size(), 300U);
}

TEST_F(AlembicClipTest, TheOffsetIsExact) {
  const Mesh mesh = HardCubeMesh();
  const Vec3d offset = {1e7 + 0.125, -3e6, 0.1};
  ClipOutput::Settings settings;
  settings.offset = offset;
  const std::string path = WriteClip("far.abc", mesh, {mesh.positions}, settings);
  std::unique_ptr<SceneReader> reader;
  ASSERT_TRUE(OpenAlembicClip(path, {}, reader).ok());
  MeshFile file;
  ASSERT_TRUE(reader->ReadMesh(0, file).ok());
  ASSERT_EQ(file.exact.size(), mesh.positions.size());
  for (std::size_t v = 0; v < file.exact.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(file.exact[v][a], offset[a] + static_cast<double>(mesh.positions[v][a]));
    }
  }
}

TEST_F(AlembicClipTest, RateOfTheInput) {
  const Mesh mesh = HardCubeMesh();
  std::vector<Positions> frames(5, mesh.positions);
  frames[2][0][0] += 1;
  const std::string path = WriteClip("cube.abc", mesh, frames, Rate(24));
  ClipInputSettings settings;
  settings.rate = {48, 1};
  EXPECT_EQ(ReadFrames(*Open({path}, settings)).size(), 9U);
  settings.rate = {12, 1};
  EXPECT_EQ(ReadFrames(*Open({path}, settings)).size(), 3U);
}

TEST_F(AlembicClipTest, APipeIsRefused) {
  std::unique_ptr<ClipOutput> output;
  EXPECT_EQ(ClipOutput::Open("/dev/null", HardCubeMesh(), {}, output).code(), StatusCode::kInvalidArgument);
  std::filesystem::create_symlink("/dev/null", directory_.Path("null.abc"));
  EXPECT_EQ(Short(ClipOutput::Open(directory_.Path("null.abc"), HardCubeMesh(), {}, output).message()),
            "null.abc: an Alembic file cannot be written to a pipe or a device");
}

// Figures that Alembic's own tools show of these files; facts of their makers' names.
TEST_F(AlembicClipTest, FilesOfOtherPrograms) {
  struct Expected {
    std::string name;
    std::size_t frames, vertices, triangles;
    double fps;
  };
  bool any = false;
  for (const Expected& e : {Expected{"bone_anim.abc", 400, 754, 1504, 24},
                            {"deformingSubdTest.abc", 120, 98, 192, 24},
                            {"cubes_coloured.abc", 1, 24, 36, 0},
                            {"mesh_static_visibilityAnim_15_24fps.abc", 15, 4, 2, 24},
                            {"triangleRigged_asymetricalVertexTransform_24fps_2f.abc", 3, 3, 1, 24},
                            {"twoTris_twoFaceSets_1f_24fps.abc", 1, 4, 2, 0}}) {
    const std::string path = Foreign(e.name);
    if (path.empty()) continue;
    any = true;
    const auto input = Open({path});
    ASSERT_NE(input, nullptr);
    EXPECT_EQ(ReadFrames(*input).size(), e.frames) << e.name;
    EXPECT_EQ(input->mesh().positions.size(), e.vertices) << e.name;
    EXPECT_EQ(input->mesh().triangles.size(), e.triangles) << e.name;
    EXPECT_EQ(input->rate().per_second(), e.fps) << e.name;
  }
  for (const auto& [name, message] : {std::pair<std::string, std::string>{"cube.abc", "Alembic in HDF5"},
                                      {"emptymesh.abc", "no meshes with vertices"},
                                      {"singleCurve.abc", "no meshes with vertices; it has user properties"}}) {
    const std::string path = Foreign(name);
    if (path.empty()) continue;
    std::unique_ptr<ClipInput> input;
    EXPECT_TRUE(ClipInput::Open({path}, input).message().starts_with(path + ": " + message)) << name;
  }
  if (!any) GTEST_SKIP() << "no files of other programs";
}

TEST_F(AlembicClipTest, BoundsThatOtherProgramsWroteHold) {
  const std::string path = Foreign("bone_anim.abc");
  if (path.empty()) GTEST_SKIP() << "no files of other programs";
  // Maya has written the box of each frame beside its points: a second account of where these are.
  RandomAccess bytes;
  ASSERT_TRUE(bytes.Open(path).ok());
  AlembicArchive archive;
  ASSERT_TRUE(AlembicArchive::Open(std::move(bytes), archive).ok());
  const AlembicProperty* bounds = archive.top().properties.Find(".childBnds");
  ASSERT_NE(bounds, nullptr);
  AlembicSamples boxes;
  ASSERT_TRUE(AlembicSamples::Open(archive, *bounds, boxes).ok());
  const auto input = Open({path});
  const std::vector<Positions> frames = ReadFrames(*input);
  ASSERT_EQ(frames.size(), boxes.size());
  for (std::uint32_t f = 0; f < frames.size(); ++f) {
    std::vector<double> box;
    ASSERT_TRUE(boxes.Read(f, box).ok());
    for (std::size_t a = 0; a < 3; ++a) {
      double low = 1e9, high = -1e9;
      for (const Vec3f& p : frames[f]) {
        low = std::min(low, input->offset()[a] + static_cast<double>(p[a]));
        high = std::max(high, input->offset()[a] + static_cast<double>(p[a]));
      }
      EXPECT_NEAR(low, box[a], 1e-6) << "frame " << f;
      EXPECT_NEAR(high, box[3 + a], 1e-6) << "frame " << f;
    }
  }
}

}  // namespace
}  // namespace sac
