#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "format/logistic.h"

namespace sac {

// What one context has seen of a bin: a probability of 1, in 1/65536, and how often it was asked (spec.md 7.4).
class AdaptiveBit {
 public:
  // Nearer to 0, which says nothing, the less it has seen.
  std::int32_t logit() const { return Logit(probability_) * static_cast<std::int32_t>(kConfidence[count_]) >> 8; }

  void Update(bool bit) {
    if (bit) {
      probability_ = static_cast<std::uint16_t>(probability_ + (((65535u - probability_) * kRates[count_]) >> 16));
    } else {
      probability_ = static_cast<std::uint16_t>(probability_ - ((probability_ * kRates[count_]) >> 16));
    }
    if (count_ < kMostSeen) ++count_;
  }

 private:
  static constexpr std::size_t kMostSeen = 60;
  static constexpr std::array<std::uint32_t, kMostSeen + 1> kConfidence = [] {
    std::array<std::uint32_t, kMostSeen + 1> values{};
    for (std::uint32_t n = 0; n <= kMostSeen; ++n) values[n] = 512 * n / (2 * n + 3);
    return values;
  }();
  static constexpr std::array<std::uint32_t, kMostSeen + 1> kRates = [] {
    std::array<std::uint32_t, kMostSeen + 1> values{};
    for (std::uint32_t n = 0; n <= kMostSeen; ++n) values[n] = 655360 / (10 * n + 16);
    return values;
  }();

  std::uint16_t probability_ = 32768;
  std::uint16_t count_ = 0;
};

// Weights of some inputs' logits, in 1/65536, which learn from every bin how far each input is to be trusted.
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

  // After a bin for which it said `mixed`.
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

// Codes a bin whose probability is the mean, as logits, of what two mixers make of the same inputs. The first inputs
// are those of `states`, which Code() fills in and updates.
template <class Coder, std::size_t kInputs, std::size_t kStates>
void CodeMixed(Coder& coder, Mixer<kInputs>& first, Mixer<kInputs>& second, std::array<std::int32_t, kInputs>& inputs,
               const std::array<AdaptiveBit*, kStates>& states, bool& bit) {
  for (std::size_t i = 0; i < kStates; ++i) inputs[i] = states[i]->logit();
  const std::int32_t a = first.Mix(inputs), b = second.Mix(inputs);
  const std::int32_t p = std::clamp(Probability((a + b) >> 1), 24, 65536 - 24);
  coder.Decide(static_cast<std::uint32_t>(p), bit);
  first.Learn(inputs, a, bit);
  second.Learn(inputs, b, bit);
  for (AdaptiveBit* state : states) state->Update(bit);
}

}  // namespace sac
