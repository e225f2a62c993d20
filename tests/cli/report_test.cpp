// SPDX-License-Identifier: Apache-2.0
// info, verify, compare and synth.
#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class ReportTest : public SacCommandOnClip {};

TEST_F(ReportTest, InfoTellsEveryPacket) {
  Encode("clip.sac", {"--keep-order", "--fps", "30000/1001", "--position-bits", "11"});
  const nlohmann::json info = GoodJson({"info", "clip.sac", "--json"});
  EXPECT_EQ(info["complete"], true);
  EXPECT_EQ(info["bytes"], Read("clip.sac").size());
  EXPECT_EQ(info["frames"], 12);
  EXPECT_EQ(info["groups"], 3);
  EXPECT_EQ(info["components"], 1);
  EXPECT_EQ(info["keeps_order"], true);
  EXPECT_EQ(info["attributes"], nlohmann::json({"texture_coordinates"}));
  EXPECT_EQ(info["header"]["position_bits"], 11 + 5);
  EXPECT_EQ(info["header"]["harmonics"], 30);
  EXPECT_NEAR(info["duration"].get<double>(), 12 * 1001.0 / 30000, 1e-12);
  std::vector<std::string> types;
  std::vector<int> frames;
  std::size_t bytes = 4;  // the magic
  for (const nlohmann::json& packet : info["packets"]) {
    types.push_back(packet["type"]);
    if (packet.contains("frames")) frames.push_back(packet["frames"]);
    bytes += packet["bytes"].get<std::size_t>();
  }
  EXPECT_EQ(types, (std::vector<std::string>{"header", "i_frame", "group", "group", "group", "end"}));
  EXPECT_EQ(frames, (std::vector<int>{5, 5, 2}));
  EXPECT_EQ(bytes, Read("clip.sac").size());
  EXPECT_EQ(GoodJson({"info", "-", "--json"}, Path("clip.sac")), info);

  const std::string text = Good({"info", "clip.sac"});
  EXPECT_EQ(text.rfind("clip.sac: " + std::to_string(Read("clip.sac").size()) + " bytes\n", 0), 0u);
  for (const auto& [name, value] : info["header"].items()) EXPECT_NE(text.find("\n" + name + " "), std::string::npos);
  EXPECT_NE(text.find(" 2 frames\n"), std::string::npos);
  EXPECT_NE(text.find("0.4004 seconds\n"), std::string::npos);
}

TEST_F(ReportTest, InfoOfOtherClips) {
  Good({"synth", "parts", "-o", "p_%d.ply", "--vertices", "60", "--frames", "2"});
  Good({"encode", "p_%d.ply", "-o", "p.sac", "--harmonics", "1"});
  nlohmann::json info = GoodJson({"info", "p.sac", "--json"});
  EXPECT_GT(info["components"], 1);
  EXPECT_EQ(info["attributes"], nlohmann::json({"colors"}));
  EXPECT_EQ(info["keeps_order"], false);
  EXPECT_TRUE(info["duration"].is_null());
  Good({"synth", "sphere", "-o", "s.ply", "--vertices", "60", "--frames", "1"});
  Good({"encode", "s.ply", "-o", "s.sac", "--harmonics", "10"});
  EXPECT_EQ(GoodJson({"info", "s.sac", "--json"})["attributes"], nlohmann::json({"normals"}));
}

TEST_F(ReportTest, InfoOfDamagedStreams) {
  Encode("clip.sac");
  const nlohmann::json whole = GoodJson({"info", "clip.sac", "--json"});
  const std::string stream = Read("clip.sac");
  directory_.Write("short.sac", stream.substr(0, stream.size() - 30));
  Outcome outcome = Sac({"info", "short.sac", "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "sac: short.sac: the stream is truncated after frame 10\n");
  const nlohmann::json info = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(info["complete"], false);
  EXPECT_EQ(info["error"], "short.sac: the stream is truncated after frame 10");
  EXPECT_EQ(info["header"], whole["header"]);
  EXPECT_EQ(info["frames"], 10);
  EXPECT_EQ(info["packets"].size(), 4u);
  EXPECT_EQ(info["bytes"], stream.size() - 30);
  outcome = Sac({"info", "short.sac"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("\nframes                   10\n"), std::string::npos);

  directory_.Write("longer.sac", stream + stream);
  outcome = Sac({"info", "longer.sac", "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["error"], "longer.sac: bytes after the end of the stream");
  directory_.Write("empty.sac", "");
  ExpectFailure({"info", "empty.sac"}, 1, "empty.sac: the stream is empty");
  ExpectFailure({"info", "in.obj"}, 1, "in.obj: not a .sac stream");
  ExpectFailure({"info", "absent.sac"}, 1, "absent.sac: No such file or directory");
  ExpectFailure({"info", "."}, 1, ".: Is a directory");
}

TEST_F(ReportTest, Verify) {
  Encode("clip.sac");
  const nlohmann::json header = GoodJson({"info", "clip.sac", "--json"})["header"];
  const std::string stream = Read("clip.sac");
  const std::string sound = ": ok, 12 frames, " + header["vertices"].dump() + " vertices, " +
                            header["triangles"].dump() + " triangles, " + std::to_string(stream.size()) + " bytes\n";
  EXPECT_EQ(Good({"verify", "clip.sac"}), "clip.sac" + sound);
  EXPECT_EQ(Good({"verify", "-"}, Path("clip.sac")), "standard input" + sound);
  directory_.Write("short.sac", stream.substr(0, stream.size() - 1));
  ExpectFailure({"verify", "short.sac"}, 1, "short.sac: the stream is truncated after frame 12");
  directory_.Write("longer.sac", stream + stream);
  ExpectFailure({"verify", "longer.sac"}, 1, "longer.sac: bytes after the end of the stream");
  ExpectFailure({"verify", "in.pc2"}, 1, "in.pc2: not a .sac stream");
  // A flipped bit anywhere.
  std::size_t sound_streams = 0;
  for (std::size_t at = 0; at < stream.size(); at += 61) {
    std::string damaged = stream;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    directory_.Write("damaged.sac", damaged);
    sound_streams += Sac({"verify", "damaged.sac"}).code != 1;
  }
  EXPECT_EQ(sound_streams, 0u);
}

TEST_F(ReportTest, Compare) {
  const nlohmann::json same = GoodJson({"compare", "in.obj", "in.pc2", "--with", "in.obj", "in.pc2", "--json"});
  for (const char* figure : {"kg", "sted", "sted_s", "sted_t", "max_error"}) EXPECT_EQ(same[figure], 0) << figure;
  EXPECT_EQ(same["frames"], 12);
  EXPECT_EQ(same["vertices"], (Read("in.pc2").size() - 32) / 144);
  EXPECT_EQ(Good({"compare", "in.obj", "in.pc2", "--with", "in.obj", "in.pc2"}),
            "12 frames, " + same["vertices"].dump() +
                " vertices\n"
                "KG        0 %\n"
                "STED      0 (spatial 0, temporal 0)\n"
                "max error 0 model units\n");
  ExpectFailure({"compare", "in.obj", "in.pc2", "--with", "in.obj"}, 1, "in.obj: 1 frames, but in.obj has 12");
  Good({"synth", "flag", "-o", "other.pc2", "--vertices", "100", "--frames", "12"});
  const Outcome outcome = Sac({"compare", "in.obj", "in.pc2", "--with", "other.obj", "other.pc2"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err.rfind("sac: other.obj: ", 0), 0u);
  EXPECT_NE(outcome.err.find(" vertices, but in.obj has " + same["vertices"].dump()), std::string::npos);

  // A known distance, in one vertex of one of two frames; a figure that is no number is null.
  directory_.Write("a_0.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  directory_.Write("a_1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  directory_.Write("b_0.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  directory_.Write("b_1.obj", "v 0 0 0\nv 4 4 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(GoodJson({"compare", "a_%d.obj", "--with", "b_%d.obj", "--json"})["max_error"], 5);
  directory_.Write("dot.obj", "v 0 0 0\n");
  directory_.Write("off.obj", "v 0 0 1\n");
  EXPECT_TRUE(GoodJson({"compare", "dot.obj", "--with", "off.obj", "--json"})["kg"].is_null());
}

TEST_F(ReportTest, Synth) {
  for (const auto& [kind, vertices] : {std::pair<std::string, std::string>{"walker", "2000"},
                                       {"flag", "300"},
                                       {"sphere", "300"},
                                       {"parts", "300"},
                                       {"vase", "300"}}) {
    EXPECT_EQ(Good({"synth", kind, "-o", "a.pc2", "--force", "--vertices", vertices, "--frames", "3"}), "");
    Good({"synth", kind, "-o", "b.pc2", "--force", "--vertices", vertices, "--frames", "3", "--seed", "1"});
    Good({"synth", kind, "-o", "c.pc2", "--force", "--vertices", vertices, "--frames", "3", "--seed", "2"});
    EXPECT_EQ(Read("a.pc2"), Read("b.pc2")) << kind;
    EXPECT_NE(Read("a.pc2"), Read("c.pc2")) << kind;
    EXPECT_EQ(GoodJson({"compare", "a.obj", "a.pc2", "--with", "b.obj", "b.pc2", "--json"})["frames"], 3) << kind;
  }
  ExpectFailure({"synth", "flag", "-o", "absent/x.pc2"}, 1, "absent/x.pc2: No such file or directory");
}

}  // namespace
}  // namespace sac
