// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/report_page.h"

#include "report/embed.h"
#include "report/page.h"

SAC_EMBED(sac_page_html, SAC_PAGE_HTML);
SAC_EMBED(sac_page_js, SAC_PAGE_JS);
SAC_EMBED(sac_shapes_js, SAC_SHAPES_JS);

namespace sac {

std::string ReportPage(const std::string& json) {
  const std::string data = ForScriptElement(json);
  return FillPage(Embedded(sac_page_html, sac_page_html_end),
                  {{"/*CHART*/", ChartScript()},
                   {"/*THREE*/", ThreeScript()},
                   {"/*ORBIT*/", OrbitScript()},
                   {"/*DATA*/", data},
                   {"/*SHAPES*/", Embedded(sac_shapes_js, sac_shapes_js_end)},
                   {"/*PAGE*/", Embedded(sac_page_js, sac_page_js_end)}});
}

}  // namespace sac
