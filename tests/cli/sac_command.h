// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_directory.h"

namespace sac {

// What a run of the command came to.
struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string Quote(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// Runs the sac executable in a directory of its own, so that names and messages are short and files can be counted.
class SacCommand : public testing::Test {
 protected:
  // `input` is a file for standard input.
  Outcome Sac(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") const {
    std::string command = Quote(SAC_EXECUTABLE);
    for (const std::string& argument : arguments) command += " " + Quote(argument);
    return Shell(command + " < " + Quote(input));
  }

  Outcome Shell(const std::string& command) const {
    const std::string script = "cd " + Quote(Path("")) + " && ( " + command + " ) > " + Quote(streams_.Path("out")) +
                               " 2> " + Quote(streams_.Path("err"));
    const int status = std::system(script.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, streams_.Read("out"), streams_.Read("err")};
  }

  // Runs a command that must succeed and be silent on standard error; returns its standard output.
  std::string Good(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") const {
    const Outcome outcome = Sac(arguments, input);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  }

  nlohmann::json GoodJson(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") const {
    const std::string out = Good(arguments, input);
    // One object on one line.
    EXPECT_EQ(out.find('\n'), out.size() - 1);
    return nlohmann::json::parse(out, nullptr, false);
  }

  // A run that must fail with one line, say nothing else and leave no file behind.
  void ExpectFailure(const std::vector<std::string>& arguments, int code, const std::string& message,
                     const std::string& input = "/dev/null") const {
    const std::size_t files = directory_.FileCount();
    const Outcome outcome = Sac(arguments, input);
    EXPECT_EQ(outcome.code, code) << message;
    EXPECT_EQ(outcome.err, "sac: " + message + "\n");
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(directory_.FileCount(), files) << message;
  }

  std::string Path(const std::string& name) const { return directory_.Path(name); }
  std::string Read(const std::string& name) const { return directory_.Read(name); }

  TestDirectory directory_;

 private:
  TestDirectory streams_;
};

// With a small clip: in.obj, in.pc2, 12 frames.
class SacCommandOnClip : public SacCommand {
 protected:
  SacCommandOnClip() { Good({"synth", "flag", "-o", "in.pc2", "--vertices", "200", "--frames", "12"}); }

  std::string Encode(const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"encode", "in.obj", "in.pc2", "-o", output, "--harmonics", "30", "--group", "5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Good(arguments);
  }
};

}  // namespace sac
