// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sac {

// What a mesh file holds and a Mesh has no place for, by kind, in the order in which the reader met it.
class Losses {
 public:
  // `n` more things of the kind `what`, a plural.
  void Count(std::string_view what, std::uint64_t n = 1);

  // A thing with a name, which counts once however often it occurs.
  void Name(std::string_view what, std::string_view name);

  // As Name, but the names themselves are listed.
  void List(std::string_view what, std::string_view name);

  // All of another's.
  void Add(const Losses& other);

  // "groups (2), vertex properties (quality, flags)"; empty where nothing is lost.
  std::string Text() const;

 private:
  struct Kind {
    std::string what;
    std::uint64_t count = 0;
    std::set<std::string, std::less<>> names;
    std::vector<std::string> listed;  // in the order of the file
  };

  Kind& Find(std::string_view what);

  std::vector<Kind> kinds_;
};

}  // namespace sac
