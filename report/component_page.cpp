// SPDX-License-Identifier: Apache-2.0
#include "report/component_page.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "report/embed.h"
#include "report/page.h"

#ifdef SAC_COMPONENT_HTML
SAC_EMBED(sac_component_html, SAC_COMPONENT_HTML);
SAC_EMBED(sac_component_js, SAC_COMPONENT_JS);
#endif

namespace sac {
namespace {

constexpr std::size_t kMostBytes = std::size_t{300} << 20;  // of numbers; strings of browsers end at 512 MB

template <class Value>
std::string Numbers(std::span<const Value> values) {
  return Base64({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

// Values are 16-bit integers times `scale`.
nlohmann::ordered_json ComponentJson(const SparseComponent& component) {
  float largest = 0;
  for (const float x : component.values) largest = std::max(largest, std::abs(x));
  const float scale = largest > 0 ? largest / 32767 : 1;
  std::vector<std::int16_t> values;
  values.reserve(component.values.size());
  for (const float x : component.values) values.push_back(static_cast<std::int16_t>(std::lround(x / scale)));
  nlohmann::ordered_json json;
  json["name"] = component.name;
  json["centre"] = component.centre;
  json["nodes"] = Numbers(std::span(component.nodes));
  json["scale"] = scale;
  json["values"] = Numbers(std::span<const std::int16_t>(values));
  return json;
}

}  // namespace

Status FormatComponentPage(const SparseComponents& components, const ComponentPageFacts& facts, std::string& page) {
#ifdef SAC_COMPONENT_HTML
  std::size_t bytes = 12 * (components.rest.size() + components.triangles.size()) + 4 * components.weights.size();
  for (const SparseComponent& c : components.components) bytes += 4 * c.nodes.size() + 2 * c.values.size();
  if (bytes > kMostBytes) {
    return Status::Limit("a page of " + std::to_string(bytes >> 20) + " MB of numbers is too large for browsers");
  }
  nlohmann::ordered_json json;
  json["title"] = facts.title;
  json["erms"] = facts.erms;
  json["max_error"] = facts.max_error;
  json["fps"] = facts.fps;
  json["domain"] = components.domain == ComponentDomain::kGradient ? "gradient" : "displacement";
  json["positive"] = components.positive;
  json["frames"] = components.frames();
  json["rest"] = Numbers(std::span(components.rest));
  json["triangles"] = Numbers(std::span(components.triangles));
  json["weights"] = Numbers(std::span(components.weights));
  json["still"] = components.still;
  json["components"] = nlohmann::ordered_json::array();
  for (const SparseComponent& c : components.components) json["components"].push_back(ComponentJson(c));
  const std::string data =
      ForScriptElement(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  page = FillPage(Embedded(sac_component_html, sac_component_html_end),
                  {{"/*CHART*/", ChartScript()},
                   {"/*THREE*/", ThreeScript()},
                   {"/*ORBIT*/", OrbitScript()},
                   {"/*DATA*/", data},
                   {"/*PAGE*/", Embedded(sac_component_js, sac_component_js_end)}});
  return Status::Ok();
#else
  static_cast<void>(components);
  static_cast<void>(facts);
  static_cast<void>(page);
  return Status::Unsupported("this program was built without Chart.js and three.js, which a page needs");
#endif
}

}  // namespace sac
