// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "files/openmesh_input.h"
#include "files/text_scan.h"

namespace sac {

Status CleanOff(std::string_view bytes, std::string& cleaned) {
  std::string_view rest = bytes;
  std::string_view first = TakeLine(rest);
  const std::size_t keyword = first.find("OFF");
  if (keyword == std::string_view::npos || keyword > 4) return Status::Corrupt("not an OFF file");
  std::string_view after = first.substr(keyword + 3);
  if (TakeWord(after) == "BINARY") {
    cleaned = bytes;
    return Status::Ok();
  }
  cleaned = std::string(first.substr(0, keyword + 3)) + "\n";

  // The counts may follow OFF on its line.
  rest = bytes.substr(keyword + 3);
  bool has_counts = false;
  while (!rest.empty()) {
    std::string_view line = TakeLine(rest);
    line = line.substr(0, line.find('#'));
    std::string words;
    for (auto word = TakeWord(line); !word.empty(); word = TakeWord(line)) {
      if (!words.empty()) words += ' ';
      words += word;
    }
    if (words.empty()) continue;
    if (!has_counts) {
      // A vertex or a face takes a byte at least, so this bounds the reader's loops.
      std::string_view counts = words;
      std::int64_t vertices = 0, faces = 0;
      const auto bounded = [&](std::int64_t n) { return n >= 0 && static_cast<std::uint64_t>(n) <= bytes.size(); };
      if (!ParseInteger(TakeWord(counts), vertices) || !ParseInteger(TakeWord(counts), faces) || !bounded(vertices) ||
          !bounded(faces)) {
        return Status::Corrupt("cannot have the counts " + words + " in " + std::to_string(bytes.size()) + " bytes");
      }
      words = std::to_string(vertices) + " " + std::to_string(faces) + " 0";
      has_counts = true;
    }
    cleaned += words + "\n";
  }
  return has_counts ? Status::Ok() : Status::Corrupt("no counts");
}

}  // namespace sac
