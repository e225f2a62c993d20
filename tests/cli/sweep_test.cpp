// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

// Every peer of these tests is a script: one that copies, one that fails.
constexpr const char* kCopyingPeer = R"(#!/bin/sh
case $1 in
  describe) echo '{"title": "a \"copy\", <said>", "version": "1", "parameter": "n", "settings": ["1", "2"]}' ;;
  encode) cp "$3" "$5" ;;
  decode) cp "$2" "$4" ;;
esac
)";
constexpr const char* kFailingPeer = R"(#!/bin/sh
case $1 in
  describe) echo '{"title": "one that fails", "parameter": "", "settings": ["only"]}' ;;
  *) echo "first line" >&2; echo "no luck today" >&2; exit 3 ;;
esac
)";

class SweepTest : public SacCommand {
 protected:
  SweepTest() {
    Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "12"});
    Shell("mkdir peers");
    AddPeer("xz", kCopyingPeer);
    AddPeer("zfp", kFailingPeer);
    AddPeer("fpzip", "#!/bin/sh\necho '{\"title\": \"not here\", \"missing\": \"no library\"}'\n");
  }

  void AddPeer(const std::string& name, const std::string& script) const {
    directory_.Write("peers/sac-peer-" + name, script);
    Shell("chmod +x peers/sac-peer-" + name);
  }

  std::string Sweep(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"sweep", "in.obj", "in.pc2", "-o", "report", "--qualities", "20,60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Good(arguments);
  }

  nlohmann::json Report() const { return nlohmann::json::parse(Read("report/sweep.json"), nullptr, false); }
};

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(SweepTest, Help) { EXPECT_NE(Good({"sweep", "--help"}).find("  sac sweep"), std::string::npos); }

TEST_F(SweepTest, ReportsOfOthersStay) {
  Shell("mkdir report; echo mine > report/sweep.html");
  const std::vector<std::string> sweep{"sweep", "in.obj", "in.pc2", "-o", "report", "--qualities", "20"};
  const Outcome refused = Sac(sweep);
  EXPECT_EQ(refused.code, 1);
  EXPECT_EQ(
      refused.err,
      "sac: report/sweep.html: is there already, without results of a sweep beside it; give another directory for "
      "the output, or --force\n");
  EXPECT_EQ(Read("report/sweep.html"), "mine\n");
  std::vector<std::string> forced = sweep;
  forced.push_back("--force");
  Good(forced);
  EXPECT_NE(Read("report/sweep.html"), "mine\n");
  Good(sweep);  // its own
}

TEST_F(SweepTest, NothingStaysWhereNothingWasMeasured) {
  EXPECT_EQ(Sac({"sweep", "absent.obj", "-o", "fresh"}).code, 1);
  EXPECT_EQ(Shell("test -e fresh").code, 1);
}

TEST_F(SweepTest, SaysWhatEncodeAndCompareSay) {
  Sweep({"--max-errors", "1e-3", "--also", "--reference previous"});
  const nlohmann::json report = Report();
  ASSERT_EQ(report["results"].size(), 5u);
  const std::vector<std::vector<std::string>> options{{"--quality", "20"},
                                                      {"--quality", "60"},
                                                      {"--max-error", "1e-3d"},
                                                      {"--quality", "20", "--reference", "previous"},
                                                      {"--quality", "60", "--reference", "previous"}};
  for (std::size_t i = 0; i < options.size(); ++i) {
    const nlohmann::json& result = report["results"][i];
    // Without attributes, as the sweep codes it.
    directory_.Write("plain.sh", "grep -E '^v ' in.obj; grep -E '^f ' in.obj | sed -E 's|/[0-9]*||g'");
    Shell("sh plain.sh > plain.obj.tmp && mv plain.obj.tmp plain.obj");
    std::vector<std::string> encode{"encode", "plain.obj",          "in.pc2", "-o", "x.sac",
                                    "--json", "--reference-rounds", "0"};
    encode.insert(encode.end(), options[i].begin(), options[i].end());
    const nlohmann::json said = GoodJson(encode);
    for (const char* name : {"bytes", "bpvf", "kg", "sted", "sted_s", "sted_t", "max_error"}) {
      EXPECT_EQ(result[name], said[name]) << i << " " << name;
    }
    for (const char* name : {"encode_cpu_s", "decode_cpu_s", "encode_s", "decode_s"})
      EXPECT_GT(result[name], 0) << name;
    for (const char* name : {"encode_peak_mb", "decode_peak_mb"}) EXPECT_GT(result[name], 1) << name;
  }
  EXPECT_EQ(report["clips"][0]["name"], "in");
  EXPECT_EQ(report["clips"][0]["frames"], 12);
  EXPECT_GT(report["bd_rates"][2]["percent"], 0) << "the frame before is a worse reference for this clip";
}

TEST_F(SweepTest, MeasuresWhatPeersDecode) {
  const std::vector<std::string> peers{"--peers", "xz,zfp,fpzip,draco", "--peer-directory", "peers"};
  const std::string out = Sweep(peers);
  EXPECT_NE(out.find("fpzip is missing: no library\n"), std::string::npos) << out;
  EXPECT_NE(out.find("draco is missing: there is no program sac-peer-draco in peers\n"), std::string::npos) << out;
  EXPECT_NE(out.find("in, zfp, only: no luck today\n"), std::string::npos) << out;
  EXPECT_NE(out.find("5 results, 1 failed"), std::string::npos) << out;
  const nlohmann::json report = Report();
  for (const std::size_t i : {2, 3}) {
    EXPECT_EQ(report["results"][i]["bytes"], Read("in.pc2").size());
    EXPECT_EQ(report["results"][i]["kg"], 0);
  }
  EXPECT_EQ(report["results"][3]["setting"], "n 2");
  EXPECT_EQ(report["results"][4]["error"], "no luck today");
  EXPECT_EQ(report["codecs"][4]["missing"].get<std::string>().rfind("there is no", 0), 0u);
  const std::vector<std::string> csv = Lines(Read("report/sweep.csv"));
  ASSERT_EQ(csv.size(), 6u);
  const auto fields = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  for (const std::string& line : csv) EXPECT_EQ(fields(line), fields(csv[0]));
  EXPECT_EQ(csv[5].rfind("in,zfp,only,,", 0), 0u);
  // A peer that comes to work is tried again; those that were measured are not.
  AddPeer("zfp", kCopyingPeer + std::string("# another\n"));
  const std::string again = Sweep(peers);
  EXPECT_EQ(again.find("in, xz"), std::string::npos) << again;
  EXPECT_NE(again.find("in, zfp, n 1: "), std::string::npos) << again;
}

TEST_F(SweepTest, GoesOnWhereItWasInterrupted) {
  Sweep();
  const nlohmann::json first = Report();
  EXPECT_EQ(Lines(Sweep()).size(), 1u) << "nothing is left to measure";
  EXPECT_EQ(Report(), first);
  // Half of a result is none.
  Shell("for f in report/results/*.json; do head -c 40 $f > half && mv half $f; break; done");
  EXPECT_EQ(Lines(Sweep()).size(), 2u);
  Shell("rm $(ls report/results/*.samples | head -n 1)");
  EXPECT_EQ(Lines(Sweep()).size(), 2u);
  EXPECT_EQ(Lines(Sweep({"--jobs", "2", "--max-errors", "0.01"})).size(), 2u) << "only what is new";
  // Another clip of the same name.
  Good({"synth", "sphere", "-o", "in.pc2", "--vertices", "162", "--frames", "11"});
  EXPECT_EQ(Lines(Sweep()).size(), 3u);
  // Nothing of the work is left beside the results.
  EXPECT_EQ(Lines(Shell("ls -A report").out),
            (std::vector<std::string>{"results", "sweep.csv", "sweep.html", "sweep.json"}));
}

TEST_F(SweepTest, GoesOnAfterItWasKilled) {
  // Its first encoding kills the sweep; the qualities of sac come before it.
  AddPeer("zfp",
          "#!/bin/sh\nif [ \"$1\" = encode ] && [ ! -e killed ]; then\n"
          "  : > killed; kill -KILL $PPID; sleep 1\nfi\n" +
              std::string(kCopyingPeer).substr(10));
  const std::vector<std::string> sweep{"sweep",  "in.obj", "in.pc2",  "-o",  "report",           "--qualities", "20,60",
                                       "--jobs", "1",      "--peers", "zfp", "--peer-directory", "peers"};
  EXPECT_NE(Sac(sweep).code, 0);
  EXPECT_EQ(Shell("ls report/sweep.html").code, 2);
  const std::string out = Good(sweep);
  EXPECT_EQ(out.find("in, sac, "), std::string::npos) << out;
  EXPECT_NE(out.find("in, zfp, n 1: "), std::string::npos) << out;
  EXPECT_EQ(Lines(Shell("ls -A report").out),
            (std::vector<std::string>{"results", "sweep.csv", "sweep.html", "sweep.json"}));
}

TEST_F(SweepTest, KeepsWhatWasMeasured) {
  Sweep();
  EXPECT_EQ(Lines(Sweep({"--keep"})).size(), 3u) << "nothing was kept before";
  EXPECT_EQ(Lines(Sweep({"--keep"})).size(), 1u);
  const nlohmann::json report = Report();
  for (const nlohmann::json& result : report["results"]) {
    const std::string stem = "report/results/" + result["key"].get<std::string>();
    EXPECT_EQ(Read(stem + ".stream").size(), result["bytes"]);
    const auto measured =
        GoodJson({"compare", "in.obj", "in.pc2", "--with", "in.obj", stem + ".decoded.pc2", "--json"});
    EXPECT_EQ(measured["kg"], result["kg"]);
  }
}

TEST_F(SweepTest, SeveralClips) {
  Good({"synth", "sphere", "-o", "s_%02d.ply", "--vertices", "42", "--frames", "3"});
  Good({"sweep", "in.obj", "in.pc2", "s_%02d.ply", "s_00.ply", "s_01.ply", "in.obj", "in.pc2", "-o", "report",
        "--qualities", "50"});
  const nlohmann::json clips = Report()["clips"];
  ASSERT_EQ(clips.size(), 4u);
  EXPECT_EQ(clips[1]["name"], "s");
  EXPECT_EQ(clips[1]["frames"], 3);
  EXPECT_EQ(clips[2]["name"], "s_00");
  EXPECT_EQ(clips[2]["frames"], 2);
  EXPECT_EQ(clips[3]["key"], clips[0]["key"]);
}

TEST_F(SweepTest, Errors) {
  const std::string end = " (see sac sweep --help)";
  const auto sweep = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"sweep", "in.obj", "in.pc2", "-o", "report"});
    return more;
  };
  ExpectFailure({"sweep", "in.obj", "in.pc2"}, 2, "--output is required" + end);
  ExpectFailure(sweep({"--qualities", "50,101"}), 2, "--qualities: '101' is not a number from 0 to 100" + end);
  ExpectFailure(sweep({"--qualities", ","}), 2, "--qualities: none" + end);
  ExpectFailure(sweep({"--max-errors", "1e-3d"}), 2, "--max-errors: '1e-3d' is not a number from 1e-30 to 1e+30" + end);
  ExpectFailure(sweep({"--jobs", "0"}), 2, "--jobs: '0' is not a whole number from 1 to 256" + end);
  const Outcome outcome = Sac(sweep({"--peers", "xz,lha"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.rfind("sac: --peers: 'lha' is not one of all, none, ", 0), 0u);
  ExpectFailure({"sweep", "in.obj", "in.pc2", "-o", "in.obj"}, 1, "in.obj: Not a directory");
  EXPECT_EQ(Sac({"sweep", "absent.obj", "-o", "report"}).err, "sac: absent.obj: No such file or directory\n");
}

// The page in a browser: everything is drawn, and nothing is asked of the network, which its policy forbids.
TEST_F(SweepTest, PageInABrowser) {
  if (Shell("command -v chromium").code != 0) GTEST_SKIP() << "chromium is missing: the page was not opened";
  Good({"synth", "sphere", "-o", "s_%02d.ply", "--vertices", "42", "--frames", "3"});
  Good({"sweep", "in.obj", "in.pc2", "s_%02d.ply", "-o", "report", "--qualities", "10,50,90", "--peers", "xz,zfp,fpzip",
        "--peer-directory", "peers"});
  const Outcome browser = Shell(
      "HOME=$PWD chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--enable-logging=stderr --virtual-time-budget=8000 --dump-dom file://$PWD/report/sweep.html");
  const std::string& dom = browser.out;
  ASSERT_NE(dom.find("data-ready=\"yes\""), std::string::npos) << browser.err;
  EXPECT_EQ(browser.err.find("CONSOLE"), std::string::npos) << browser.err;
  const auto count = [&dom](const std::string& text) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = dom.find(text, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  EXPECT_EQ(count("<section>"), 2u);
  // KG, STED and largest error have the three points of sac; the time of decoding also those of the two copies.
  EXPECT_EQ(count("data-points=\"3\""), 2u * 3);
  EXPECT_EQ(count("data-points=\"5\""), 2u);
  EXPECT_EQ(count("data-triangles="), 2u);
  EXPECT_EQ(count("data-triangles=\"0\""), 0u);
  EXPECT_EQ(count("class=\"rates\""), 2u);
  EXPECT_EQ(count("<option>"), 2u * 3);  // sac near KG 1 and 0.1, the copy
  EXPECT_EQ(count("not here: missing, no library"), 1u);
  EXPECT_EQ(count("Failed: zfp, only: no luck today"), 2u);
  EXPECT_EQ(count("<said>"), 0u);  // a title is text
  EXPECT_EQ(count("default-src 'none'"), 1u);
  for (const char* reference : {"src=", "href=", "@import", "url("}) {
    EXPECT_EQ(Read("report/sweep.html").substr(0, 3000).find(reference), std::string::npos) << reference;
  }
}

}  // namespace
}  // namespace sac
