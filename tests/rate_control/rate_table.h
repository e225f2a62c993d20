// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// What a synthetic clip comes to with some settings, a row of tests/rate_table.csv.
struct RateRow {
  std::string name;  // of the clip and the settings
  std::uint64_t bytes = 0;
  double kg = 0;  // percent
  double sted = 0;
};

// Encodes and measures all clips of the table.
Status MeasureRates(std::vector<RateRow>& rows);

std::string FormatRates(const std::vector<RateRow>& rows);
// False unless all lines are rows, under the header.
bool ParseRates(const std::string& text, std::vector<RateRow>& rows);

}  // namespace sac
