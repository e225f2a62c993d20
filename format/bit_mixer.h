// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "format/bit_model.h"
#include "format/logistic.h"

namespace sac {

// Mixes the logits of kInputs inputs with weights in 1/65536. The weights learn from every bin how reliable each input
// is (spec.md 7.4).
template <std::size_t kInputs>
class Mixer {
 public:
  using Inputs = std::array<std::int32_t, kInputs>;

  explicit Mixer(const Inputs& weights) : weights_(weights) {}

  std::int32_t Mix(const Inputs& inputs) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < kInputs; ++i) sum += static_cast<std::int64_t>(inputs[i]) * weights_[i];
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, -kMaxLogit, kMaxLogit));
  }

  // Updates the weights with the bin `bit`, for which Mix(inputs) returned `mixed`.
  void Learn(const Inputs& inputs, std::int32_t mixed, bool bit) {
    // Inputs are below 2^12 and errors below 2^14. Weights that a stream drives out of range wrap around.
    const std::int32_t error = (kRate * ((bit ? 65535 : 0) - Probability(mixed)) + 32) >> 6;
    for (std::size_t i = 0; i < kInputs; ++i) {
      const auto change = static_cast<std::uint32_t>((inputs[i] * error + 2048) >> 12);
      weights_[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(weights_[i]) + change);
    }
  }

 private:
  static constexpr std::int32_t kRate = 14;

  Inputs weights_;
};

// Codes a bin with the probability whose logit is the mean of the results of the mixers `first` and `second` on the
// same inputs. The first kModels inputs are the logits of `models`: they are filled in here, and the models are
// updated.
template <class Coder, std::size_t kInputs, std::size_t kModels>
void CodeMixed(Coder& coder, Mixer<kInputs>& first, Mixer<kInputs>& second, std::array<std::int32_t, kInputs>& inputs,
               const std::array<BitModel*, kModels>& models, bool& bit) {
  for (std::size_t i = 0; i < kModels; ++i) inputs[i] = models[i]->logit();
  const std::int32_t a = first.Mix(inputs), b = second.Mix(inputs);
  const std::int32_t p = std::clamp(Probability((a + b) >> 1), 24, 65536 - 24);
  coder.Decide(static_cast<std::uint32_t>(p), bit);
  first.Learn(inputs, a, bit);
  second.Learn(inputs, b, bit);
  for (BitModel* model : models) model->Update(bit);
}

}  // namespace sac
