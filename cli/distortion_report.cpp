// SPDX-License-Identifier: Apache-2.0
#include "cli/distortion_report.h"

namespace sac {

std::string JsonLine(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n'; }

void AddDistortion(const DistortionMetrics& metrics, Json& json) {
  json["kg"] = metrics.kg;
  json["sted"] = metrics.sted;
  json["sted_s"] = metrics.sted_s;
  json["sted_t"] = metrics.sted_t;
  json["max_error"] = metrics.max_error;
}

void PrintDistortion(const DistortionMetrics& metrics, std::FILE* file) {
  std::fprintf(file, "KG        %.6g %%\n", metrics.kg);
  std::fprintf(file, "STED      %.6g (spatial %.6g, temporal %.6g)\n", metrics.sted, metrics.sted_s, metrics.sted_t);
  std::fprintf(file, "max error %.6g model units\n", metrics.max_error);
}

}  // namespace sac
