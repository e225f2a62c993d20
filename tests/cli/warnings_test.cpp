// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <sstream>

#include "files/cache_file.h"
#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class WarningsTest : public SacCommandOnClip {
 protected:
  // Standard error of a run that succeeds.
  std::string Told(const std::vector<std::string>& arguments) const {
    const Outcome outcome = Sac(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.err;
  }

  void WriteCache(const std::string& name, const std::vector<Positions>& frames) const {
    std::unique_ptr<CacheWriter> writer;
    ASSERT_TRUE(CacheWriter::Open(Path(name), frames[0].size(), 25, std::nullopt, writer).ok());
    for (const Positions& frame : frames) ASSERT_TRUE(writer->Write(frame).ok());
    ASSERT_TRUE(writer->Commit().ok());
  }
};

TEST_F(WarningsTest, AMeshThatWasNotNamedStays) {
  Encode("clip.sac", {"--keep-order"});
  directory_.Write("hero.obj", "# my work\n");
  const std::string refusal =
      "hero.obj: is there already, and another mesh would replace it, although it was not named; give another name for "
      "the output, or --force";
  ExpectFailure({"decode", "clip.sac", "-o", "hero.pc2"}, 1, refusal);
  ExpectFailure({"synth", "flag", "-o", "hero.mdd", "--vertices", "200"}, 1, refusal);
  EXPECT_EQ(Read("hero.obj"), "# my work\n");
  Good({"decode", "clip.sac", "-o", "hero.pc2", "--force"});
  EXPECT_NE(Read("hero.obj"), "# my work\n");
  // The same mesh again loses nothing, and what was named may be replaced.
  Good({"decode", "clip.sac", "-o", "hero.pc2"});
  Good({"decode", "clip.sac", "-o", "hero.obj", "--frames", "3"});
  // A link that leads nowhere is a file of the user's, too.
  std::filesystem::create_symlink("nowhere", Path("link.obj"));
  ExpectFailure({"decode", "clip.sac", "-o", "link.pc2"}, 1, "link" + refusal.substr(4));
}

TEST_F(WarningsTest, FramesOfALongerRunAreTold) {
  Encode("clip.sac");
  Good({"synth", "flag", "-o", "f_%03d.obj", "--vertices", "200", "--frames", "15"});
  const std::string stale = "f_%03d.obj: frames 12 to 14 are there from before and do not belong to this clip";
  EXPECT_EQ(Told({"decode", "clip.sac", "-o", "f_%03d.obj", "--frames", "0:4"}), "");
  EXPECT_EQ(Told({"decode", "clip.sac", "-o", "f_%03d.obj"}), "sac: warning: " + stale + "\n");
  const std::string before = Read("f_000.obj");
  ExpectFailure({"decode", "clip.sac", "-o", "f_%03d.obj", "--strict"}, 1, stale + " [--strict]");
  EXPECT_EQ(Read("f_000.obj"), before);
  EXPECT_EQ(Told({"synth", "flag", "-o", "f_%03d.obj", "--vertices", "200", "--frames", "14"}),
            "sac: warning: f_%03d.obj: frames 14 are there from before and do not belong to this clip\n");
}

TEST_F(WarningsTest, NumbersOfASequence) {
  Good({"synth", "flag", "-o", "f_%04d.obj", "--vertices", "200", "--frames", "12"});
  std::filesystem::remove(Path("f_0005.obj"));
  const std::string gap = "f_####.obj: no file has the number 5; ";
  ExpectFailure({"encode", "f_####.obj", "-o", "x.sac"}, 1,
                gap + "--gaps hold repeats the frame before each gap, --gaps skip leaves gaps out");
  EXPECT_EQ(Told({"encode", "f_####.obj", "-o", "hold.sac", "--gaps", "hold", "--harmonics", "30"}),
            "sac: warning: " + gap + "the frame before the gap stands in\n");
  EXPECT_NE(Good({"info", "hold.sac"}).find("frames                   12"), std::string::npos);
  const Outcome skip = Sac({"encode", "f_####.obj", "-o", "skip.sac", "--gaps", "skip", "--json", "--harmonics", "30"});
  const nlohmann::json report = nlohmann::json::parse(skip.out, nullptr, false);
  EXPECT_EQ(report["frames"], 11);
  EXPECT_EQ(report["warnings"], nlohmann::json::array({gap + "the stream goes on without"}));
  ExpectFailure({"encode", "f_####.obj", "-o", "strict.sac", "--gaps", "skip", "--strict"}, 1,
                gap + "the stream goes on without [--strict]");
  Good({"decode", "skip.sac", "-o", "g_$F3.obj", "--first-number", "101", "--frames", "0:2"});
  EXPECT_TRUE(std::filesystem::exists(Path("g_101.obj")) && std::filesystem::exists(Path("g_102.obj")));
}

TEST_F(WarningsTest, CachesThatAreCutShort) {
  directory_.Write("cut.pc2", Read("in.pc2").substr(0, Read("in.pc2").size() - 100));
  const Outcome refused = Sac({"encode", "in.obj", "cut.pc2", "-o", "cut.sac"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("the file has 11 whole frames"), std::string::npos) << refused.err;
  const std::string told = Told({"encode", "in.obj", "cut.pc2", "-o", "cut.sac", "--skip-damage", "--harmonics", "30"});
  EXPECT_EQ(told.rfind("sac: warning: cut.pc2: ", 0), 0u) << told;
  EXPECT_NE(Good({"info", "cut.sac"}).find("frames                   11"), std::string::npos);
}

// A coordinate of 5.6e6 has steps of 0.5 as float32.
TEST_F(WarningsTest, FarCoordinatesComeBack) {
  for (int f = 0; f < 2; ++f) {
    std::string obj;
    for (const char* xyz : {"0.25", "1.25", "0.5"}) {
      obj += "v 500000.125 " + std::to_string(5600000 + f) + (xyz + 1) + " " + xyz + "\n";
    }
    directory_.Write("far_" + std::to_string(f) + ".obj", obj + "f 1 2 3\n");
  }
  Told({"encode", "far_%d.obj", "-o", "far.sac", "--keep-order", "--max-error", "1e-3"});
  Good({"decode", "far.sac", "-o", "back_%d.obj"});
  const auto number = [&](const std::string& file, std::size_t index) {
    std::istringstream in(Read(file).substr(1));
    double x = 0;
    for (std::size_t i = 0; i <= index; ++i) in >> x;
    return x;
  };
  for (const char* f : {"0", "1"}) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(number(std::string("back_") + f + ".obj", i), number(std::string("far_") + f + ".obj", i), 1e-3);
    }
  }
  const std::string told = Told({"decode", "far.sac", "-o", "back.pc2"});
  EXPECT_NE(told.find("32-bit floats round the coordinates by up to 0."), std::string::npos) << told;
}

TEST_F(WarningsTest, AxesAndUnits) {
  Encode("clip.sac");
  Good({"decode", "clip.sac", "-o", "a.pc2"});
  Good({"decode", "clip.sac", "-o", "b.pc2", "--up", "y:z", "--units", "m:cm"});
  std::unique_ptr<CacheReader> a, b;
  ASSERT_TRUE(CacheReader::Open(Path("a.pc2"), a).ok() && CacheReader::Open(Path("b.pc2"), b).ok());
  Positions from, to;
  ASSERT_TRUE(a->Read(7, from).ok() && b->Read(7, to).ok());
  for (std::size_t v = 0; v < from.size(); ++v) {
    EXPECT_FLOAT_EQ(to[v][0], 100 * from[v][0]);
    EXPECT_FLOAT_EQ(to[v][1], -100 * from[v][2]);
    EXPECT_FLOAT_EQ(to[v][2], 100 * from[v][1]);
  }
  ExpectFailure({"decode", "clip.sac", "-o", "c.pc2", "--up", "x:z"}, 2,
                "--up: 'x:z' is neither y:z nor z:y (see sac decode --help)");
  ExpectFailure({"decode", "clip.sac", "-o", "c.pc2", "--units", "m"}, 2,
                "--units: 'm' is no pair of mm, cm, m, km, in, ft and yd such as cm:m (see sac decode --help)");
}

// Two squares meet at two points that are there twice. They turn against each other about the line between them.
TEST_F(WarningsTest, SeamsThatOpen) {
  directory_.Write("seam.obj",
                   "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 0 1 0\nv -1 0 0\nv -1 1 0\n"
                   "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\n");
  std::vector<Positions> frames;
  for (int t = 0; t < 8; ++t) {
    const float x = std::cos(0.2F * static_cast<float>(t)), z = std::sin(0.2F * static_cast<float>(t));
    frames.push_back({{0, 0, 0}, {0, 1, 0}, {x, 0, z}, {x, 1, z}, {0, 0, 0}, {0, 1, 0}, {-x, 0, z}, {-x, 1, z}});
  }
  WriteCache("seam.pc2", frames);
  std::vector<std::string> encode{
      "encode", "seam.obj", "seam.pc2", "-o", "seam.sac", "--motion-step", "0.5", "--displacement-step", "0.2"};
  EXPECT_EQ(Told(encode).find("coincide"), std::string::npos);  // they are joined
  encode.push_back("--no-join");
  const std::string told = Told(encode);
  EXPECT_EQ(told.rfind("sac: warning: seam.obj: vertices that coincide in every frame decode up to ", 0), 0u) << told;
  std::vector<std::string> bounded = encode;
  bounded.resize(5);
  bounded.insert(bounded.end(), {"--no-join", "--max-error", "1e-4", "--json"});
  const nlohmann::json report = GoodJson(bounded);
  EXPECT_LE(report["seam_gap"], 2e-4);
  EXPECT_TRUE(report["warnings"].empty());
}

TEST_F(WarningsTest, PartsThatAreParkedFarAway) {
  std::string obj = Read("in.obj");
  std::unique_ptr<CacheReader> reader;
  ASSERT_TRUE(CacheReader::Open(Path("in.pc2"), reader).ok());
  const std::size_t n = reader->point_count();
  for (const char* x : {"1e5", "100001", "1e5"}) obj += std::string("v ") + x + " 0 0\n";
  obj += "f " + std::to_string(n + 1) + " " + std::to_string(n + 2) + " " + std::to_string(n + 3) + "\n";
  directory_.Write("far.obj", obj);
  std::vector<Positions> frames(reader->frame_count());
  for (std::uint32_t f = 0; f < frames.size(); ++f) {
    ASSERT_TRUE(reader->Read(f, frames[f]).ok());
    frames[f].insert(frames[f].end(), {{1e5F, 0, 0}, {100001, 0, 0}, {1e5F, 1, 0}});
  }
  WriteCache("far.pc2", frames);
  std::vector<std::string> encode{"encode", "far.obj", "far.pc2", "-o", "far.sac", "--harmonics", "30"};
  EXPECT_EQ(Told(encode).find(" its own size"), std::string::npos) << "each is coded by its size";
  encode.insert(encode.end(), {"--motion-step", "10", "--displacement-step", "100"});
  const std::string told = Told(encode);
  EXPECT_NE(told.find("sac: warning: far.obj: the part of "), std::string::npos) << told;
  EXPECT_NE(told.find(" its own size (KG "), std::string::npos) << told;
}

// Noise has no harmonics to be told by.
TEST_F(WarningsTest, QualitiesThatMissWhatTheyStandFor) {
  std::unique_ptr<CacheReader> reader;
  ASSERT_TRUE(CacheReader::Open(Path("in.pc2"), reader).ok());
  std::vector<Positions> frames(2);
  std::uint32_t state = 1;
  for (Positions& frame : frames) ASSERT_TRUE(reader->Read(0, frame).ok());
  for (Vec3f& p : frames[1]) {
    for (float& x : p) x += static_cast<float>((state = state * 1664525 + 1013904223) >> 8) * 0x1p-24F;
  }
  WriteCache("noise.pc2", frames);
  const std::string told = Told({"encode", "in.obj", "noise.pc2", "-o", "noise.sac", "--quality", "20"});
  EXPECT_NE(told.find(", where quality 20 usually gives 2.2"), std::string::npos) << told;
  EXPECT_NE(told.find("would hold it\n"), std::string::npos) << told;
}

}  // namespace
}  // namespace sac
