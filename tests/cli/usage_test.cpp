// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class UsageTest : public SacCommandOnClip {};

TEST_F(UsageTest, HelpAndVersion) {
  EXPECT_EQ(Good({"--version"}).rfind("sac ", 0), 0u);
  EXPECT_NE(Good({"--help"}).find("compare"), std::string::npos);
  for (const char* command : {"encode", "decode", "info", "verify", "compare", "components", "pose", "synth"}) {
    EXPECT_NE(Good({command, "--help"}).find(std::string("  sac ") + command), std::string::npos) << command;
  }
  const Outcome full = Shell(Quote(SAC_EXECUTABLE) + " --help 2>&1 > /dev/full");
  EXPECT_EQ(full.code, 1);
  EXPECT_EQ(full.out, "sac: standard output: No space left on device\n");
}

TEST_F(UsageTest, ErrorsOfTheCommandLine) {
  ExpectFailure({}, 2, "A subcommand is required (see sac --help)");
  ExpectFailure({"info"}, 2, "STREAM is required (see sac info --help)");
  ExpectFailure({"info", "a.sac", "b.sac"}, 2, "The following argument was not expected: b.sac (see sac info --help)");
  ExpectFailure({"encode", "in.obj"}, 2, "--output is required (see sac encode --help)");
  const std::string end = " (see sac encode --help)";
  const auto encode = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"encode", "in.obj", "in.pc2", "-o", "clip.sac"});
    return more;
  };
  ExpectFailure(encode({"--bogus"}), 2, "The following argument was not expected: --bogus" + end);
  for (const char* word : {"101", "-1", "nan", "5x", ""}) {
    ExpectFailure(encode({"--quality", word}), 2,
                  std::string("--quality: '") + word + "' is not a number from 0 to 100" + end);
  }
  for (const char* word : {"0", "8193", "1.5", "99999999999"}) {
    ExpectFailure(encode({"--harmonics", word}), 2,
                  std::string("--harmonics: '") + word + "' is not a whole number from 1 to 8192" + end);
  }
  ExpectFailure(encode({"--group", "0"}), 2, "--group: '0' is not a whole number from 1 to 4096" + end);
  ExpectFailure(encode({"--position-bits", "25"}), 2, "--position-bits: '25' is not a number from 1 to 24" + end);
  ExpectFailure(encode({"--motion-step", "0"}), 2, "--motion-step: '0' is not a number from 1e-09 to 1e+09" + end);
  ExpectFailure(encode({"--displacement-step", "inf"}), 2,
                "--displacement-step: 'inf' is not a number from 1e-09 to 1e+09" + end);
  for (const char* word : {"0", "-1d", "1e-3dd", "d", "1e-3 d", "1D", "nan", ""}) {
    ExpectFailure(encode({"--max-error", word}), 2,
                  std::string("--max-error: '") + word +
                      "' is not a number from 1e-30 to 1e+30, with or without the suffix d" + end);
  }
  ExpectFailure(encode({"--target-kg", "0"}), 2, "--target-kg: '0' is not a number from 1e-06 to 1e+06" + end);
  for (const char* option :
       {"--quality", "--motion-step", "--displacement-step", "--detail-step", "--position-bits", "--max-error"}) {
    ExpectFailure(encode({"--target-sted", "0.1", option, "7"}), 2,
                  std::string(option) + " and a target exclude each other" + end);
  }
  ExpectFailure(encode({"--fps", "24/0"}), 2, "--fps: '24/0' is no frame rate" + end);
  ExpectFailure(encode({"--reference", "next"}), 2, "--reference: next not in {key,previous}" + end);
  ExpectFailure(encode({"--keep-order", "--order-map", "map.txt"}), 2,
                "--keep-order and --order-map exclude each other" + end);
  ExpectFailure(encode({"--order-map", "-"}), 2, "--order-map: must be a file" + end);
  ExpectFailure({"synth", "teapot", "-o", "x.pc2"}, 2,
                "KIND: teapot not in {walker,flag,sphere,parts,vase} (see sac synth --help)");
  ExpectFailure({"synth", "walker", "-o", "x.pc2", "--vertices", "10"}, 2,
                "--vertices: a walker has 2000 or more (see sac synth --help)");
  ExpectFailure(
      {"synth", "flag", "-o", "x.stl"}, 2,
      "x.stl: not a clip by its name (.pc2, .mdd, .abc, .glb, .gltf, .usda, .vat, or a pattern of .obj, .ply or .off) "
      "(see sac synth --help)");
  ExpectFailure(
      {"decode", "clip.sac", "-o", "x.sac"}, 2,
      "x.sac: not a clip by its name (.pc2, .mdd, .abc, .glb, .gltf, .usda, .vat, or a pattern of .obj, .ply or .off) "
      "(see sac decode --help)");
  for (const char* word : {":", "5:5", "7:3", "-1", "1:2:3", "a", "4294967295", ""}) {
    ExpectFailure({"decode", "clip.sac", "-o", "x.pc2", "--frames", word}, 2,
                  std::string("--frames: '") + word + "' is no range of frames such as 10:20 (see sac decode --help)");
  }
}

TEST_F(UsageTest, NoFileIsOverwrittenByItself) {
  const std::string end = " (see sac encode --help)", obj = Read("in.obj"), pc2 = Read("in.pc2");
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "in.pc2"}, 2,
                "in.pc2: a mesh or a cache by its name, not a .sac stream or an order map" + end);
  std::filesystem::create_hard_link(Path("in.obj"), Path("link"));
  std::filesystem::create_symlink("in.pc2", Path("symlink"));
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "link"}, 2, "link: would be overwritten while it is read" + end);
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "a.sac", "--order-map", "./symlink"}, 2,
                "./symlink: would be overwritten while it is read" + end);
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "new", "--order-map", Path("new")}, 2,
                Path("new") + ": would be written twice" + end);
  Encode("clip.sac", {"--order-map", "map.txt"});
  std::filesystem::rename(Path("map.txt"), Path("out.obj"));
  ExpectFailure({"decode", "clip.sac", "-o", "out.pc2", "--order-map", "out.obj"}, 2,
                "out.obj: would be overwritten while it is read (see sac decode --help)");
  std::filesystem::rename(Path("clip.sac"), Path("m_0003.obj"));
  ExpectFailure({"decode", "m_0003.obj", "-o", "m_%04d.obj"}, 2,
                "m_0003.obj: would be overwritten while it is read (see sac decode --help)");
  EXPECT_EQ(Read("in.obj"), obj);
  EXPECT_EQ(Read("in.pc2"), pc2);
}

TEST_F(UsageTest, ProgressIsForTerminals) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) GTEST_SKIP() << "no terminals here";
  ASSERT_TRUE(grantpt(terminal) == 0 && unlockpt(terminal) == 0);
  const int held = open(ptsname(terminal), O_RDWR | O_NOCTTY);  // what is written stays readable
  EXPECT_EQ(Shell(Quote(SAC_EXECUTABLE) + " encode in.obj in.pc2 -o a.sac --harmonics 5 2> " + ptsname(terminal)).code,
            0);
  // A terminal hands over what was written bit by bit; what this process writes last is the end of it.
  ASSERT_EQ(write(held, "|", 1), 1);
  std::string shown;
  for (char letter = 0; read(terminal, &letter, 1) == 1 && letter != '|';) shown += letter;
  ASSERT_GT(shown.size(), 2u);
  EXPECT_NE(shown.find("\rtrial 1, frame 1 / 12"), std::string::npos) << shown;
  EXPECT_EQ(shown.back(), '\r');
  EXPECT_EQ(shown[shown.size() - 2], ' ');
  EXPECT_EQ(shown.find('\n'), std::string::npos);
  close(held);
  close(terminal);
}

TEST_F(UsageTest, SweepSaysThatItsProgramIsMissing) {
  std::filesystem::create_directories(Path("alone/bin"));
  std::filesystem::copy_file(SAC_EXECUTABLE, Path("alone/bin/sac"));
  const Outcome outcome = Shell("alone/bin/sac sweep --help");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(
      outcome.err,
      "sac: sweep: the program sac-sweep is not installed beside sac; a build with -DSAC_BUILD_SWEEP=ON has it\n");
}

TEST_F(UsageTest, ASignalRemovesTemporaryFiles) {
  Encode("clip.sac");
  // The stream stalls after its first group, when the output has been opened.
  const Outcome outcome =
      Shell("mkfifo pipe; " + Quote(SAC_EXECUTABLE) +
            " decode - -o out.pc2 < pipe & pid=$!; exec 3> pipe; head -c -20 clip.sac >&3; "
            "for i in $(seq 500); do [ $(ls -A | grep -c '^[.]sac-.*tmp$') -ge 1 ] && break; sleep 0.02; done; "
            "ls -A | grep -c '^[.]sac-.*tmp$'; kill -TERM $pid; wait $pid; echo $?; ls -A | grep -c '^[.]sac-.*tmp$'");
  EXPECT_NE(outcome.out.substr(0, 2), "0\n");
  EXPECT_EQ(outcome.out.substr(2), "143\n0\n");
  EXPECT_FALSE(std::filesystem::exists(Path("out.pc2")) || std::filesystem::exists(Path("out.obj")));
}

}  // namespace
}  // namespace sac
