// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "metrics/error_meter.h"

namespace sac {

// Keys stay in the order in which they are set. Figures that are not finite print as null.
using Json = nlohmann::ordered_json;

// One line. A file name in it may be any bytes; JSON is UTF-8.
std::string JsonLine(const Json& json);

void AddDistortion(const DistortionMetrics& metrics, Json& json);
void PrintDistortion(const DistortionMetrics& metrics, std::FILE* file);

}  // namespace sac
