// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "format/bit_model.h"

namespace sac {

// A coder that keeps bins and their probabilities, for a range code whose beginning is not known yet.
class RecordedBins {
 public:
  static constexpr bool kDecodes = false;

  void Bit(BitModel& model, bool& bit) {
    Decide(model.probability(), bit);
    model.Update(bit);
  }
  void Decide(std::uint32_t p, bool& bit) { bins_.push_back(2 * p + (bit ? 1 : 0)); }
  void Raw(std::uint32_t& value, int count) {
    for (int i = count - 1; i >= 0; --i) bins_.push_back((value >> i) & 1);
  }
  bool ok() const { return true; }

  // Codes all bins by `coder`, in their order.
  template <class Coder>
  void WriteTo(Coder& coder) const {
    for (const std::uint32_t bin : bins_) {
      std::uint32_t value = bin & 1;
      bool bit = value != 0;
      bin > 1 ? coder.Decide(bin >> 1, bit) : coder.Raw(value, 1);
    }
  }

 private:
  std::vector<std::uint32_t> bins_;  // 2 * probability + bin; the probability is 0 of a bin without a model
};

}  // namespace sac
