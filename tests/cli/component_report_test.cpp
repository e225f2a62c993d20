// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class ComponentReportTest : public SacCommandOnClip {
 protected:
  // What the browser makes of the page, after its scripts have run; empty where there is no browser.
  std::string Opened(const std::string& page) const {
    if (Shell("command -v chromium").code != 0) return {};
    const Outcome browser = Shell(
        "HOME=$PWD chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--enable-logging=stderr --virtual-time-budget=8000 --dump-dom \"file://$PWD/" +
        page + "\"");
    EXPECT_EQ(browser.err.find("CONSOLE"), std::string::npos) << browser.err;
    return browser.out;
  }
};

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
  return n;
}

double NumberAfter(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? -1 : std::stod(text.substr(at + part.size()));
}

// The page draws each component and poses the liveliest frame, and asks nothing of the network.
TEST_F(ComponentReportTest, ShowsEachComponent) {
  const auto json = GoodJson({"components", "in.obj", "in.pc2", "--count", "4", "--report", "page", "--json"});
  const std::string page = Read("page/components.html");
  EXPECT_EQ(CountOf(page, "default-src 'none'"), 1u);
  for (const char* reference : {"src=", "href=", "@import", "url("}) {
    EXPECT_EQ(page.substr(0, 3000).find(reference), std::string::npos) << reference;
  }
  const std::string dom = Opened("page/components.html");
  if (dom.empty()) GTEST_SKIP() << "chromium is missing: the page was not opened";
  EXPECT_EQ(CountOf(dom, "data-ready=\"yes\""), 1u);
  EXPECT_EQ(CountOf(dom, "data-components=\"4\""), 1u);
  EXPECT_EQ(CountOf(dom, "class=\"picture\""), 4u);
  EXPECT_EQ(NumberAfter(dom, "data-triangles=\""), json["triangles"].get<double>());
  EXPECT_GT(NumberAfter(dom, "data-moved=\""), 0.01);
}

// The browser's own Poisson system moves vertices as far as the library's does.
TEST_F(ComponentReportTest, PosesGradientsAsTheLibraryDoes) {
  Good({"components", "in.obj", "in.pc2", "--count", "4", "--domain", "gradient", "--report", "page", "-o", "c.npz",
        "-o", "c.csv"});
  const std::string dom = Opened("page/components.html");
  if (dom.empty()) GTEST_SKIP() << "chromium is missing: the page was not opened";
  EXPECT_EQ(CountOf(dom, "data-components=\"4\""), 1u);
  Good({"pose", "c.npz", "--weights", "c.csv", "--no-track", "-o", "posed.pc2"});
  // The frame of the largest weights, as the page chooses it, and the largest change of a coordinate there.
  const Outcome numpy = Shell(
      "/usr/bin/python3 -c \"import numpy; c = numpy.load('c.npz'); "
      "y = numpy.frombuffer(open('posed.pc2', 'rb').read()[32:], '<f4').reshape(-1, *c['rest'].shape); "
      "print(abs(y[(c['weights'] ** 2).sum(1).argmax()] - c['rest']).max())\"");
  ASSERT_EQ(numpy.err, "");
  const double expected = std::stod(numpy.out);
  EXPECT_NEAR(NumberAfter(dom, "data-moved=\""), expected, 2e-3 * expected);
}

TEST_F(ComponentReportTest, LeavesNothingBehind) {
  ExpectFailure({"components", "in.obj", "in.pc2"}, 2, "--output or --report is required (see sac components --help)");
  ExpectFailure({"components", "in.obj", "in.pc2", "--count", "2", "--report", "in.obj"}, 1, "in.obj: Not a directory");
  ExpectFailure({"components", "in.obj", "in.pc2", "--count", "2", "--report", "page", "-o", "none/c.npz"}, 1,
                "none/c.npz: No such file or directory");
  EXPECT_FALSE(std::filesystem::exists(Path("page")));
}

}  // namespace
}  // namespace sac
