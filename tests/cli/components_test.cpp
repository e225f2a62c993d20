// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class ComponentsTest : public SacCommandOnClip {
 protected:
  std::string Text(const std::string& name, const std::string& text) const { return directory_.Write(name, text); }

  double KgOf(const std::string& decoded) const {
    const std::string mesh = decoded.substr(0, decoded.rfind('.')) + ".obj";
    return GoodJson({"compare", "in.obj", "in.pc2", "--with", mesh, decoded, "--json"})["kg"].get<double>();
  }
};

std::uint32_t Word(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

TEST_F(ComponentsTest, WritesAllThatItNames) {
  const auto json = GoodJson(
      {"components", "in.obj", "in.pc2", "-o", "c.npz", "-o", "c.glb", "-o", "c.csv", "--count", "10", "--json"});
  EXPECT_EQ(json["components"], 10);
  EXPECT_EQ(json["domain"], "displacement");
  EXPECT_EQ(json["frames"], 12);
  EXPECT_LT(json["erms"].get<double>(), 20);
  EXPECT_GT(json["gltf_rounding"].get<double>(), 0);
  EXPECT_LT(json["gltf_rounding"].get<double>(), 1e-3);
  // numpy reads the archive, and the sum of its parts is near the clip.
  const Outcome numpy = Shell(
      "/usr/bin/python3 -c \"import numpy, struct; c = numpy.load('c.npz'); "
      "x = c['rest'] + numpy.tensordot(c['weights'], c['components'], 1); "
      "x = numpy.einsum('fij,fvj->fvi', c['rotations'], x) + c['moves'][:, None]; "
      "y = numpy.frombuffer(open('in.pc2', 'rb').read()[32:], '<f4').reshape(x.shape); "
      "print(numpy.sqrt(((x - y) ** 2).mean()) * 1000 / numpy.ptp(y, axis=(0, 1)).max())\"");
  EXPECT_EQ(numpy.err, "");
  EXPECT_NEAR(std::stod(numpy.out), json["erms"].get<double>(), 1e-3 * json["erms"].get<double>());
  // The table has a line a frame.
  const std::string table = Read("c.csv");
  EXPECT_EQ(table.rfind("frame,component 0,", 0), 0u);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 13);
}

TEST_F(ComponentsTest, GltfHasTargetsAndTheirAnimation) {
  Good({"components", "in.obj", "in.pc2", "-o", "c.glb", "--count", "5"});
  const std::string glb = Read("c.glb");
  ASSERT_GT(glb.size(), 20u);
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(Word(glb, 4), 2u);
  EXPECT_EQ(Word(glb, 8), glb.size());
  const auto json = nlohmann::json::parse(glb.substr(20, Word(glb, 12)), nullptr, false);
  ASSERT_TRUE(json.is_object());
  const auto& mesh = json["meshes"][0];
  EXPECT_EQ(mesh["primitives"][0]["targets"].size(), 5u);
  EXPECT_EQ(mesh["extras"]["targetNames"].size(), 5u);
  const std::size_t vertices = json["accessors"][0]["count"];
  for (const auto& target : mesh["primitives"][0]["targets"]) {
    const auto& accessor = json["accessors"][target["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["count"], vertices);
    // One of the two: vertices that stay are left out where that is smaller.
    ASSERT_NE(accessor.contains("bufferView"), accessor.contains("sparse"));
    if (accessor.contains("sparse")) {
      EXPECT_LT(accessor["sparse"]["count"].get<std::size_t>(), vertices);
    }
  }
  const auto& animation = json["animations"][0];
  EXPECT_EQ(animation["channels"].size(), 3u);
  const auto& weights = animation["samplers"][0];
  EXPECT_EQ(json["accessors"][weights["output"].get<std::size_t>()]["count"], 12 * 5);
  for (const auto& view : json["bufferViews"]) {
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
              json["buffers"][0]["byteLength"].get<std::size_t>());
  }
}

TEST_F(ComponentsTest, WeightsComeBackAsTheClip) {
  for (const char* domain : {"displacement", "gradient"}) {
    const auto json = GoodJson({"components", "in.obj", "in.pc2", "-o", "c.npz", "-o", "c.csv", "--count", "20",
                                "--locality", "0.003", "--domain", domain, "--json"});
    Good({"pose", "c.npz", "--weights", "c.csv", "-o", "back.pc2", "--force"});
    EXPECT_LT(KgOf("back.pc2"), 6) << domain;
    // The weights of the clip for its own components are at least as good.
    const auto fitted = GoodJson({"components", "--fit", "c.npz", "in.obj", "in.pc2", "-o", "d.npz", "--json"});
    EXPECT_LT(fitted["erms"].get<double>(), 1.05 * json["erms"].get<double>()) << domain;
  }
}

TEST_F(ComponentsTest, EditsKeepTheRestOfThePerformance) {
  Good({"components", "in.obj", "in.pc2", "-o", "c.npz", "--count", "4"});
  Good({"pose", "c.npz", "--gain", "1=1", "--clip", "in.obj", "in.pc2", "-o", "same.pc2"});
  EXPECT_EQ(Read("same.pc2").substr(32), Read("in.pc2").substr(32));
  Good({"pose", "c.npz", "--gain", "1=2", "--offset", "component 2=0.1", "--clip", "in.obj", "in.pc2", "-o",
        "more.pc2"});
  EXPECT_GT(KgOf("more.pc2"), 0.1);
  // Straight into a stream, in the order of the mesh. A clip as small as this is warned of for its error.
  const Outcome stream = Sac({"pose", "c.npz", "--gain", "1=2", "--offset", "component 2=0.1", "--clip", "in.obj",
                              "in.pc2", "-o", "more.sac"});
  EXPECT_EQ(stream.code, 0) << stream.err;
  Good({"decode", "more.sac", "-o", "decoded.pc2"});
  const auto json = GoodJson({"compare", "more.obj", "more.pc2", "--with", "decoded.obj", "decoded.pc2", "--json"});
  EXPECT_LT(json["kg"].get<double>(), 5);
  const Outcome alone = Sac({"pose", "c.npz", "--gain", "1=2", "-o", "alone.pc2"});
  EXPECT_EQ(alone.code, 0);
  EXPECT_NE(alone.err.find("without --clip"), std::string::npos);
}

TEST_F(ComponentsTest, DragsAVertex) {
  Good({"components", "in.obj", "in.pc2", "-o", "c.npz", "--count", "6"});
  Text("drag.txt", "# the free corner\n199 1 1 1\n");
  const std::string out = Good({"pose", "c.npz", "--drag", "drag.txt", "--frame", "3", "-o", "posed.obj"});
  EXPECT_NE(out.find("model units from the targets"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(Path("posed.obj")));
}

TEST_F(ComponentsTest, StrokesAndStillVertices) {
  Text("corner.txt", "3\n4 # beside it\n");
  Text("pole.txt", "0\n1\n2\n");
  const auto json = GoodJson({"components", "in.obj", "in.pc2", "-o", "c.csv", "--count", "4", "--stroke", "corner.txt",
                              "--still", "pole.txt", "--json"});
  EXPECT_EQ(Read("c.csv").rfind("frame,corner,", 0), 0u);
}

TEST_F(ComponentsTest, AnErrorThatIsAskedForIsKept) {
  const auto json = GoodJson({"components", "in.obj", "in.pc2", "-o", "c.npz", "--error", "30", "--json"});
  EXPECT_LE(json["erms"].get<double>(), 30);
  EXPECT_GT(json["decompositions"].get<int>(), 0);
}

TEST_F(ComponentsTest, ReadsStreams) {
  Encode("clip.sac");
  EXPECT_EQ(GoodJson({"components", "clip.sac", "-o", "c.npz", "--count", "3", "--json"})["frames"], 12);
}

TEST_F(ComponentsTest, Refuses) {
  const std::string end = " (see sac components --help)", pose_end = " (see sac pose --help)";
  ExpectFailure({"components", "in.obj", "in.pc2", "-o", "c.obj"}, 2,
                "c.obj: not a file for components by its name (.npz, .glb or .csv)" + end);
  ExpectFailure({"components", "in.obj", "in.pc2", "-o", "c.npz", "--count", "3", "--error", "1"}, 2,
                "--count and --error exclude each other" + end);
  ExpectFailure({"components", "in.obj", "in.pc2", "-o", "c.glb", "--domain", "gradient"}, 2,
                "a .glb cannot hold components of gradients, which are no morph targets" + end);
  ExpectFailure({"components", "in.obj", "none.pc2", "-o", "c.npz"}, 1, "none.pc2: No such file or directory");
  Text("bad.txt", "5\n7 1 2\n");
  ExpectFailure({"components", "in.obj", "in.pc2", "-o", "c.npz", "--stroke", "bad.txt"}, 1,
                "bad.txt:2: a vertex has three numbers or none");
  Text("far.txt", "5000\n");
  EXPECT_EQ(Sac({"components", "in.obj", "in.pc2", "-o", "c.npz", "--stroke", "far.txt"}).code, 1);
  EXPECT_FALSE(std::filesystem::exists(Path("c.npz")));
  Text("c.npz", "no archive");
  ExpectFailure({"pose", "c.npz", "--weights", "w.csv", "-o", "x.pc2"}, 1, "c.npz: no .npz archive");
  ExpectFailure({"pose", "c.npz", "-o", "x.pc2"}, 2,
                "one of --weights, --drag, or --gain, --offset and --curve is needed" + pose_end);
  ExpectFailure({"pose", "c.npz", "--gain", "2", "-o", "x.pc2"}, 2,
                "--gain: '2' is no component and number such as 7=2" + pose_end);
  Good({"components", "in.obj", "in.pc2", "-o", "c.npz", "--count", "3"});
  ExpectFailure({"pose", "c.npz", "--gain", "9=2", "--clip", "in.obj", "in.pc2", "-o", "x.pc2"}, 1,
                "c.npz: has no component 9");
  Text("w.csv", "1,2\n");
  ExpectFailure({"pose", "c.npz", "--weights", "w.csv", "-o", "x.pc2"}, 1, "w.csv:1: 2 weights for 3 components");
  Text("w.csv", "1,2,nan\n");
  ExpectFailure({"pose", "c.npz", "--weights", "w.csv", "-o", "x.pc2"}, 1, "w.csv:1: 'nan' is no finite number");
}

// An option that would be ignored is a mistake of the user, who is told why.
TEST_F(ComponentsTest, RefusesOptionsWithoutEffect) {
  const std::string end = " (see sac components --help)", pose_end = " (see sac pose --help)";
  Good({"components", "in.obj", "in.pc2", "-o", "c.npz", "-o", "c.csv", "--count", "3"});
  for (const std::vector<std::string>& idle : std::vector<std::vector<std::string>>{{"--count", "3"},
                                                                                    {"--error", "3"},
                                                                                    {"--domain", "displacement"},
                                                                                    {"--locality", "0.03"},
                                                                                    {"--positive"},
                                                                                    {"--rest", "mean"},
                                                                                    {"--stroke", "s.txt"},
                                                                                    {"--still", "s.txt"},
                                                                                    {"--near", "0.1"},
                                                                                    {"--far", "0.5"},
                                                                                    {"--iterations", "9"},
                                                                                    {"--field-memory", "9"}}) {
    std::vector<std::string> arguments{"components", "--fit", "c.npz", "in.obj", "in.pc2", "-o", "d.npz"};
    arguments.insert(arguments.end(), idle.begin(), idle.end());
    ExpectFailure(arguments, 2,
                  idle[0] +
                      " has no effect with --fit, which takes the components of its file as they are and finds "
                      "weights alone" +
                      end);
  }
  const auto pose = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"pose", "c.npz"});
    return more;
  };
  const std::vector<std::string> weights{"--weights", "c.csv", "-o", "x.pc2"}, drag{"--drag", "d.txt", "-o", "x.obj"};
  const auto with = [&](std::vector<std::string> base, const std::vector<std::string>& more) {
    base.insert(base.end(), more.begin(), more.end());
    return pose(base);
  };
  ExpectFailure(with(weights, {"--clip", "in.obj", "in.pc2"}), 2,
                "--clip has no effect without --gain, --offset or --curve, which say what is edited in it" + pose_end);
  ExpectFailure(with(weights, {"--many"}), 2,
                "--many has no effect without --drag: it says how weights are found for what is dragged" + pose_end);
  ExpectFailure(with(drag, {"--many", "--price", "0"}), 2,
                "--many has no effect at --price 0: no component costs anything" + pose_end);
  ExpectFailure(with(drag, {"--no-track"}), 2,
                "--no-track has no effect on --drag: the shape stands where its --frame does" + pose_end);
  ExpectFailure(pose({"--gain", "1=2", "-o", "x.pc2", "--no-track"}), 2,
                "--no-track has no effect on edits, which leave the motion of the whole as it is" + pose_end);
  ExpectFailure(with(weights, {"--quality", "50"}), 2,
                "--quality has no effect on x.pc2, which is no .sac stream" + pose_end);
  ExpectFailure(with(drag, {"--force"}), 2,
                "--force has no effect on x.obj, which has no other file beside it" + pose_end);
  ExpectFailure(pose({"--gain", "1=2", "--gain", "component 1=3", "-o", "x.pc2"}), 1,
                "--gain: component 1 is there twice, and the second would replace the first");
}

TEST_F(ComponentsTest, ADamagedArchiveIsRefused) {
  Good({"components", "in.obj", "in.pc2", "-o", "c.npz", "--count", "3"});
  const std::string whole = Read("c.npz");
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{30}, std::size_t{0}}) {
    Text("c.npz", whole.substr(0, size));
    const Outcome outcome = Sac({"pose", "c.npz", "--offset", "1=1", "-o", "x.pc2"});
    EXPECT_EQ(outcome.code, 1) << size;
    EXPECT_EQ(outcome.err.rfind("sac: c.npz: ", 0), 0u) << outcome.err;
  }
  for (std::size_t at = 40; at < whole.size(); at += whole.size() / 40) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x41);
    Text("c.npz", bytes);
    const Outcome outcome = Sac({"pose", "c.npz", "--offset", "1=1", "-o", "x.pc2", "--force"});
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << at << outcome.err;
  }
}

}  // namespace
}  // namespace sac
