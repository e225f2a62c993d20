// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <sstream>

#include "files/cache_file.h"
#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class EncodeTest : public SacCommandOnClip {
 protected:
  nlohmann::json EncodeJson(const std::string& output, std::vector<std::string> more) const {
    more.push_back("--json");
    return nlohmann::json::parse(Encode(output, more));
  }
};

TEST_F(EncodeTest, ReportsEveryByte) {
  const nlohmann::json report = EncodeJson("clip.sac", {"--quality", "60"});
  std::uint64_t sum = 0;
  for (const char* part : {"header", "i_frame", "motion", "displacement", "side"}) {
    ASSERT_TRUE(report[part].is_number_unsigned()) << part;
    EXPECT_GT(report[part], 0) << part;
    sum += report[part].get<std::uint64_t>();
  }
  EXPECT_EQ(report["bytes"], sum);
  EXPECT_EQ(sum, Read("clip.sac").size());
  EXPECT_EQ(report["frames"], 12);
  const auto vertices = report["vertices"].get<double>();
  EXPECT_EQ(report["bpvf"].get<double>(), 8.0 * static_cast<double>(sum) / (12 * vertices));
  EXPECT_EQ((Read("in.pc2").size() - 32) / 12 / 12, report["vertices"]);
  EXPECT_GT(report["triangles"], 0);
  EXPECT_GE(report["seconds"], 0.0);
  EXPECT_EQ(report["settings"]["quality"], 60);
  EXPECT_EQ(report["settings"]["harmonics"], 30);
  EXPECT_EQ(report["settings"]["group"], 5);
  EXPECT_EQ(report["settings"]["reference"], "key");
  EXPECT_EQ(report["settings"]["keep_order"], false);
  EXPECT_TRUE(report["settings"]["motion_step"].is_null());
}

TEST_F(EncodeTest, ReportsText) {
  const std::string report = Encode("clip.sac");
  for (const char* piece : {"12 frames, ", " vertices, ", " triangles\n", " of raw float32, ", "KG ", "STED ",
                            "max error ", " seconds\n"}) {
    EXPECT_NE(report.find(piece), std::string::npos) << piece;
  }
  EXPECT_NE(report.find("\n" + std::to_string(Read("clip.sac").size()) + " bytes, "), std::string::npos);
}

TEST_F(EncodeTest, ReportsWhatCompareFinds) {
  const nlohmann::json kept = EncodeJson("kept.sac", {"--keep-order"});
  const nlohmann::json mapped = EncodeJson("mapped.sac", {"--order-map", "map.txt"});
  Good({"decode", "kept.sac", "-o", "kept.pc2"});
  Good({"decode", "mapped.sac", "-o", "mapped.pc2", "--order-map", "map.txt"});
  Good({"decode", "mapped.sac", "-o", "loose.pc2"});
  for (const auto& [report, name] : {std::pair{kept, std::string("kept")}, {mapped, "mapped"}}) {
    const nlohmann::json found =
        GoodJson({"compare", "in.obj", "in.pc2", "--with", name + ".obj", name + ".pc2", "--json"});
    for (const char* figure : {"kg", "sted", "sted_s", "sted_t", "max_error"}) {
      EXPECT_NEAR(found[figure].get<double>(), report[figure].get<double>(), 1e-9) << name << figure;
    }
    EXPECT_GT(found["max_error"], 0);
    EXPECT_LT(found["max_error"], 0.1);  // the flag is more than a metre wide
  }
  // Without an order the vertices are elsewhere.
  const nlohmann::json loose = GoodJson({"compare", "in.obj", "in.pc2", "--with", "loose.obj", "loose.pc2", "--json"});
  EXPECT_GT(loose["max_error"], 0.3);
}

TEST_F(EncodeTest, TwiceGivesTheSameBytes) {
  Encode("a.sac", {"--order-map", "a.map"});
  Encode("b.sac", {"--order-map", "b.map"});
  EXPECT_EQ(Read("a.sac"), Read("b.sac"));
  EXPECT_EQ(Read("a.map"), Read("b.map"));
}

TEST_F(EncodeTest, OptionsReachTheEncoder) {
  Encode("base.sac");
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{{"--quality", "90"},
                                                                                      {"--fps", "25"},
                                                                                      {"--harmonics", "31"},
                                                                                      {"--group", "6"},
                                                                                      {"--reference", "previous"},
                                                                                      {"--motion-step", "0.2"},
                                                                                      {"--displacement-step", "0.01"},
                                                                                      {"--position-bits", "7"},
                                                                                      {"--handles-per-harmonic", "0"},
                                                                                      {"--low-delay"},
                                                                                      {"--keep-order"}}) {
    std::vector<std::string> arguments{"encode", "in.obj", "in.pc2", "-o", "other.sac"};
    if (option[0] != "--harmonics") arguments.insert(arguments.end(), {"--harmonics", "30"});
    if (option[0] != "--group") arguments.insert(arguments.end(), {"--group", "5"});
    arguments.insert(arguments.end(), option.begin(), option.end());
    Good(arguments);
    EXPECT_NE(Read("base.sac"), Read("other.sac")) << option[0];
    Good({"verify", "other.sac"});
  }
}

TEST_F(EncodeTest, HoldsABoundOnTheError) {
  const nlohmann::json loose = EncodeJson("loose.sac", {"--max-error", "1e-2d", "--keep-order"});
  const nlohmann::json report = EncodeJson("clip.sac", {"--max-error", "1e-3d", "--keep-order"});
  const auto bound = report["settings"]["max_error"].get<double>();
  EXPECT_NEAR(loose["settings"]["max_error"].get<double>(), 10 * bound, 1e-9);
  EXPECT_GT(bound, 0.001);  // the flag is more than a metre wide
  EXPECT_LT(bound, 0.003);
  EXPECT_LE(report["max_error"].get<double>(), bound);
  EXPECT_LT(Read("loose.sac").size(), Read("clip.sac").size());
  Good({"decode", "clip.sac", "-o", "out.pc2"});
  EXPECT_LE(GoodJson({"compare", "in.obj", "in.pc2", "--with", "out.obj", "out.pc2", "--json"})["max_error"], bound);
  // The same in model units.
  std::ostringstream units;
  units.precision(17);
  units << bound;
  Encode("units.sac", {"--max-error", units.str(), "--keep-order"});
  EXPECT_EQ(Read("units.sac"), Read("clip.sac"));
  const Outcome refused = Sac({"encode", "in.obj", "in.pc2", "-o", "fine.sac", "--max-error", "1e-12d"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("in.obj: the largest error allowed, "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("; the smallest possible is "), std::string::npos) << refused.err;
}

TEST_F(EncodeTest, SearchesForTargets) {
  const nlohmann::json kg = EncodeJson("kg.sac", {"--target-kg", "1"});
  EXPECT_LE(kg["kg"], 1);
  EXPECT_GE(kg["kg"], 0.97);
  EXPECT_GT(kg["trials"], 1);
  EXPECT_EQ(kg["settings"]["target_kg"], 1);
  EXPECT_TRUE(kg["settings"]["target_sted"].is_null());
  EXPECT_EQ(kg["bytes"], Read("kg.sac").size());
  const std::string report = Encode("size.sac", {"--target-bpvf", "8"});
  EXPECT_NE(report.find("\nfound in "), std::string::npos) << report;
  EXPECT_NE(report.find(" trials: --motion-step "), std::string::npos) << report;
  const nlohmann::json size = EncodeJson("size.sac", {"--target-bpvf", "8", "--reference-rounds", "0"});
  EXPECT_LE(size["bpvf"], 8);
  EXPECT_GE(size["bpvf"], 0.97 * 8);
  // The report's settings give the same stream, if the shape does not depend on where the search began.
  const nlohmann::json& s = size["settings"];
  Encode("again.sac", {"--motion-step", s["motion_step"].dump(), "--displacement-step", s["displacement_step"].dump(),
                       "--detail-step", s["detail_step"].dump(), "--position-bits", s["position_bits"].dump(),
                       "--reference-rounds", "0"});
  EXPECT_EQ(Read("again.sac"), Read("size.sac"));
  for (const std::vector<std::string>& targets : std::vector<std::vector<std::string>>{
           {"--target-kg", "1", "--target-bpvf", "0.1"}, {"--target-bpvf", "0.01"}, {"--target-sted", "1e-6"}}) {
    std::vector<std::string> arguments{"encode", "in.obj", "in.pc2", "-o", "none.sac", "--harmonics", "5"};
    arguments.insert(arguments.end(), targets.begin(), targets.end());
    const Outcome outcome = Sac(arguments);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err.rfind("sac: in.obj: the target", 0), 0u) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(Path("none.sac")));
  }
}

TEST_F(EncodeTest, FitsTheReferenceShape) {
  const nlohmann::json first = EncodeJson("first.sac", {"--reference-rounds", "0"});
  EXPECT_EQ(first["fitted_reference"], false);
  EXPECT_EQ(first["settings"]["reference_rounds"], 0);
  const nlohmann::json report = EncodeJson("clip.sac", {});
  EXPECT_EQ(report["settings"]["reference_rounds"], 2);
  EXPECT_EQ(report["bytes"], Read("clip.sac").size());
  EXPECT_EQ(report["fitted_reference"], Read("clip.sac") != Read("first.sac"));
  Good({"verify", "clip.sac"});
  EncodeJson("unchecked.sac", {"--unchecked"});
  EXPECT_EQ(Read("unchecked.sac"), Read("first.sac"));
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "x.sac", "--reference-rounds", "17"}, 2,
                "--reference-rounds: '17' is not a whole number from 0 to 16 (see sac encode --help)");
}

TEST_F(EncodeTest, WritesToStandardOutput) {
  Encode("clip.sac");
  const Outcome outcome = Sac({"encode", "in.obj", "in.pc2", "-o", "-", "--harmonics", "30", "--group", "5", "--json"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, Read("clip.sac"));
  EXPECT_EQ(nlohmann::json::parse(outcome.err)["bytes"], outcome.out.size());
}

// The bytes of a frame are there before the next frame is read.
TEST_F(EncodeTest, LowDelay) {
  const nlohmann::json report = EncodeJson("clip.sac", {"--low-delay"});
  EXPECT_EQ(report["settings"]["low_delay"], true);
  EXPECT_EQ(report["settings"]["pyramid"], 1);
  EXPECT_EQ(report["bytes"], Read("clip.sac").size());
  const nlohmann::json info = GoodJson({"info", "clip.sac", "--json"});
  EXPECT_EQ(info["frames"], 12);
  EXPECT_EQ(info["groups"], 3);
  EXPECT_EQ(info["packets"][2]["frames"], 5);
  EXPECT_EQ(info["packets"][2]["low_delay"], true);
  std::uint64_t bytes = 4;
  for (const nlohmann::json& packet : info["packets"]) bytes += packet["bytes"].get<std::uint64_t>();
  EXPECT_EQ(bytes, Read("clip.sac").size());
  EXPECT_NE(Good({"info", "clip.sac"}).find("2 frames, low delay\n"), std::string::npos);
  Encode("whole.sac", {"--pyramid", "1", "--reference-rounds", "0"});  // low delay has the first frame
  EXPECT_EQ(GoodJson({"info", "whole.sac", "--json"})["packets"][2]["low_delay"], false);
  Good({"decode", "clip.sac", "-o", "clip.pc2"});
  Good({"decode", "whole.sac", "-o", "whole.pc2"});
  EXPECT_EQ(Read("clip.pc2"), Read("whole.pc2"));
  // Cut in the second group: its frames so far come out before the error.
  directory_.Write("cut.sac", Read("clip.sac").substr(0, Read("clip.sac").size() - 60));
  const Outcome cut = Sac({"decode", "cut.sac", "-o", "m_%02d.obj", "--frames", "0:8"});
  EXPECT_EQ(cut.code, 0) << cut.err;
  ExpectFailure({"encode", "in.obj", "in.pc2", "-o", "x.sac", "--low-delay", "--pyramid", "4"}, 2,
                "--pyramid excludes --low-delay (see sac encode --help)");
}

TEST_F(EncodeTest, EndsBeforeAFrameThatCannotBeCoded) {
  // Vertex 3 of frame 7 flies away: the third float of a point, behind 32 bytes of header.
  std::string cache = Read("in.pc2");
  const std::size_t points = (cache.size() - 32) / 12 / 12;
  const float far = 1e20f;
  std::memcpy(&cache[32 + (7 * points + 3) * 12 + 8], &far, sizeof far);
  directory_.Write("far.pc2", cache);
  const std::string fault = "far.pc2: frame 7, vertex 3: the motion is too far from the first frame for these steps";
  ExpectFailure({"encode", "in.obj", "far.pc2", "-o", "none.sac"}, 1, fault);
  EXPECT_FALSE(std::filesystem::exists(Path("none.sac")));
  const auto ends = [&](const std::string& output, std::vector<std::string> more) {
    more.insert(more.begin(), {"encode", "in.obj", "far.pc2", "-o", output});
    const Outcome outcome = Sac(more);
    EXPECT_EQ(outcome.code, 1);
    return outcome.err;
  };
  EXPECT_EQ(ends("5.sac", {"--group", "5", "--order-map", "5.map"}),
            "sac: " + fault + "; 5.sac has the 5 frames before\n");
  EXPECT_NE(Good({"info", "5.sac"}).find("frames                   5"), std::string::npos);
  Good({"decode", "5.sac", "-o", "five.pc2", "--order-map", "5.map"});
  EXPECT_EQ(ends("7.sac", {"--low-delay"}), "sac: " + fault + "; 7.sac has the 7 frames before\n");
  EXPECT_NE(Good({"info", "7.sac"}).find("frames                   7"), std::string::npos);
  // What is there is kept, and --strict leaves nothing.
  const std::string before = Read("7.sac");
  EXPECT_EQ(ends("7.sac", {"--low-delay", "--quality", "20"}), "sac: " + fault + "\n");
  EXPECT_EQ(Read("7.sac"), before);
  EXPECT_EQ(ends("strict.sac", {"--low-delay", "--strict"}), "sac: " + fault + "\n");
  EXPECT_FALSE(std::filesystem::exists(Path("strict.sac")));
}

TEST_F(EncodeTest, SaysThatTextureCoordinatesAreLost) {
  directory_.Write("m.obj", "v 0 0 0\nv 1 0 0\nvt 0 0\nvt 1 0\nf 1/1 2/2 2/2\n");  // nothing for Draco
  const Outcome outcome = Sac({"encode", "m.obj", "-o", "m.sac"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "sac: warning: m.obj: its texture coordinates cannot be coded, the stream has none\n");
  Good({"verify", "m.sac"});
}

TEST_F(EncodeTest, OrderMapIsAPermutation) {
  const nlohmann::json report = EncodeJson("clip.sac", {"--order-map", "map.txt"});
  std::istringstream lines(Read("map.txt"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "# sac order map, " + report["vertices"].dump() + " vertices");
  std::vector<int> order, all(report["vertices"].get<std::size_t>());
  while (std::getline(lines, line)) order.push_back(std::stoi(line));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_NE(order, all);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, all);
}

TEST_F(EncodeTest, FrameRate) {
  Good({"synth", "flag", "-o", "timed.mdd", "--vertices", "200", "--frames", "12"});
  const auto rate = [this](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", "rate.sac", "--harmonics", "5"});
    Good(arguments);
    const nlohmann::json header = GoodJson({"info", "rate.sac", "--json"})["header"];
    return header["frame_rate_numerator"].dump() + "/" + header["frame_rate_denominator"].dump();
  };
  EXPECT_EQ(rate({"encode", "in.obj", "in.pc2"}), "0/1");
  EXPECT_EQ(rate({"encode", "timed.obj", "timed.mdd"}), "30/1");
  EXPECT_EQ(rate({"encode", "timed.obj", "timed.mdd", "--fps", "25"}), "25/1");
  EXPECT_EQ(rate({"encode", "in.obj", "in.pc2", "--fps", "29.97"}), "30000/1001");
  // Through an MDD, whose times are float32, and back.
  Good({"decode", "rate.sac", "-o", "back.mdd"});
  EXPECT_EQ(rate({"encode", "back.obj", "back.mdd"}), "30000/1001");
  const nlohmann::json info = GoodJson({"info", "rate.sac", "--json"});
  EXPECT_NEAR(info["duration"].get<double>(), 12 * 1.001 / 30, 1e-12);
}

TEST_F(EncodeTest, SequenceOfMeshes) {
  Good({"synth", "vase", "-o", "m_%03d.ply", "--vertices", "200", "--frames", "4"});
  Good({"encode", "m_%03d.ply", "-o", "a.sac", "--harmonics", "20"});
  Good({"encode", "m_000.ply", "m_001.ply", "m_002.ply", "m_003.ply", "-o", "b.sac", "--harmonics", "20"});
  EXPECT_EQ(Read("a.sac"), Read("b.sac"));
  EXPECT_EQ(GoodJson({"info", "a.sac", "--json"})["frames"], 4);
}

TEST_F(EncodeTest, SingleMesh) {
  Good({"encode", "in.obj", "-o", "still.sac", "--harmonics", "20", "--keep-order"});
  Good({"decode", "still.sac", "-o", "still.obj"});
  EXPECT_LT(GoodJson({"compare", "in.obj", "--with", "still.obj", "--json"})["max_error"], 0.01);
}

class BadInputTest : public EncodeTest {
 protected:
  // A cache for in.obj whose third frame has `x` as a coordinate of vertex 7.
  void WriteCache(const std::string& name, float x, int extra_points) const {
    std::unique_ptr<CacheReader> in;
    ASSERT_TRUE(CacheReader::Open(Path("in.pc2"), in).ok());
    std::unique_ptr<CacheWriter> out;
    const std::size_t points = in->point_count() + static_cast<std::size_t>(extra_points);
    ASSERT_TRUE(CacheWriter::Open(Path(name), points, 24, std::nullopt, out).ok());
    Positions frame;
    for (std::uint32_t f = 0; f < 3; ++f) {
      ASSERT_TRUE(in->Read(f, frame).ok());
      frame.resize(points);
      if (f == 2) frame[7][1] = x;
      ASSERT_TRUE(out->Write(frame).ok());
    }
    ASSERT_TRUE(out->Commit().ok());
  }
};

TEST_F(BadInputTest, IsRefused) {
  WriteCache("nan.pc2", std::nanf(""), 0);
  WriteCache("inf.mdd", std::numeric_limits<float>::infinity(), 0);
  WriteCache("more.pc2", 0, 1);
  directory_.Write("empty.obj", "");
  directory_.Write("short.pc2", Read("in.pc2").substr(0, 1000));
  const std::string vertices = GoodJson({"compare", "in.obj", "--with", "in.obj", "--json"})["vertices"].dump();
  const auto encode = [](std::vector<std::string> inputs) {
    inputs.insert(inputs.begin(), "encode");
    inputs.insert(inputs.end(), {"-o", "bad.sac", "--order-map", "bad.map", "--harmonics", "5"});
    return inputs;
  };
  ExpectFailure(encode({"in.obj", "nan.pc2"}), 1, "nan.pc2: frame 2, vertex 7: not a finite number");
  ExpectFailure(encode({"in.obj", "inf.mdd"}), 1, "inf.mdd: frame 2, vertex 7: not a finite number");
  ExpectFailure(
      encode({"in.obj", "more.pc2"}), 1,
      "more.pc2: " + std::to_string(std::stoi(vertices) + 1) + " points, but in.obj has " + vertices + " vertices");
  ExpectFailure(encode({"in.obj", "absent.pc2"}), 1, "absent.pc2: No such file or directory");
  ExpectFailure(encode({"absent.obj"}), 1, "absent.obj: No such file or directory");
  ExpectFailure(encode({"absent_%d.obj"}), 1, "absent_%d.obj: no file matches");
  ExpectFailure(encode({"in.txt"}), 1, "in.txt: not a mesh file by its name (.obj, .ply, .off, .stl, .om)");
  EXPECT_EQ(Sac(encode({"empty.obj"})).code, 1);
  EXPECT_EQ(Sac(encode({"in.obj", "short.pc2"})).code, 1);
  EXPECT_FALSE(std::filesystem::exists(Path("bad.sac")));
}

TEST_F(EncodeTest, OutputThatCannotBeWritten) {
  const auto encode = [](const std::string& output, const std::string& map) {
    return std::vector<std::string>{"encode", "in.obj", "in.pc2", "-o", output, "--harmonics", "5", "--order-map", map};
  };
  ExpectFailure(encode("/dev/full", "map.txt"), 1, "/dev/full: No space left on device");
  ExpectFailure(encode("clip.sac", "/dev/full"), 1, "/dev/full: No space left on device");
  ExpectFailure(encode("absent/clip.sac", "map.txt"), 1, "absent/clip.sac: No such file or directory");
  ExpectFailure(encode("clip.sac", "absent/map.txt"), 1, "absent/map.txt: No such file or directory");
  ExpectFailure(encode(".", "map.txt"), 1, ".: Is a directory");
  const Outcome full = Shell(Quote(SAC_EXECUTABLE) + " encode in.obj in.pc2 -o - --harmonics 5 2>&1 > /dev/full");
  EXPECT_EQ(full.code, 1);
  EXPECT_EQ(full.out, "sac: standard output: No space left on device\n");
  // The stream must not take the place of a standard output that is closed, and have the report appended.
  Encode("clip.sac");
  const std::string to_closed = " encode in.obj in.pc2 -o closed.sac --harmonics 30 --group 5 2>&1 >&-";
  const Outcome no_output = Shell(Quote(SAC_EXECUTABLE) + to_closed);
  EXPECT_EQ(no_output.code, 1);
  EXPECT_EQ(no_output.out, "sac: standard output: Bad file descriptor\n");
  EXPECT_EQ(Read("closed.sac"), Read("clip.sac"));
  // The reader has gone before the first byte.
  const Outcome closed = Shell("{ " + Quote(SAC_EXECUTABLE) +
                               " encode in.obj in.pc2 -o - --harmonics 5 2> closed.err; echo $? > closed.code; } | :");
  EXPECT_EQ(closed.code, 0);
  EXPECT_EQ(Read("closed.code"), "1\n");
  EXPECT_EQ(Read("closed.err"), "sac: standard output: Broken pipe\n");
}

}  // namespace
}  // namespace sac
