// SPDX-License-Identifier: Apache-2.0
// The other codecs of bench/peers, as sac sweep runs them.
#include <cmath>
#include <map>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

// gltfpack, which takes half a second to start, has a test of its own.
constexpr const char* kPeers = "sac2015,pca,draco,draco-animation,meshopt,zfp,fpzip,xz";

class PeersTest : public SacCommand {
 protected:
  // Results of each codec, in the order of its settings, from small to near.
  std::map<std::string, std::vector<nlohmann::json>> Sweep() const {
    Good({"sweep", "in.obj", "in.pc2", "-o", "report", "--qualities", "50", "--peers", kPeers, "--peer-directory",
          SAC_PEER_DIRECTORY});
    report_ = nlohmann::json::parse(Read("report/sweep.json"), nullptr, false);
    std::map<std::string, std::vector<nlohmann::json>> curves;
    for (const nlohmann::json& result : report_["results"]) curves[result["codec"]].push_back(result);
    return curves;
  }

  mutable nlohmann::json report_;
};

TEST_F(PeersTest, DecodeWhatTheyEncode) {
  Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "16"});
  const auto curves = Sweep();
  for (const char* built : {"sac", "pca", "draco", "draco-animation"}) EXPECT_EQ(curves.count(built), 1u) << built;
  const double diagonal = report_["clips"][0]["diagonal"];
  for (const auto& [name, curve] : curves) {
    for (const nlohmann::json& result : curve) EXPECT_FALSE(result.contains("error")) << result;
    const nlohmann::json &coarse = curve.front(), &fine = curve.back();
    if (name == "xz") {
      EXPECT_EQ(fine["max_error"], 0);
    } else {
      EXPECT_LT(fine["max_error"], 0.004 * diagonal) << name;
    }
    if (curve.size() == 1) continue;
    EXPECT_GT(fine["bytes"], coarse["bytes"]) << name;
    for (const char* measure : {"kg", "sted_s", "max_error"})
      EXPECT_LT(fine[measure], 0.5 * coarse[measure].get<double>()) << name;
  }
  // Half a step on each axis of a shape that grows by a ninth; the bound that was asked for.
  for (const char* name : {"draco", "meshopt"}) {
    for (std::size_t i = 0; curves.count(name) != 0 && i < curves.at(name).size(); ++i) {
      EXPECT_LT(curves.at(name)[i]["max_error"], 1.2 * diagonal * std::pow(0.5, 8.0 + static_cast<double>(i)))
          << name << i;
    }
  }
  if (curves.count("zfp") != 0) {
    EXPECT_LT(curves.at("zfp").front()["max_error"], std::sqrt(3.0) * 1e-2 * diagonal);
  }
}

TEST_F(PeersTest, MorphTargetsByGltfpack) {
  const std::string peer = Quote(SAC_PEER_DIRECTORY "/sac-peer-gltfpack");
  const Outcome described = Shell(peer + " describe");
  if (described.code != 0 || described.out.find("\"missing\"") != std::string::npos) {
    GTEST_SKIP() << "gltfpack is missing: " << described.out;
  }
  Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "9"});
  const Outcome outcome = Shell(peer + " encode in.obj in.pc2 -o a.glb --order-map m --setting 14 && " + peer +
                                " decode a.glb -o a.pc2 --order-map m");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto result = GoodJson({"compare", "in.obj", "in.pc2", "--with", "in.obj", "a.pc2", "--json"});
  EXPECT_EQ(result["frames"], 9);
  EXPECT_LT(result["kg"], 0.1);
  EXPECT_GT(result["kg"], 0);
}

TEST_F(PeersTest, PublishedSacAndItsSwitches) {
  Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "9"});
  const auto run = [&](const std::string& setting, const std::string& name) {
    const std::string peer = Quote(SAC_PEER_DIRECTORY "/sac-peer-sac2015");
    const Outcome outcome =
        Shell(peer + " encode in.obj in.pc2 -o " + name + ".bin --order-map m --setting " + setting + " && " + peer +
              " decode " + name + ".bin -o " + name + ".pc2 --order-map m");
    EXPECT_EQ(outcome.code, 0) << setting << outcome.err;
    return GoodJson({"compare", "in.obj", "in.pc2", "--with", "in.obj", name + ".pc2", "--json"});
  };
  // The arithmetic coder changes bytes alone; without it a coefficient takes its bits: 8 frames of 20 x 9.
  const auto coded = run("20/11", "coded"), raw = run("20/11/no-arithmetic", "raw"),
             finer = run("20/12/no-arithmetic", "finer");
  EXPECT_EQ(Read("coded.pc2"), Read("raw.pc2"));
  EXPECT_NE(Read("coded.bin"), Read("raw.bin"));
  EXPECT_NEAR(static_cast<double>(Read("finer.bin").size() - Read("raw.bin").size()), 8 * 20 * 9 / 8.0, 2);
  EXPECT_NE(run("20/11/no-polar", "j")["kg"], coded["kg"]);
  // With as many harmonics as vertices and many bits little is lost.
  EXPECT_LT(run("162/22", "near")["kg"], 0.2 * coded["kg"].get<double>());
  EXPECT_EQ(Read("near.pc2").substr(32, 12 * 162), Read("in.pc2").substr(32, 12 * 162))
      << "the first frame is lossless";
  const Outcome wrong = Shell(Quote(SAC_PEER_DIRECTORY "/sac-peer-sac2015") +
                              " encode in.obj in.pc2 -o x --order-map m --setting 20/11/no-such");
  EXPECT_EQ(wrong.code, 1);
}

TEST_F(PeersTest, PublishedSacReportsItsStepsAndParts) {
  Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "9"});
  const std::string peer = Quote(SAC_PEER_DIRECTORY "/sac-peer-sac2015");
  std::map<std::string, nlohmann::json> reports;
  for (const std::string setting : {"20/11", "20/11/no-arithmetic"}) {
    const Outcome outcome =
        Shell(peer + " encode in.obj in.pc2 -o a.bin --order-map m --setting " + setting + " --report encode.json && " +
              peer + " decode a.bin -o a.pc2 --order-map m --report decode.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json report = reports[setting] = nlohmann::json::parse(Read("encode.json"), nullptr, false);
    std::size_t bytes = 0, levels = 0;
    for (const auto& [part, size] : report["bytes"].items()) bytes += size.get<std::size_t>();
    EXPECT_EQ(bytes, Read("a.bin").size()) << setting;
    ASSERT_EQ(report["levels"].size(), 9u);
    for (const nlohmann::json& channel : report["levels"]) {
      for (const std::size_t count : channel["count"]) levels += count;
      EXPECT_LT(channel["level"].back(), 1 << 11);
    }
    EXPECT_EQ(levels, 8u * 20 * 9) << "frames, harmonics, channels";
    const nlohmann::json decoded = nlohmann::json::parse(Read("decode.json"), nullptr, false);
    for (const char* step : {"eigenvectors", "range", "polar", "projection", "quantization", "arithmetic_coding"})
      EXPECT_TRUE(report["seconds"][step].is_number()) << step;
    for (const char* step : {"eigenvectors", "arithmetic_decoding", "gradients_from_coefficients", "poisson"})
      EXPECT_TRUE(decoded["seconds"][step].is_number()) << step;
  }
  const nlohmann::json &coded = reports["20/11"]["bytes"], &raw = reports["20/11/no-arithmetic"]["bytes"];
  for (const char* part : {"connectivity", "header", "centres", "first_frame"}) EXPECT_EQ(coded[part], raw[part]);
  EXPECT_EQ(coded["centres"], 8 * 3 * 4);
  EXPECT_GT(coded["counts"], 0);
  EXPECT_EQ(raw["counts"], 0);
  EXPECT_NEAR(raw["coefficients"].get<double>(), 8 * 20 * 9 * 11 / 8.0, 4);

  const Outcome other = Shell(Quote(SAC_PEER_DIRECTORY "/sac-peer-pca") +
                              " encode in.obj in.pc2 -o b.bin --order-map m --setting 4 --report r.json");
  EXPECT_EQ(other.code, 1) << "other peers have nothing to report";
  EXPECT_NE(other.err.find("--report"), std::string::npos) << other.err;
}

// Two tetrahedra that meet in an edge (four triangles around it) and in a vertex with a third; a vertex of no triangle.
TEST_F(PeersTest, OddMeshesComeBackOrAreRefused) {
  const std::string mesh =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 0 0 -1\nv -1 0 0\nv -1 1 0\nv -1 0 1\nv 5 5 5\n"
      "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\nf 1 5 2\nf 1 6 5\nf 1 2 6\nf 2 5 6\nf 1 7 8\nf 1 8 9\nf 1 9 7\nf 7 9 8\n";
  for (const char* name : {"in_0.obj", "in_1.obj", "in_2.obj", "in_3.obj", "in_4.obj", "in_5.obj"})
    directory_.Write(name, mesh);
  Good({"sweep", "in_%d.obj", "-o", "report", "--qualities", "100", "--peers", kPeers, "--peer-directory",
        SAC_PEER_DIRECTORY});
  const nlohmann::json report = nlohmann::json::parse(Read("report/sweep.json"), nullptr, false);
  std::size_t refused = 0;
  for (const nlohmann::json& result : report["results"]) {
    const std::string codec = result["codec"];
    if (result.contains("error")) {
      EXPECT_NE(result["error"].get<std::string>().find("1 vertices would be lost"), std::string::npos) << result;
      EXPECT_EQ(codec, "draco") << result;
      ++refused;
    } else if (codec != "sac") {
      EXPECT_LT(result["max_error"], 0.06 * report["clips"][0]["diagonal"].get<double>()) << result;
    }
  }
  EXPECT_EQ(refused, 8u) << "Draco has no vertices without triangles";
}

}  // namespace
}  // namespace sac
