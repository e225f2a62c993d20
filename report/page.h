// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sac {

// Puts contents into a page, each in place of its mark; marks stand in the page in this order.
struct PagePart {
  std::string_view mark, content;
};
std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts);

// JSON that may stand in a script element: each `<`, which could begin the end tag, is escaped.
std::string ForScriptElement(const std::string& json);

// The Base64 encoding of bytes (RFC 4648).
std::string Base64(std::string_view bytes);

// The text from `begin` to `end`, as SAC_EMBED has it.
inline std::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

// The libraries that pages use, empty where the program was built without them.
std::string_view ChartScript();
std::string_view ThreeScript();
std::string_view OrbitScript();

}  // namespace sac
