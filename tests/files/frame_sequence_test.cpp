// SPDX-License-Identifier: Apache-2.0
#include "files/frame_sequence.h"

#include <gtest/gtest.h>

#include "files/frame_pattern.h"
#include "tests/test_directory.h"

namespace sac {
namespace {

TEST(FramePatternTest, Syntax) {
  const auto path = [](const std::string& text, std::int64_t number) {
    FramePattern pattern;
    const Status status = FramePattern::Parse(text, pattern);
    return status.ok() ? pattern.Path(number) : status.message();
  };
  EXPECT_EQ(path("x_%04d.obj", 7), "x_0007.obj");
  EXPECT_EQ(path("x_%04d.obj", 123456), "x_123456.obj");
  EXPECT_EQ(path("d/%d", 7), "d/7");
  EXPECT_EQ(path("%%%05d%%", 7), "%00007%");
  EXPECT_EQ(path("%020d", 1), "00000000000000000001");
  EXPECT_EQ(path("x_%04d.obj", -7), "x_-007.obj");
  EXPECT_EQ(path("a#/x_####.obj", 7), "a#/x_0007.obj");
  EXPECT_EQ(path("x_#.obj", 12), "x_12.obj");
  EXPECT_EQ(path("x.$F4.obj", 7), "x.0007.obj");
  EXPECT_EQ(path("x.$F.obj", 7), "x.7.obj");
  EXPECT_EQ(path("x*.obj", 7), "x7.obj");
  EXPECT_EQ(path("take#1_%02d.obj", 7), "take#1_07.obj");
  EXPECT_EQ(path("#_#.obj", 0), "#_#.obj: more than one frame number");
  EXPECT_EQ(path("x.obj", 0), "x.obj: no frame number (%d or %04d)");
  EXPECT_EQ(path("%d%d", 0), "%d%d: more than one frame number");
  EXPECT_EQ(path("%d/x", 0), "%d/x: the frame number is in a directory's name");
  for (const std::string bad : {"%s", "%n", "%4d", "%-04d", "%ld", "%", "%0", "%.3d", "%*d", "%x", "%04"}) {
    EXPECT_EQ(path(bad, 0), bad + ": the frame number is written %d or %04d");
  }
  for (const std::string bad : {"%0d", "%00d", "%021d", "%099999999999999999999d"}) {
    EXPECT_EQ(path(bad, 0), bad + ": the frame number has a width of 1 to 20");
  }
}

class FrameSequenceTest : public testing::Test {
 protected:
  void Make(const std::vector<std::string>& names) {
    for (const std::string& name : names) directory_.Write(name, "");
  }

  // The names found, a blank after each, or the message; without the directory.
  std::string Find(const std::vector<std::string>& names, Gaps gaps = Gaps::kError) {
    std::vector<std::string> arguments;
    for (const std::string& name : names) arguments.push_back(directory_.Path(name));
    warnings_.clear();
    const Status status = FindSequence(arguments, gaps, sequence_, warnings_);
    if (!status.ok()) return Short(status.message());
    std::string found;
    for (const std::string& path : sequence_.paths) found += Short(path) + " ";
    return found;
  }
  std::string OnlyWarning() { return warnings_.size() == 1 ? Short(warnings_[0]) : std::to_string(warnings_.size()); }

  std::string Short(std::string text) const {
    const std::string prefix = directory_.Path("");
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }

  TestDirectory directory_;
  FrameSequence sequence_;
  Warnings warnings_;
};

TEST_F(FrameSequenceTest, IsInTheOrderOfNumbers) {
  Make({"f_8.obj", "f_9.obj", "f_10.obj", "f_11.obj", "f_007.obj", "g_1.obj", "f_.obj", "f_9.obj.bak"});
  const std::string all = "f_8.obj f_9.obj f_10.obj f_11.obj ";
  EXPECT_EQ(Find({"f_%d.obj"}), all);
  EXPECT_EQ(
      OnlyWarning(),
      "f_%d.obj: its first frame has the number 8, which the stream does not keep; decode --first-number 8 brings "
      "it back");
  EXPECT_EQ(Find({"f_#.obj"}), all);
  EXPECT_EQ(Find({"f_$F.obj"}), all);
  EXPECT_EQ(Find({"f_*.obj"}), "f_007.obj " + all);
  EXPECT_EQ(Find({"f_%03d.obj"}), "f_007.obj ");  // the others are spelt otherwise
  EXPECT_EQ(Find({"f_###.obj"}), "f_007.obj ");
  EXPECT_EQ(Find({"f_$F3.obj"}), "f_007.obj ");
  EXPECT_EQ(Find({"h_%d.obj"}), "h_%d.obj: no file matches");
  EXPECT_EQ(Find({"none/h_%d.obj"}), "none/h_%d.obj: No such file or directory");
}

TEST_F(FrameSequenceTest, NegativeNumbers) {
  Make({"f_-0002.obj", "f_-001.obj", "f_0000.obj", "f_0001.obj", "b-2.obj", "b-1.obj", "b-3.obj"});
  EXPECT_EQ(Find({"f_%04d.obj"}), "f_-0002.obj f_-001.obj f_0000.obj f_0001.obj ");
  EXPECT_EQ(Find({"b*.obj"}), "b-1.obj b-2.obj b-3.obj ");  // the sign is a hyphen
  Make({"f_-02.obj"});
  EXPECT_EQ(Find({"f_*.obj"}), "f_*.obj: f_-0002.obj and f_-02.obj have the same number");
}

TEST_F(FrameSequenceTest, NumbersBeyond63Bits) {
  Make({"f0.obj", "f9223372036854775807.obj"});
  EXPECT_EQ(Find({"f%d.obj"}, Gaps::kSkip), "f0.obj f9223372036854775807.obj ");
  Make({"f9223372036854775808.obj"});
  const std::string message = "f9223372036854775808.obj: its frame number is too large";
  for (const char* pattern : {"f%d.obj", "f*.obj", "f#.obj"}) EXPECT_EQ(Find({pattern}), message);
  EXPECT_EQ(Find({"."}), "./" + message);
}

TEST_F(FrameSequenceTest, Gaps) {
  Make({"f1.obj", "f2.obj", "f4.obj", "f8.obj"});
  EXPECT_EQ(
      Find({"f%d.obj"}),
      "f%d.obj: no file has the number 3, 5 to 7; --gaps hold repeats the frame before each gap, --gaps skip leaves "
      "gaps out");
  EXPECT_EQ(Find({"f%d.obj"}, Gaps::kSkip), "f1.obj f2.obj f4.obj f8.obj ");
  EXPECT_EQ(OnlyWarning(), "f%d.obj: no file has the number 3, 5 to 7; the stream goes on without");
  EXPECT_EQ(Find({"f%d.obj"}, Gaps::kHold), "f1.obj f2.obj f2.obj f4.obj f4.obj f4.obj f4.obj f8.obj ");
  EXPECT_EQ(OnlyWarning(), "f%d.obj: no file has the number 3, 5 to 7; the frame before the gap stands in");
}

TEST_F(FrameSequenceTest, ManyGapsAreCounted) {
  std::vector<std::string> names{"f0.obj"};
  for (int i = 1; i < 40; i += 3) names.push_back("f" + std::to_string(i) + ".obj");
  Make(names);
  const std::string message = Find({"f%d.obj"});
  EXPECT_NE(message.find("2 to 3, 5 to 6, "), std::string::npos) << message;
  EXPECT_NE(message.find("23 to 24 and in 4 more gaps; "), std::string::npos) << message;
}

TEST_F(FrameSequenceTest, ACommonStepIsTakenAndTold) {
  Make({"f0.obj", "f10.obj", "f20.obj"});
  EXPECT_EQ(Find({"f%d.obj"}), "f0.obj f10.obj f20.obj ");
  EXPECT_EQ(sequence_.step, 10);
  EXPECT_EQ(OnlyWarning(), "f%d.obj: its numbers go from 0 to 20 in steps of 10; each file is one frame of the stream");
  Make({"f40.obj"});
  EXPECT_EQ(Find({"f%d.obj"}).substr(0, 34), "f%d.obj: no file has the number 30");
}

TEST_F(FrameSequenceTest, Directories) {
  Make({"a_0001.obj", "a_0002.obj", "notes.txt", "poster.obj"});
  EXPECT_EQ(Find({"."}), "./a_0001.obj ./a_0002.obj ");
  Make({"b.1.ply"});
  EXPECT_EQ(Find({"."}), ".: several sequences; name one, in quotes: ./a_*.obj ./b.*.ply");
  EXPECT_EQ(Find({"none"}), "none ");  // whoever reads it says that it is not there
  EXPECT_TRUE(IsSequenceName(directory_.Path(".")));
  EXPECT_TRUE(IsSequenceName(directory_.Path("x%d.obj")));
  EXPECT_FALSE(IsSequenceName(directory_.Path("a_0001.obj")));
}

TEST_F(FrameSequenceTest, FilesAreTakenAsTheyAreGiven) {
  EXPECT_EQ(Find({"f1.obj", "f10.obj", "f2.obj"}), "f1.obj f10.obj f2.obj ");
  EXPECT_EQ(
      OnlyWarning(),
      "f2.obj: comes after f10.obj, against the order of their numbers; the pattern 'f*.obj' in quotes reads them "
      "in that order");
  EXPECT_EQ(Find({"f1.obj", "f2.obj", "f10.obj"}), "f1.obj f2.obj f10.obj ");
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(Find({"b.obj", "a2.obj", "a1.obj"}), "b.obj a2.obj a1.obj ");  // no numbers to go by
  EXPECT_TRUE(warnings_.empty());
  Make({"take%1.obj"});
  EXPECT_EQ(Find({"take%1.obj"}), "take%1.obj ");  // a file of that name, not a pattern
}

}  // namespace
}  // namespace sac
