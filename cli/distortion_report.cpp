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
  json["seam_gap"] = metrics.seam_gap;
  json["worst_part"] = {{"kg", metrics.worst_part.kg},
                        {"max_error", metrics.worst_part.max_error},
                        {"first_vertex", metrics.worst_part.first_vertex},
                        {"vertices", metrics.worst_part.vertices}};
}

void PrintDistortion(const DistortionMetrics& metrics, std::FILE* file) {
  std::fprintf(file, "KG        %.6g %%\n", metrics.kg);
  std::fprintf(file, "STED      %.6g (spatial %.6g, temporal %.6g)\n", metrics.sted, metrics.sted_s, metrics.sted_t);
  std::fprintf(file, "max error %.6g model units\n", metrics.max_error);
  if (metrics.seam_gap > 0) std::fprintf(file, "seam gap  %.6g model units\n", metrics.seam_gap);
}

}  // namespace sac
