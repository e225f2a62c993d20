// SPDX-License-Identifier: Apache-2.0
// Malformed and hostile archives.
#include <gtest/gtest.h>

#include <random>

#include "files/alembic/alembic_clip.h"
#include "tests/files/alembic_files.h"

namespace sac {
namespace {

constexpr char kTranslate = 0x10;

std::string Error(const std::string& bytes, const AlembicLimits& limits = {}) {
  std::unique_ptr<AlembicScene> scene;
  if (std::string message = OpenScene(bytes, scene, {}, limits); !message.empty()) return message;
  PolygonMesh mesh;
  if (const Status status = scene->ReadMesh(0, mesh); !status.ok()) return status.message();
  for (std::uint32_t f = 0; f < scene->frame_count(); ++f) {
    if (const Status status = scene->ReadPositions(f, mesh); !status.ok()) return status.message();
  }
  return "";
}

std::string Whole() {
  AlembicFiles files;
  const std::uint32_t times = files.AddTimes(0.5, {0});
  return files.Write(
      {files.Xform("x", {kTranslate}, {{1, 2, 3}, {4, 5, 6}}, {files.Triangle("t", {0, 1}, times)}, times)});
}

// A mesh with a broken property.
std::string WithGeometry(const std::vector<std::uint32_t>& indices, const std::vector<std::uint32_t>& counts) {
  AlembicFiles files;
  return files.Write(
      {AlembicFiles::Object("m", "AbcGeom_PolyMesh_v1",
                            {AlembicFiles::Compound(".geom", {files.Floats("P", 3, {{0, 0, 0, 1, 0, 0, 0, 1, 0}}),
                                                              files.Ints(".faceIndices", {indices}),
                                                              files.Ints(".faceCounts", {counts})})})});
}

void Store64(std::size_t at, std::uint64_t value, std::string& bytes) { StoreLittle64(value, bytes.data() + at); }

TEST(AlembicErrorsTest, Header) {
  EXPECT_EQ(Error(""), "the file is empty");
  EXPECT_EQ(Error("not Alembic at all"), "not an Alembic file");
  EXPECT_EQ(Error("\x89HDF\r\n\x1a\n then more"),
            "Alembic in HDF5, the older of its two forms; convert it to Ogawa with Alembic's own program: abcconvert "
            "-toOgawa OLD.abc NEW.abc");
  std::string bytes = Whole();
  EXPECT_EQ(Error(bytes), "");
  EXPECT_EQ(Error(bytes.substr(0, 12)), "truncated in the header");
  bytes[5] = 0;
  EXPECT_EQ(Error(bytes), "the program that wrote it did not finish it");
  bytes[5] = '\xFF';
  bytes[7] = 2;
  EXPECT_EQ(Error(bytes), "Ogawa version 2");
}

TEST(AlembicErrorsTest, GroupsThatContainThemselves) {
  std::string bytes = Whole();
  const auto root = static_cast<std::size_t>(LoadLittle64(bytes.data() + 8));
  // The group of the top object becomes the root itself.
  Store64(root + 8 + 2 * 8, root, bytes);
  EXPECT_NE(Error(bytes), "");
  // An object of which each child is the object, 20 deep: half the file would be read over and over.
  AlembicFiles files;
  std::vector<AlembicObjectTree> children(50, AlembicFiles::Object("o", "", {}));
  bytes = files.Write({AlembicFiles::Object("parent", "", {}, children)});
  const auto group = static_cast<std::size_t>(LoadLittle64(bytes.data() + 8));
  const auto top = static_cast<std::size_t>(LoadLittle64(bytes.data() + group + 8 + 2 * 8));
  const auto parent = static_cast<std::size_t>(LoadLittle64(bytes.data() + top + 8 + 8));
  for (std::size_t i = 0; i < children.size(); ++i) Store64(parent + 8 + 8 * (1 + i), parent, bytes);
  EXPECT_EQ(Error(bytes), "groups that overlap or contain themselves");
}

TEST(AlembicErrorsTest, CountsBeyondTheFile) {
  std::string bytes = Whole();
  const auto root = static_cast<std::size_t>(LoadLittle64(bytes.data() + 8));
  Store64(root, std::uint64_t{1} << 60, bytes);
  EXPECT_EQ(Error(bytes), "a group of more children than the file can have");
  bytes = Whole();
  Store64(8, bytes.size() - 4, bytes);
  EXPECT_EQ(Error(bytes), "truncated, or an offset beyond its end");
  Store64(8, std::uint64_t{1} << 63 | 16, bytes);
  EXPECT_EQ(Error(bytes), "data in place of a group");
}

TEST(AlembicErrorsTest, Faces) {
  EXPECT_EQ(Error(WithGeometry({0, 1, 2}, {3})), "");
  EXPECT_EQ(Error(WithGeometry({0, 1, 3}, {3})), "/m: a face of vertex 3, but there are 3");
  EXPECT_EQ(Error(WithGeometry({0, 1, ~0U}, {3})), "/m: a face of vertex -1, but there are 3");
  EXPECT_EQ(Error(WithGeometry({0, 1, 2}, {4})), "/m: faces of more corners than there are");
  EXPECT_EQ(Error(WithGeometry({0, 1, 2}, {~0U, 4})), "/m: faces of more corners than there are");
  EXPECT_EQ(Error(WithGeometry({0, 1, 2}, {2})), "/m: faces of fewer corners than there are");
}

TEST(AlembicErrorsTest, Transforms) {
  const auto error = [](const std::vector<char>& operations, const std::vector<double>& numbers) {
    AlembicFiles files;
    return Error(files.Write({files.Xform("x", operations, {numbers}, {files.Triangle("t", {0})})}));
  };
  EXPECT_EQ(error({kTranslate}, {1, 2, 3}), "");
  EXPECT_EQ(error({kTranslate}, {1, 2}), "/x: a transform of 2 numbers, not 3");
  EXPECT_EQ(error({0x70}, {1}), "/x: an unknown operation of a transform");
  EXPECT_EQ(error({kTranslate}, {1, 2, std::numeric_limits<double>::infinity()}), "/x: a transform that is not finite");
}

TEST(AlembicErrorsTest, Times) {
  const auto error = [](double period, const std::vector<double>& times) {
    AlembicFiles files;
    const std::uint32_t index = files.AddTimes(period, times);
    return Error(files.Write({files.Triangle("t", {0, 1, 2}, index)}));
  };
  EXPECT_EQ(error(0, {0}), "its list of times has a period that is not positive, or shorter than its times");
  EXPECT_EQ(error(1, {0, 1}), "its list of times has a period that is not positive, or shorter than its times");
  EXPECT_EQ(error(1, {1, 0}), "its list of times has times that go back");
  EXPECT_EQ(error(1, {std::numeric_limits<double>::quiet_NaN()}), "its list of times has a time that is not finite");
  EXPECT_EQ(error(1, {}), "its list of times is cut short");
  EXPECT_EQ(error(AlembicFiles::kAcyclic, {0, 1e-9, 1e9}), "");
  EXPECT_EQ(error(1e300, {0}), "");
}

TEST(AlembicErrorsTest, Limits) {
  AlembicFiles files;
  const std::uint32_t slow = files.AddTimes(1e6, {0}), fast = files.AddTimes(1e-3, {0});
  const std::string long_clip = files.Write({files.Triangle("s", {0, 1}, slow), files.Triangle("f", {0, 1}, fast)});
  EXPECT_EQ(Error(long_clip), "its samples from 0 s to 1e+06 s are 1e+09 frames, more than 1048576");
  AlembicLimits limits;
  limits.vertices = 2;
  EXPECT_EQ(Error(Whole(), limits), "more than 2 vertices or 536870912 corners of faces");
  limits = {};
  limits.objects = 2;
  EXPECT_EQ(Error(Whole(), limits), "more than 2 objects");
}

TEST(AlembicErrorsTest, InstancesOfThemselves) {
  AlembicFiles files;
  EXPECT_TRUE(Error(files.Write({AlembicFiles::Object(
                        "x", "", {}, {AlembicFiles::Object("i", "", {files.Text(".instanceSource", "/x")})})}))
                  .ends_with(": instances that contain themselves"));
  AlembicFiles others;
  EXPECT_EQ(Error(others.Write({AlembicFiles::Object("i", "", {others.Text(".instanceSource", "/y")})})),
            "/i: an instance of an object that there is not");
}

TEST(AlembicErrorsTest, NothingToShow) {
  AlembicFiles files;
  EXPECT_EQ(Error(files.Write({files.Triangle("t", {})})), "no meshes with vertices; it has empty meshes (/t)");
  AlembicFiles hidden;
  EXPECT_EQ(Error(hidden.Write({hidden.Triangle("t", {0}, 0, {}, {hidden.Bytes("visible", {{0}})})})),
            "all meshes are hidden; it has hidden meshes (/t)");
}

// No prefix of a file is taken for a file, each in a buffer of its own size.
TEST(AlembicErrorsTest, Prefixes) {
  const std::string whole = Whole();
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_NE(Error(whole.substr(0, size)), "") << size;
}

TEST(AlembicErrorsTest, RandomChangesEndInAStatus) {
  const std::string whole = Whole();
  AlembicLimits limits;
  limits.frames = 100;
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = whole;
    for (std::uint32_t n = 1 + random() % 3; n > 0; --n) {
      bytes[random() % bytes.size()] = static_cast<char>(random() % 4 == 0 ? random() % 4 - 1 : random());
    }
    (void)Error(bytes, limits);
  }
}

TEST(AlembicErrorsTest, MessagesNameTheFile) {
  TestDirectory directory;
  std::unique_ptr<SceneReader> reader;
  const std::string path = directory.Write("a.abc", "no");
  EXPECT_EQ(OpenAlembicClip(path, {}, reader).message(), path + ": not an Alembic file");
  EXPECT_EQ(OpenAlembicClip(directory.Path("b.abc"), {}, reader).message(),
            directory.Path("b.abc") + ": No such file or directory");
  EXPECT_EQ(OpenAlembicClip(directory.Path(""), {}, reader).message(), directory.Path("") + ": is a directory");
}

}  // namespace
}  // namespace sac
