// SPDX-License-Identifier: Apache-2.0
// Writes the table of sizes and errors that rate_table_test compares: make_rate_table FILE

#include <cstdio>
#include <fstream>

#include "tests/rate_control/rate_table.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_rate_table FILE\n", stderr);
    return 2;
  }
  std::vector<sac::RateRow> rows;
  if (const sac::Status status = sac::MeasureRates(rows); !status.ok()) {
    std::fprintf(stderr, "make_rate_table: %s\n", status.message().c_str());
    return 1;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << sac::FormatRates(rows) << std::flush;
  if (file) return 0;
  std::fprintf(stderr, "make_rate_table: %s: cannot be written\n", argv[1]);
  return 1;
}
