// SPDX-License-Identifier: Apache-2.0
#include "files/losses.h"

#include <algorithm>

namespace sac {

Losses::Kind& Losses::Find(std::string_view what) {
  const auto found = std::find_if(kinds_.begin(), kinds_.end(), [what](const Kind& kind) { return kind.what == what; });
  if (found != kinds_.end()) return *found;
  kinds_.emplace_back().what = what;
  return kinds_.back();
}

void Losses::Count(std::string_view what, std::uint64_t n) {
  if (n > 0) Find(what).count += n;
}

void Losses::Name(std::string_view what, std::string_view name) {
  Kind& kind = Find(what);
  if (kind.names.find(name) == kind.names.end()) kind.names.emplace(name);
  kind.count = kind.names.size();
}

void Losses::List(std::string_view what, std::string_view name) {
  constexpr std::size_t kMostNames = 8, kMostLetters = 40;
  Name(what, name);
  Kind& kind = Find(what);
  if (kind.count == kind.listed.size() || kind.listed.size() > kMostNames) return;
  std::string shown(name.substr(0, kMostLetters));
  // The name comes from a file and goes to a terminal.
  for (char& c : shown) c = static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? '?' : c;
  kind.listed.push_back(kind.listed.size() == kMostNames ? "..." : shown);
}

void Losses::Add(const Losses& other) {
  for (const Kind& kind : other.kinds_) {
    if (kind.names.empty()) Count(kind.what, kind.count);
    for (const std::string& name : kind.names) kind.listed.empty() ? Name(kind.what, name) : List(kind.what, name);
  }
}

std::string Losses::Text() const {
  std::string text;
  for (const Kind& kind : kinds_) {
    if (!text.empty()) text += ", ";
    text += kind.what + " (";
    if (kind.listed.empty()) text += std::to_string(kind.count);
    for (std::size_t i = 0; i < kind.listed.size(); ++i) text += (i == 0 ? "" : ", ") + kind.listed[i];
    text += ")";
  }
  return text;
}

}  // namespace sac
