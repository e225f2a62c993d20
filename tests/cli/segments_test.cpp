// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

// A sequence whose mesh changes: frames 0 to 5 are of a sphere, 6 to 11 of a flag, 12 of a sphere again.
class SegmentsTest : public SacCommand {
 protected:
  SegmentsTest() {
    Good({"synth", "sphere", "-o", "a_%04d.obj", "--vertices", "42", "--frames", "7"});
    Good({"synth", "flag", "-o", "b_%04d.obj", "--vertices", "60", "--frames", "6"});
    for (int f = 0; f < 6; ++f) {
      Move("a_000" + std::to_string(f) + ".obj", f);
      Move("b_000" + std::to_string(f) + ".obj", 6 + f);
    }
    Move("a_0006.obj", 12);
  }

  static std::string Name(const std::string& stem, int frame) {
    return stem + "_" + (frame < 10 ? "000" : "00") + std::to_string(frame) + ".obj";
  }
  void Move(const std::string& from, int frame) const { std::filesystem::rename(Path(from), Path(Name("f", frame))); }

  // Encodes the sequence; what is told of its segments is checked.
  nlohmann::json Encode(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"encode", "f_%04d.obj", "-o", output, "--keep-order", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = Sac(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("f_0006.obj: 60 vertices, but f_0000.obj has 42; a segment begins with it\n"),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("f_0012.obj: 42 vertices, but f_0006.obj has 60; a segment begins with it\n"),
              std::string::npos)
        << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(SegmentsTest, ComeBackAsTheSequenceThatTheyWere) {
  const auto encoded = Encode("clip.sac", {"--quality", "80"});
  EXPECT_EQ(encoded["segments"], 3);
  EXPECT_EQ(encoded["frames"], 13);
  EXPECT_NEAR(encoded["bpvf"].get<double>(), 8 * encoded["bytes"].get<double>() / (7 * 42 + 6 * 60), 1e-9);
  EXPECT_EQ(GoodJson({"info", "clip.sac", "--json"})["segments"], 3);
  EXPECT_NE(Good({"verify", "clip.sac"}).find("13 frames of 3 meshes"), std::string::npos);

  Good({"decode", "clip.sac", "-o", "out_%04d.obj"});
  for (int f = 0; f <= 12; ++f) ASSERT_TRUE(std::filesystem::exists(Path(Name("out", f)))) << f;
  // What the encoder says is what one measures of the files.
  const auto compared = GoodJson({"compare", "f_%04d.obj", "--with", "out_%04d.obj", "--json"});
  EXPECT_EQ(compared["frames"], 13);
  for (const char* figure : {"kg", "sted", "max_error"}) {
    EXPECT_NEAR(compared[figure].get<double>(), encoded[figure].get<double>(), 2e-3 * encoded[figure].get<double>())
        << figure;
  }
  EXPECT_LT(compared["kg"].get<double>(), 5);
}

TEST_F(SegmentsTest, DecodeAsStreamsOfTheirOwn) {
  Encode("clip.sac", {"--quality", "80"});
  for (const char* range : {"0:6", "6:12", "12:13"}) {
    Good({"decode", "clip.sac", "-o", "part.pc2", "--force", "--frames", range});
    Good({"decode", "clip.sac", "-o", "part_%04d.obj", "--frames", range});
    EXPECT_EQ(GoodJson({"compare", "part_%04d.obj", "--with", "part.obj", "part.pc2", "--json"})["max_error"], 0);
    for (int f = 0; f <= 12; ++f) std::filesystem::remove(Path(Name("part", f)));
  }
}

TEST_F(SegmentsTest, TargetsAreMetOverAll) {
  const auto encoded = Encode("clip.sac", {"--target-kg", "2"});
  EXPECT_LE(encoded["kg"].get<double>(), 2);
  Good({"decode", "clip.sac", "-o", "out_%04d.obj"});
  const auto compared = GoodJson({"compare", "f_%04d.obj", "--with", "out_%04d.obj", "--json"});
  EXPECT_LE(compared["kg"].get<double>(), 2.01);
}

TEST_F(SegmentsTest, WhatCannotHoldThemSaysSo) {
  Encode("clip.sac");
  ExpectFailure({"decode", "clip.sac", "-o", "out.pc2"}, 1,
                "out.pc2: holds one mesh, and the mesh changes at frame 6; write a sequence of meshes, such as "
                "frame_%04d.obj, or the --frames of each mesh");
  ExpectFailure({"decode", "clip.sac", "-o", "out_%d.obj", "--onto", "f_0000.obj"}, 1,
                "f_0000.obj: --onto is for one mesh, and the mesh changes at frame 6");
  const Outcome outcome = Sac({"encode", "f_%04d.obj", "-o", "out.sac", "--order-map", "out.txt"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("f_%04d.obj: the mesh changes: --keep-order keeps the order of each mesh"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(Path("out.sac")));
  EXPECT_FALSE(std::filesystem::exists(Path("out.txt")));
}

}  // namespace
}  // namespace sac
