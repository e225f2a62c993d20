// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sac {

// The HTML of a report: page.html with page.js, Chart.js, three.js and `json` in it.
std::string ReportPage(const std::string& json);

}  // namespace sac
