// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "format/integer_coder.h"
#include "format/range_coder.h"

namespace sac::bench {

// Arithmetic coding of order 0. The number of appearances of each symbol is sent first, then the symbols are coded with
// these frequencies.
struct SymbolCounts {
  std::vector<std::uint32_t> symbols;  // the symbols that appear, ascending
  std::vector<std::uint64_t> before;   // for each symbol the appearances of all before it; last, of all symbols
};

inline SymbolCounts CountSymbols(const std::vector<std::uint32_t>& values) {
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const std::uint32_t v : values) ++counts[v];
  SymbolCounts table;
  table.before.push_back(0);
  for (const auto& [symbol, count] : counts) {
    table.symbols.push_back(symbol);
    table.before.push_back(table.before.back() + count);
  }
  return table;
}

template <class Coder>
void CodeCounts(Coder& coder, SymbolCounts& table) {
  UnsignedModels size_models, gap_models, count_models;
  auto size = static_cast<std::uint32_t>(table.symbols.size());
  CodeUnsigned(coder, size_models, size);
  if constexpr (Coder::kDecodes) {
    table = {};
    table.before.push_back(0);
  }
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < size && coder.ok(); ++i) {
    std::uint32_t gap = Coder::kDecodes ? 0 : table.symbols[i] - next;
    auto more = static_cast<std::uint32_t>(Coder::kDecodes ? 0 : table.before[i + 1] - table.before[i] - 1);
    CodeUnsigned(coder, gap_models, gap);
    CodeUnsigned(coder, count_models, more);
    if constexpr (Coder::kDecodes) {
      table.symbols.push_back(next + gap);
      table.before.push_back(table.before.back() + more + 1);
    }
    next += gap + 1;
  }
}

// Codes a symbol by halving the table again and again. The probability of the upper half is its share of the
// appearances, so this takes as many bits as coding the symbol at once, but for the rounding of shares to 1/65536.
template <class Coder>
void CodeSymbol(Coder& coder, const SymbolCounts& table, std::uint32_t& value) {
  std::size_t low = 0, high = table.symbols.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    const std::uint64_t upper = table.before[high] - table.before[middle], all = table.before[high] - table.before[low];
    const auto share = static_cast<std::uint32_t>(std::clamp<std::uint64_t>((upper * 65536 + all / 2) / all, 1, 65535));
    bool in_upper = !Coder::kDecodes && value >= table.symbols[middle];
    coder.Decide(share, in_upper);
    (in_upper ? low : high) = middle;
  }
  if constexpr (Coder::kDecodes) value = table.symbols.empty() ? 0 : table.symbols[low];
}

}  // namespace sac::bench
