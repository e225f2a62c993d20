// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <cstdint>

#include "report/embed.h"

#ifdef SAC_THREE_JS
SAC_EMBED(sac_chart_js, SAC_CHART_JS);
SAC_EMBED(sac_three_js, SAC_THREE_JS);
SAC_EMBED(sac_orbit_js, SAC_ORBIT_JS);
#endif

namespace sac {

#ifdef SAC_THREE_JS
std::string_view ChartScript() { return Embedded(sac_chart_js, sac_chart_js_end); }
std::string_view ThreeScript() { return Embedded(sac_three_js, sac_three_js_end); }
std::string_view OrbitScript() { return Embedded(sac_orbit_js, sac_orbit_js_end); }
#else
std::string_view ChartScript() { return {}; }
std::string_view ThreeScript() { return {}; }
std::string_view OrbitScript() { return {}; }
#endif

std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts) {
  std::string filled;
  for (const PagePart& part : parts) {
    const std::size_t at = page.find(part.mark);
    filled += page.substr(0, at);
    filled += part.content;
    page.remove_prefix(at + part.mark.size());
  }
  return filled += page;
}

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

std::string Base64(std::string_view bytes) {
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

}  // namespace sac
