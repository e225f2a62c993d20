// SPDX-License-Identifier: Apache-2.0
#include "files/clip_input.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/files/clip_files.h"

namespace sac {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const std::string kFace = "f 1 2 3\n";

class ClipInputTest : public ClipFileTest {
 protected:
  // Opens and reads to the end; x of vertex 0 of every frame goes to `xs`. The message, without the directory, or "".
  std::string ReadAll(const std::vector<std::string>& arguments, std::vector<float>& xs) {
    std::unique_ptr<ClipInput> input;
    if (const Status status = ClipInput::Open(arguments, input); !status.ok()) return Short(status.message());
    xs.clear();
    Positions frame;
    for (bool end = false; true;) {
      if (const Status status = input->Next(frame, end); !status.ok()) return Short(status.message());
      if (end) return "";
      xs.push_back(frame[0][0]);
    }
  }
  std::string ReadAll(const std::vector<std::string>& arguments) {
    std::vector<float> xs;
    return ReadAll(arguments, xs);
  }
};

TEST_F(ClipInputTest, CacheGivesPositionsAndMeshTheRest) {
  const std::string obj = WriteObj("a.obj", 99, "vt 0.5 1\nf 1/1 2/1 3/1\n");
  const std::string mdd = WriteCache("a.mdd", {Positions(3, {1, 0, 0}), Positions(3, {2, 0, 0})});
  std::unique_ptr<ClipInput> input;
  ASSERT_TRUE(ClipInput::Open({obj, mdd}, input).ok());
  EXPECT_EQ(input->mesh().positions[0][0], 1);
  EXPECT_EQ(input->mesh().uvs.size(), 1U);
  EXPECT_EQ(input->rate().per_second(), 25);
  EXPECT_EQ(input->frame_count(), 2U);
  for (int pass = 0; pass < 2; ++pass) {
    Positions frame;
    bool end = true;
    for (const float x : {1.0F, 2.0F}) {
      ASSERT_TRUE(input->Next(frame, end).ok());
      EXPECT_FALSE(end);
      EXPECT_EQ(frame, Positions(3, {x, 0, 0}));
    }
    ASSERT_TRUE(input->Next(frame, end).ok());
    EXPECT_TRUE(end);
    EXPECT_TRUE(input->Rewind().ok());
  }
}

TEST_F(ClipInputTest, CacheErrors) {
  const std::string obj = WriteObj("a.obj", 0);
  std::vector<Positions> frames(3, Positions(3));
  frames[2][1][2] = kNaN;
  const std::string pc2 = WriteCache("a.pc2", frames);
  EXPECT_EQ(ReadAll({obj, pc2}), "a.pc2: frame 2, vertex 1: not a finite number");
  frames[0][2][0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(ReadAll({obj, WriteCache("b.mdd", frames)}), "b.mdd: frame 0, vertex 2: not a finite number");
  EXPECT_EQ(ReadAll({obj, WriteCache("c.pc2", {Positions(4)})}), "c.pc2: 4 points, but a.obj has 3 vertices");
  EXPECT_EQ(ReadAll({pc2, obj}), "a.pc2: a cache comes alone after its mesh file");
  EXPECT_EQ(ReadAll({pc2}), "a.pc2: a cache comes alone after its mesh file");
  EXPECT_EQ(ReadAll({obj, obj, pc2}), "a.pc2: a cache comes alone after its mesh file");
  EXPECT_EQ(ReadAll({obj, directory_.Path("none.pc2")}), "none.pc2: No such file or directory");
  EXPECT_EQ(ReadAll({}), "no input");
  // The mesh file's own positions do not matter.
  EXPECT_EQ(ReadAll({directory_.Write("n.obj", "v nan 0 0\nv 0 0 0\nv 0 0 0\n" + kFace),
                     WriteCache("d.pc2", {Positions(3)})}),
            "");
}

TEST_F(ClipInputTest, Sequences) {
  std::vector<std::string> paths;
  for (const int i : {8, 9, 11}) paths.push_back(WriteObj("f" + std::to_string(i) + ".obj", static_cast<float>(i)));
  std::vector<float> xs;
  EXPECT_EQ(ReadAll({paths[2], paths[0]}, xs), "");
  EXPECT_EQ(xs, (std::vector<float>{11, 8}));
  EXPECT_EQ(
      ReadAll({directory_.Path("f%d.obj")}, xs),
      "f%d.obj: no file has the number 10; --gaps hold repeats the frame before each gap, --gaps skip leaves gaps "
      "out");
  WriteObj("f10.obj", 10);
  EXPECT_EQ(ReadAll({directory_.Path("f%d.obj")}, xs), "");
  EXPECT_EQ(xs, (std::vector<float>{8, 9, 10, 11}));
}

TEST_F(ClipInputTest, SequenceErrors) {
  const std::string first = WriteObj("f0.obj", 0);
  EXPECT_EQ(ReadAll({first, WriteObj("f1.obj", 0, kFace, 4)}), "f1.obj: 4 vertices, but f0.obj has 3");
  EXPECT_EQ(ReadAll({first, WriteObj("f1.obj", 0, "f 1 3 2\n")}), "f1.obj: its faces are not those of f0.obj");
  EXPECT_EQ(ReadAll({first, directory_.Write("f1.obj", "v 0 0 0\nv 0 inf 0\nv 0 0 0\n" + kFace)}),
            "f1.obj: line 2, vertex 1: inf: not a finite number");
  EXPECT_EQ(ReadAll({directory_.Path("f1.obj")}), "f1.obj: line 2, vertex 1: inf: not a finite number");
  EXPECT_EQ(ReadAll({directory_.Write("n.obj", "v 0 0 0\nvn 0 0 nan\nvt nan\nf 1/1/1 1/1/1 1/1/1\n")}),
            "n.obj: normal 0: not a finite number");
  EXPECT_EQ(ReadAll({directory_.Write("t.obj", "v 0 0 0\nvt nan\nf 1/1 1/1 1/1\n")}),
            "t.obj: texture coordinates 0: not a finite number");
  EXPECT_EQ(ReadAll({first, directory_.Path("f2.obj")}), "f2.obj: No such file or directory");
  EXPECT_EQ(ReadAll({first, directory_.Write("f3.obj", "")}), "f3.obj: the file is empty");
  EXPECT_EQ(ReadAll({directory_.Path("g%d.obj")}), "g%d.obj: no file matches");
  EXPECT_EQ(ReadAll({directory_.Path("none/g%d.obj")}), "none/g%d.obj: No such file or directory");
}

}  // namespace
}  // namespace sac
