// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_writer.h"

#include <gtest/gtest.h>

#include "files/clip_output.h"
#include "tests/files/clip_files.h"
#include "tests/hard_cube.h"

namespace sac {
namespace {

using Compression = ClipOutput::Compression;

class GltfWriterTest : public ClipFileTest {
 protected:
  // Writes three frames of a cube with hard edges, of which vertex 3 moves alone, and reads them back.
  std::vector<Positions> RoundTrip(const std::string& name, Compression compression, Warnings& told) {
    mesh_ = HardCubeMesh();
    std::unique_ptr<ClipOutput> output;
    ClipOutput::Settings settings;
    settings.compression = compression;
    EXPECT_TRUE(ClipOutput::Open(directory_.Path(name), mesh_, settings, output).ok());
    for (int f = 0; f < 3; ++f) EXPECT_TRUE(output->Write(f, Frame(f)).ok());
    told = output->warnings();
    EXPECT_TRUE(output->Commit().ok());
    const auto clip = Open({directory_.Path(name)});
    EXPECT_EQ(clip->rate().per_second(), 24);
    EXPECT_EQ(clip->mesh().triangles.size(), 12U);
    return Frames(*clip);
  }

  Positions Frame(int f) const {
    Positions frame = mesh_.positions;
    frame[3][2] += static_cast<float>(f);
    return frame;
  }

  Mesh mesh_;
};

TEST_F(GltfWriterTest, FramesComeBack) {
  for (const auto& [name, compression, bound] : {std::tuple{"a.glb", Compression::kNone, 1e-7F},
                                                 {"a.gltf", Compression::kNone, 1e-7F},
                                                 {"q.glb", Compression::kQuantized, 3.1F / 65532},
                                                 {"m.glb", Compression::kMeshopt, 3.1F / 65532}}) {
    Warnings told;
    const auto frames = RoundTrip(name, compression, told);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(Short(told[0]).find(std::string(name) + ": 16 vertices come twice"), 0U) << told[0];
    ASSERT_EQ(frames.size(), 3U);
    for (int f = 0; f < 3; ++f) {
      const Positions want = Frame(f);
      ASSERT_EQ(frames[f].size(), 24U);  // three of each, for its three faces
      for (std::size_t v = 0; v < want.size(); ++v) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(frames[f][v][k], want[v][k], bound) << name << " frame " << f;
      }
    }
  }
}

TEST_F(GltfWriterTest, NothingIsLeftWithoutCommit) {
  std::unique_ptr<ClipOutput> output;
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("a.glb"), HardCubeMesh(), {}, output).ok());
  EXPECT_FALSE(output->Commit().ok());
  output.reset();
  EXPECT_EQ(directory_.FileCount(), 0U);
}

}  // namespace
}  // namespace sac
