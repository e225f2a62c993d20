// SPDX-License-Identifier: Apache-2.0
// Manual pages and completions are made of the options: they know each of them.
#include <algorithm>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/cli/sac_command.h"

namespace sac {
namespace {

class ReferenceTest : public SacCommand {
 protected:
  ReferenceTest() { Good({"reference", "made"}); }

  // What bash offers for the last of some words, sorted, a line each.
  std::string Offers(const std::string& words) const {
    const Outcome outcome = Shell("touch clip.sac; bash -c " + Quote("source made/bash/sac; COMP_WORDS=(" + words +
                                                                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _sac; "
                                                                     "printf '%s\\n' \"${COMPREPLY[@]}\" | sort"));
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  }

  bool Has(const std::string& program) const { return Shell("command -v " + program).code == 0; }
};

std::set<std::string> OptionsIn(const std::string& text) {
  static const std::regex kOption("--[a-z][a-z-]*");
  std::set<std::string> options;
  for (std::sregex_iterator at(text.begin(), text.end(), kOption), end; at != end; ++at) options.insert(at->str());
  return options;
}

TEST_F(ReferenceTest, EachOptionOfAHelpIsInItsPageAndCompletions) {
  const std::string zsh = Read("made/zsh/_sac");
  for (const std::string command : {"encode", "decode", "info", "verify", "compare", "synth"}) {
    const std::set<std::string> options = OptionsIn(Good({command, "--help"}));
    EXPECT_GE(options.size(), 1u) << command;
    std::string page = Read("made/man1/sac-" + command + ".1");
    page.erase(std::remove(page.begin(), page.end(), '\\'), page.end());
    const std::string offered = Offers("sac " + command + " -");
    for (const std::string& option : options) {
      EXPECT_NE(page.find(option), std::string::npos) << command << option;
      EXPECT_NE(zsh.find(option), std::string::npos) << command << option;
    }
    // A help also names options of other commands, in its text; all that bash offers are the command's own.
    for (const std::string& option : OptionsIn(offered)) EXPECT_EQ(options.count(option), 1u) << command << option;
    EXPECT_GE(OptionsIn(offered).size() + 3, options.size());
  }
}

TEST_F(ReferenceTest, BashOffersWhatFits) {
  EXPECT_EQ(Offers("sac dec"), "decode\n");
  EXPECT_EQ(Offers("sac encode --gaps ''"), "error\nhold\nskip\n");
  EXPECT_EQ(Offers("sac synth w"), "walker\n");
  EXPECT_EQ(Offers("sac info clip"), "clip.sac\n");
  EXPECT_EQ(Offers("sac encode x.obj --keep"), "--keep-order\n");
  EXPECT_EQ(Offers("sac encode x.obj --quality ''"), "\n");  // a number
  EXPECT_EQ(Offers("sac reference ''"), "\n");               // hidden
}

TEST_F(ReferenceTest, PagesAndCompletionsHaveNoErrors) {
  if (Has("man")) {
    const Outcome pages =
        Shell("for page in made/man1/*.1; do LC_ALL=C.UTF-8 man --warnings -l $page >/dev/null; done");
    EXPECT_EQ(pages.err, "");
  }
  if (Has("zsh")) {
    EXPECT_EQ(Shell("zsh -n made/zsh/_sac").err, "");
  }
  ExpectFailure({"reference", "/proc/none"}, 1, "/proc/none/man1: No such file or directory");
}

}  // namespace
}  // namespace sac
