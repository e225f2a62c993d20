// SPDX-License-Identifier: Apache-2.0
#include "files/clip_output.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "files/clip_input.h"
#include "files/mesh_file.h"
#include "tests/hard_cube.h"
#include "tests/test_directory.h"

namespace sac {
namespace {

// While it lives a file cannot grow beyond `bytes`; the write fails with EFBIG, much as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class ClipOutputTest : public testing::Test {
 protected:
  ClipOutputTest() {
    mesh_.positions = Positions(3);
    mesh_.triangles = {{0, 1, 2}, {0, 0, 1}};
    mesh_.uvs = {{0, 0}, {1, 0}};
    mesh_.uv_triangles = {{0, 1, 0}, {1, 1, 0}};
    mesh_.colors = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 0, 1, 2}};
  }

  static Positions Frame(float x) { return {{x, 0, 0}, {0, x, 0}, {0, 0, 1 / x}}; }

  TestDirectory directory_;
  Mesh mesh_;
  std::unique_ptr<ClipOutput> output_;
};

TEST_F(ClipOutputTest, CacheWithItsMesh) {
  for (const std::string name : {"a.pc2", "b.mdd"}) {
    const std::string path = directory_.Path(name), obj = directory_.Path(name.substr(0, 1) + ".obj");
    ASSERT_TRUE(ClipOutput::Open(path, mesh_, {30, std::nullopt}, output_).ok());
    ASSERT_TRUE(output_->Write(5, Frame(3)).ok());
    ASSERT_TRUE(output_->Write(6, Frame(7)).ok());
    EXPECT_FALSE(std::filesystem::exists(path) || std::filesystem::exists(obj));
    ASSERT_TRUE(output_->Commit().ok());
    std::unique_ptr<ClipInput> input;
    ASSERT_TRUE(ClipInput::Open({obj, path}, input).ok());
    EXPECT_EQ(input->frame_count(), 2U);
    Mesh mesh;
    ASSERT_TRUE(ReadMesh(obj, mesh).ok());
    EXPECT_EQ(mesh.positions, Frame(3));
    EXPECT_EQ(mesh.triangles, mesh_.triangles);
    EXPECT_EQ(mesh.uv_triangles, mesh_.uv_triangles);
    EXPECT_EQ(mesh.colors, mesh_.colors);
  }
  EXPECT_EQ(directory_.FileCount(), 4U);
}

TEST_F(ClipOutputTest, SequenceIsNumberedByFrames) {
  for (const std::string extension : {"obj", "ply", "off"}) {
    ASSERT_TRUE(ClipOutput::Open(directory_.Path("x_%04d." + extension), mesh_, {}, output_).ok());
    ASSERT_TRUE(output_->Write(9, Frame(3)).ok());
    ASSERT_TRUE(output_->Write(10, Frame(7)).ok());
    ASSERT_TRUE(output_->Commit().ok());
    Mesh mesh;
    ASSERT_TRUE(ReadMesh(directory_.Path("x_0009." + extension), mesh).ok());
    EXPECT_EQ(mesh.positions, Frame(3));
    ASSERT_TRUE(ReadMesh(directory_.Path("x_0010." + extension), mesh).ok());
    EXPECT_EQ(mesh.positions, Frame(7));
    EXPECT_EQ(mesh.triangles, mesh_.triangles);
  }
  EXPECT_EQ(directory_.FileCount(), 6U);
}

TEST_F(ClipOutputTest, NormalsAreThoseOfEachFrame) {
  mesh_.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh_.triangles = {{0, 1, 2}};
  mesh_.uvs.clear();
  mesh_.uv_triangles.clear();
  mesh_.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const Positions turned = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const std::string extension : {"obj", "ply", "off"}) {
    ASSERT_TRUE(ClipOutput::Open(directory_.Path("x_%d." + extension), mesh_, {}, output_).ok());
    ASSERT_TRUE(output_->Write(0, mesh_.positions).ok());
    ASSERT_TRUE(output_->Write(1, turned).ok());
    ASSERT_TRUE(output_->Commit().ok());
    Mesh mesh;
    ASSERT_TRUE(ReadMesh(directory_.Path("x_0." + extension), mesh).ok());
    EXPECT_EQ(mesh.normals, mesh_.normals);
    ASSERT_TRUE(ReadMesh(directory_.Path("x_1." + extension), mesh).ok());
    EXPECT_EQ(mesh.normals, (std::vector<Vec3f>(3, {1, 0, 0}))) << extension;
  }
  // Beside a cache stands the first frame written.
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("c.pc2"), mesh_, {}, output_).ok());
  ASSERT_TRUE(output_->Write(1, turned).ok());
  ASSERT_TRUE(output_->Write(2, mesh_.positions).ok());
  ASSERT_TRUE(output_->Commit().ok());
  Mesh mesh;
  ASSERT_TRUE(ReadMesh(directory_.Path("c.obj"), mesh).ok());
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>(3, {1, 0, 0})));
}

TEST_F(ClipOutputTest, WarnsOnceOfNormalsThatFilesCannotHold) {
  const Mesh cube = HardCubeMesh();
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("x_%d.ply"), cube, {}, output_).ok());
  for (int t = 0; t < 3; ++t) ASSERT_TRUE(output_->Write(static_cast<std::uint64_t>(t), cube.positions).ok());
  ASSERT_EQ(output_->warnings().size(), 1U);
  EXPECT_EQ(output_->warnings()[0].rfind(directory_.Path("x_0.ply") + ": ", 0), 0U);
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("x_%d.obj"), cube, {}, output_).ok());
  ASSERT_TRUE(output_->Write(0, cube.positions).ok());
  EXPECT_TRUE(output_->warnings().empty());
}

TEST_F(ClipOutputTest, CachesRoundTheSumWithAnOffset) {
  ClipOutput::Settings settings;
  settings.offset = {5600000, 0, 0};
  for (const double precision : {0.01, 1.0}) {
    settings.precision = precision;
    ASSERT_TRUE(ClipOutput::Open(directory_.Path("a.pc2"), mesh_, settings, output_).ok());
    ASSERT_TRUE(output_->Write(0, Frame(0.2F)).ok());
    ASSERT_TRUE(output_->Commit().ok());
    std::unique_ptr<CacheReader> reader;
    Positions positions;
    ASSERT_TRUE(CacheReader::Open(directory_.Path("a.pc2"), reader).ok());
    ASSERT_TRUE(reader->Read(0, positions).ok());
    EXPECT_EQ(positions, (Positions{{5600000, 0, 0}, {5600000, 0.2F, 0}, {5600000, 0, 5}}));
    EXPECT_EQ(output_->warnings(),
              precision == 1.0 ? Warnings{}
                               : Warnings{directory_.Path("a.pc2") +
                                          ": the format's 32-bit floats round the coordinates by up to 0.2; meshes "
                                          "(.obj, .ply, .off) hold them exactly"});
    EXPECT_NE(directory_.Read("a.obj").find("v 5600000.200000003 0 0 "), std::string::npos);
  }
  settings.offset = {0, 1e39, 0};
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("b.mdd"), mesh_, settings, output_).ok());
  EXPECT_EQ(output_->Write(3, Frame(1)).message(),
            directory_.Path("b.mdd") +
                ": frame 3: vertex 0 is beyond the range of the format's 32-bit floats; meshes "
                "(.obj) hold it");
}

TEST_F(ClipOutputTest, NothingStaysWithoutCommit) {
  directory_.Write("a.obj", "before");
  for (const std::string name : {"a.pc2", "a.mdd", "x_%d.ply", "a.obj"}) {
    ClipOutput::Settings settings;
    settings.force = true;
    ASSERT_TRUE(ClipOutput::Open(directory_.Path(name), mesh_, settings, output_).ok());
    ASSERT_TRUE(output_->Write(0, Frame(1)).ok());
    EXPECT_GT(directory_.FileCount(), 1U);
    output_.reset();
    EXPECT_EQ(directory_.FileCount(), 1U) << name;
    EXPECT_EQ(directory_.Read("a.obj"), "before");
  }
}

TEST_F(ClipOutputTest, Errors) {
  const auto open = [&](const std::string& name) {
    const std::string message = ClipOutput::Open(directory_.Path(name), mesh_, {}, output_).message();
    return message.empty() ? "" : message.substr(directory_.Path("").size());
  };
  EXPECT_EQ(
      open("a.txt"),
      "a.txt: not a clip by its name (.pc2, .mdd, .abc, .glb, .gltf, .usda, .vat, or a pattern of .obj, .ply or .off)");
  EXPECT_EQ(
      open("-"),
      "-: not a clip by its name (.pc2, .mdd, .abc, .glb, .gltf, .usda, .vat, or a pattern of .obj, .ply or .off)");
  EXPECT_EQ(open("%d%d.obj"), "%d%d.obj: more than one frame number");
  EXPECT_EQ(open("none/a.pc2"), "none/a.pc2: No such file or directory");
  ASSERT_EQ(open("a.pc2"), "");
  EXPECT_EQ(output_->Commit().message(), directory_.Path("a.pc2") + ": no frames");
  EXPECT_EQ(output_->Write(0, Positions(2)).message(), directory_.Path("a.pc2") + ": a frame of 2 vertices, not 3");
  ASSERT_EQ(open("a.obj"), "");
  ASSERT_TRUE(output_->Write(0, Frame(1)).ok());
  EXPECT_EQ(output_->Write(1, Frame(2)).code(), StatusCode::kInvalidArgument);
  ASSERT_EQ(open("none/%d.obj"), "");
  EXPECT_EQ(output_->Write(3, Frame(1)).message(), directory_.Path("none/3.obj") + ": No such file or directory");
}

TEST_F(ClipOutputTest, AFullDiskIsOneErrorAndLeavesNothing) {
  mesh_.positions.resize(10000);
  mesh_.colors.clear();
  for (const std::string name : {"a.pc2", "a.mdd", "x_%d.ply"}) {
    ASSERT_TRUE(ClipOutput::Open(directory_.Path(name), mesh_, {}, output_).ok());
    Status status;
    {
      const FileSizeLimit limit(100000);
      status = output_->Write(0, Positions(10000));
    }
    EXPECT_EQ(status.code(), StatusCode::kIoError) << name;
    EXPECT_NE(status.message().find(": File too large"), std::string::npos) << status.message();
    EXPECT_EQ(status.message().find(directory_.Path("")), 0U);
    output_.reset();
    EXPECT_EQ(directory_.FileCount(), 0U);
  }
}

TEST(OutputFileTest, AppearsWithCommitAndKeepsTheMode) {
  const TestDirectory directory;
  const std::string path = directory.Write("target", "old");
  chmod(path.c_str(), 0640);
  std::filesystem::create_symlink("target", directory.Path("link"));
  OutputFile file;
  ASSERT_TRUE(file.Open(directory.Path("link")).ok());
  ASSERT_TRUE(file.Write(std::string(200000, 'x')).ok());
  ASSERT_TRUE(file.Write("end").ok());
  ASSERT_TRUE(file.WriteAt(1, "yz", 2).ok());
  char back[3] = {};
  ASSERT_TRUE(file.ReadAt(200000, back, 3).ok());
  EXPECT_EQ(std::string(back, 3), "end");
  EXPECT_EQ(directory.Read("target"), "old");
  ASSERT_TRUE(file.Commit().ok());
  EXPECT_EQ(directory.Read("target"), "xyz" + std::string(199997, 'x') + "end");
  EXPECT_TRUE(std::filesystem::is_symlink(directory.Path("link")));
  struct stat info {};
  stat(path.c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0640U);
  EXPECT_EQ(directory.FileCount(), 2U);
}

TEST(OutputFileTest, MovedFilesKeepTheirTemporary) {
  const TestDirectory directory;
  std::vector<OutputFile> files;
  for (int i = 0; i < 10; ++i) {
    OutputFile file;
    ASSERT_TRUE(file.Open(directory.Path(std::to_string(i))).ok());
    ASSERT_TRUE(file.Write("x").ok());
    files.push_back(std::move(file));
  }
  EXPECT_EQ(directory.FileCount(), 10U);
  ASSERT_TRUE(files[3].Commit().ok());
  files.clear();
  EXPECT_EQ(directory.FileCount(), 1U);
  EXPECT_EQ(directory.Read("3"), "x");
}

TEST(OutputFileTest, DevicesAreWrittenThrough) {
  OutputFile null;
  ASSERT_TRUE(null.Open("/dev/null").ok());
  EXPECT_FALSE(null.seekable());
  EXPECT_TRUE(null.Write("x").ok());
  EXPECT_TRUE(null.Commit().ok());
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  OutputFile full;
  ASSERT_TRUE(full.Open("/dev/full").ok());
  const Status status = full.Write("x");
  EXPECT_EQ(status.code(), StatusCode::kIoError);
  EXPECT_EQ(status.message(), "/dev/full: No space left on device");
}

TEST(OutputFileTest, StandardOutput) {
  testing::internal::CaptureStdout();
  {
    OutputFile file;
    ASSERT_TRUE(file.Open("-").ok());
    ASSERT_TRUE(file.Write("bytes").ok());
    ASSERT_TRUE(file.Commit().ok());
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "bytes");
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST(OutputFileTest, Errors) {
  const TestDirectory directory;
  EXPECT_EQ(OutputFile().Open(directory.Path("")).message(), directory.Path("") + ": Is a directory");
  OutputFile closed;
  ASSERT_TRUE(closed.Open(directory.Path("a")).ok());
  ASSERT_TRUE(closed.Close().ok());
  EXPECT_EQ(closed.Write("x").code(), StatusCode::kIoError);
}

}  // namespace
}  // namespace sac
