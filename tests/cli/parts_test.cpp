// SPDX-License-Identifier: Apache-2.0
// Streams that are encoded in parts, cut and joined.
#include "tests/cli/sac_command.h"

namespace sac {
namespace {

// A clip of 23 frames in groups of 5.
class PartsTest : public SacCommand {
 protected:
  PartsTest() {
    Good({"synth", "flag", "-o", "in.pc2", "--vertices", "200", "--frames", "23"});
    Encode("whole.sac", {"--harmonics", "30", "--group", "5", "--reference-rounds", "0", "--fps", "25"});
  }

  std::string Encode(const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"encode", "in.obj", "in.pc2", "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Good(arguments);
  }
  void MakeStart() const {
    const std::string told = Encode("clip.start", {"--harmonics", "30", "--group", "5", "--fps", "25", "--start-only"});
    EXPECT_NE(told.find("groups of 5 frames"), std::string::npos) << told;
  }
};

TEST_F(PartsTest, JoinToTheBytesOfOneProcess) {
  MakeStart();
  Encode("c.sac", {"--from", "clip.start", "--part", "15:"});
  Encode("a.sac", {"--from", "clip.start", "--part", ":5", "--jobs", "2"});
  Encode("b.sac", {"--from", "clip.start", "--part", "5:15", "--unchecked"});
  EXPECT_EQ(Good({"join", "a.sac", "b.sac", "c.sac", "-o", "joined.sac"}),
            "joined.sac: " + std::to_string(Read("whole.sac").size()) + " bytes, 23 frames in 5 groups of 3 streams\n");
  EXPECT_EQ(Read("joined.sac"), Read("whole.sac"));
  // All of it is one part, too, and each part is a stream of its own.
  Encode("all.sac", {"--from", "clip.start"});
  EXPECT_EQ(Read("all.sac"), Read("whole.sac"));
  EXPECT_NE(Good({"verify", "b.sac"}).find("10 frames"), std::string::npos);
  const auto json = GoodJson({"join", "a.sac", "b.sac", "-o", "two.sac", "--json"});
  EXPECT_EQ(json["frames"], 15);
  EXPECT_EQ(json["groups"], 3);
}

TEST_F(PartsTest, ThatDoNotFitAreRefused) {
  MakeStart();
  const auto part = [](const std::string& range) {
    return std::vector<std::string>{"encode", "in.obj",     "in.pc2", "-o", "p.sac",
                                    "--from", "clip.start", "--part", range};
  };
  ExpectFailure(part("3:10"), 1,
                "in.obj: a part begins with a group, of which each has 5 frames: not with frame 3 but with 0 or 5");
  ExpectFailure(
      part("5:12"), 1,
      "in.obj: a part ends with a group, of which each has 5 frames, or with the clip: not before frame 12 but "
      "before 10 or 15");
  ExpectFailure(part("20:30"), 1, "in.obj: has 23 frames of this mesh, numbers from 0 on; 20:30 is not within them");
  ExpectFailure(part("25:"), 1, "in.obj: has 23 frames of this mesh, numbers from 0 on; 25: is not within them");
  Good({"synth", "flag", "-o", "other.pc2", "--vertices", "300", "--frames", "5"});
  ExpectFailure({"encode", "other.obj", "other.pc2", "-o", "p.sac", "--from", "clip.start"}, 1,
                "other.obj: another mesh than that of the start");
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "p.sac", "--from", "whole.sac"}, 1,
                "in.obj: stream start: length");
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "p.sac", "--from", "in.obj"}, 1, "in.obj: not a .sac stream");
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--quality", "60"}, {"--group", "4"}}) {
    std::vector<std::string> arguments = part("0:5");
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(Sac(arguments).code, 2) << more[0];
  }
  EXPECT_EQ(Sac({"encode", "in.obj", "in.pc2", "-o", "p.sac", "--part", "0:5"}).code, 2);
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "p.sac", "--start-only", "--target-kg", "1"}, 2,
                "--start-only: a search for targets needs the whole stream (see sac encode --help)");
}

TEST_F(PartsTest, CutsAreWholeGroups) {
  EXPECT_EQ(Good({"cut", "whole.sac", "5:15", "-o", "cut.sac"}).rfind("cut.sac: ", 0), 0u);
  const auto info = GoodJson({"info", "cut.sac", "--json"});
  EXPECT_EQ(info["frames"], 10);
  const Outcome outward = Sac({"cut", "whole.sac", "6:14", "-o", "outward.sac"});
  EXPECT_EQ(outward.code, 0);
  EXPECT_EQ(outward.err, "warning: whole.sac: frames 6:14 were asked for, whole groups are 5:15\n");
  EXPECT_EQ(Read("outward.sac"), Read("cut.sac"));
  // From a pipe to a pipe.
  EXPECT_EQ(Shell("cat whole.sac | " + Quote(SAC_EXECUTABLE) + " cut - 5:15 -o - 2>told > piped.sac").code, 0);
  EXPECT_EQ(Read("piped.sac"), Read("cut.sac"));
  Good({"cut", "whole.sac", ":5", "-o", "head.sac"});
  Good({"cut", "whole.sac", "15:", "-o", "tail.sac"});
  Good({"join", "head.sac", "cut.sac", "tail.sac", "-o", "joined.sac"});
  EXPECT_EQ(Read("joined.sac"), Read("whole.sac"));

  ExpectFailure({"cut", "whole.sac", "20:24", "-o", "none.sac"}, 1,
                "whole.sac: has 23 frames, numbers from 0 on; 20:24 is not within them");
  ExpectFailure({"cut", "whole.sac", "30:", "-o", "none.sac"}, 1,
                "whole.sac: has 23 frames, numbers from 0 on; 30: is not within them");
  EXPECT_EQ(Sac({"cut", "whole.sac", "7:3", "-o", "none.sac"}).code, 2);
  EXPECT_EQ(Sac({"cut", "whole.sac", "5:15", "-o", "whole.sac"}).code, 2);
}

TEST_F(PartsTest, JoinsOutOfOrderLeaveNothing) {
  Good({"cut", "whole.sac", ":5", "-o", "a.sac"});
  Good({"cut", "whole.sac", "5:15", "-o", "b.sac"});
  Good({"cut", "whole.sac", "15:", "-o", "c.sac"});
  ExpectFailure({"join", "a.sac", "c.sac", "-o", "j.sac"}, 1,
                "c.sac: begins with frame 15 of the clip, but frames from 5 on are missing");
  ExpectFailure({"join", "b.sac", "a.sac", "-o", "j.sac"}, 1,
                "a.sac: begins with frame 0 of the clip, but the streams before go to frame 14: given twice, or in "
                "another order");
  ExpectFailure({"join", "a.sac", "in.pc2", "-o", "j.sac"}, 1, "in.pc2: not a .sac stream");
  ExpectFailure({"join", "a.sac", "none.sac", "-o", "j.sac"}, 1, "none.sac: No such file or directory");
  EXPECT_NE(Good({"join", "b.sac", "a.sac", "-o", "turned.sac", "--renumber"}).find("15 frames"), std::string::npos);
  // Another mesh is a further segment.
  Good({"synth", "sphere", "-o", "s.pc2", "--vertices", "42", "--frames", "3"});
  Good({"encode", "s.obj", "s.pc2", "-o", "s.sac", "--fps", "25"});
  Good({"join", "whole.sac", "s.sac", "-o", "both.sac"});
  EXPECT_NE(Good({"verify", "both.sac"}).find("26 frames of 2 meshes"), std::string::npos);
}

TEST_F(PartsTest, AnyNumberOfJobsGivesTheSame) {
  for (const char* jobs : {"1", "2", "3"}) {
    Encode("jobs.sac", {"--harmonics", "30", "--group", "5", "--fps", "25", "--reference-rounds", "0", "--jobs", jobs});
    EXPECT_EQ(Read("jobs.sac"), Read("whole.sac")) << jobs;
    const auto measured = GoodJson({"encode", "in.obj", "in.pc2", "-o", "fitted.sac", "--harmonics", "30", "--group",
                                    "5", "--target-kg", "2", "--json", "--jobs", jobs});
    const std::string bytes = Read("fitted.sac");
    if (jobs[0] == '1') directory_.Write("expected.sac", bytes);
    EXPECT_EQ(bytes, Read("expected.sac")) << jobs;
    EXPECT_LE(measured["kg"].get<double>(), 2.06);
  }
}

}  // namespace
}  // namespace sac
