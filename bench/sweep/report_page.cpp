// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/report_page.h"

#include <cstdint>
#include <string_view>

// Embeds the bytes of a file in the program. C++20 has no #embed.
#define SAC_EMBED(symbol, path)                                                                         \
  __asm__(".section .rodata\n.global " #symbol "\n" #symbol ":\n.incbin \"" path "\"\n.global " #symbol \
          "_end\n" #symbol "_end:\n.byte 0\n.previous\n");                                              \
  extern "C" const char symbol[], symbol##_end[]

SAC_EMBED(sac_page_html, SAC_PAGE_HTML);
SAC_EMBED(sac_page_js, SAC_PAGE_JS);
SAC_EMBED(sac_shapes_js, SAC_SHAPES_JS);
SAC_EMBED(sac_chart_js, SAC_CHART_JS);
SAC_EMBED(sac_three_js, SAC_THREE_JS);
SAC_EMBED(sac_orbit_js, SAC_ORBIT_JS);

namespace sac {
namespace {

std::string_view View(const char* begin, const char* end) { return {begin, static_cast<std::size_t>(end - begin)}; }

// Escapes each `<`, which could begin the end tag of the script element that holds the JSON.
std::string ForScriptElement(const std::string& json) {
  std::string text;
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string Base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string ReportPage(const std::string& json) {
  const std::string data = ForScriptElement(json);
  const struct {
    std::string_view mark, content;
  } parts[] = {
      {"/*CHART*/", View(sac_chart_js, sac_chart_js_end)},    {"/*THREE*/", View(sac_three_js, sac_three_js_end)},
      {"/*ORBIT*/", View(sac_orbit_js, sac_orbit_js_end)},    {"/*DATA*/", data},
      {"/*SHAPES*/", View(sac_shapes_js, sac_shapes_js_end)}, {"/*PAGE*/", View(sac_page_js, sac_page_js_end)}};
  std::string_view rest = View(sac_page_html, sac_page_html_end);
  std::string page;
  for (const auto& part : parts) {
    const std::size_t at = rest.find(part.mark);
    page += rest.substr(0, at);
    page += part.content;
    rest.remove_prefix(at + part.mark.size());
  }
  return page += rest;
}

}  // namespace sac
