// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace sac {

using Bytes = std::vector<std::uint8_t>;
using Lines = std::vector<std::string>;

// The fenced blocks of spec.md marked `example ID`, by id.
inline const std::map<std::string, Lines>& Examples() {
  static const std::map<std::string, Lines> examples = [] {
    std::map<std::string, Lines> found;
    std::ifstream file(SAC_SPEC);
    Lines* open = nullptr;
    for (std::string line; std::getline(file, line);) {
      if (line.rfind("```example ", 0) == 0) {
        open = &found[line.substr(11)];
      } else if (line.rfind("```", 0) == 0) {
        open = nullptr;
      } else if (open) {
        open->push_back(line);
      }
    }
    return found;
  }();
  return examples;
}

inline const Lines& Example(const std::string& id) {
  static const Lines kNone;
  const auto at = Examples().find(id);
  EXPECT_TRUE(at != Examples().end()) << "spec.md has no example " << id;
  return at == Examples().end() ? kNone : at->second;
}

inline std::vector<std::string> Words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

template <class Number>
std::vector<Number> Numbers(const std::vector<std::string>& words, std::size_t from) {
  std::vector<Number> numbers;
  for (std::size_t i = from; i < words.size(); ++i) numbers.push_back(static_cast<Number>(std::stod(words[i])));
  return numbers;
}

// The numbers of the example's lines that begin with `name`.
template <class Number>
std::vector<std::vector<Number>> Rows(const std::string& id, const std::string& name) {
  std::vector<std::vector<Number>> rows;
  for (const std::string& line : Example(id)) {
    const auto words = Words(line);
    if (!words.empty() && words[0] == name) rows.push_back(Numbers<Number>(words, 1));
  }
  return rows;
}

template <class Number>
std::vector<Number> Row(const std::string& id, const std::string& name) {
  const auto rows = Rows<Number>(id, name);
  EXPECT_EQ(rows.size(), 1u) << id << ": " << name;
  return rows.empty() ? std::vector<Number>() : rows[0];
}

// "left = AC 02" as {"left", "AC 02"}.
inline std::pair<std::string, std::string> Equation(const std::string& line) {
  const std::size_t at = line.find('=');
  std::string right = at + 2 <= line.size() ? line.substr(at + 2) : "";
  return {line.substr(0, at - 1), right};
}

inline Bytes Unhex(const std::string& text) {
  Bytes bytes;
  for (const std::string& word : Words(text)) {
    for (std::size_t i = 0; i + 1 < word.size() + 1; i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(word.substr(i, 2), nullptr, 16)));
    }
  }
  return bytes;
}

inline std::string Hex(const Bytes& bytes) {
  std::string text;
  char digits[4];
  for (const std::uint8_t b : bytes) {
    std::snprintf(digits, sizeof digits, "%02X", static_cast<unsigned>(b));
    if (!text.empty()) text += ' ';
    text += digits;
  }
  return text;
}

}  // namespace sac
