// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace sac {

// Predictions are mixed as logits (spec.md 7.4): a logit is ln(p / (1 - p)) in 1/256, a probability is in 1/65536. Both
// are integers, so that every decoder mixes alike.
inline constexpr std::int32_t kMaxLogit = 2816;

// The probability of logit 128 k.
inline constexpr std::array<std::int32_t, 23> kLogisticCurve = {32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615,
                                                                64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500,
                                                                65514, 65523, 65528, 65531, 65533, 65534, 65535};

constexpr std::int32_t InterpolatedCurve(std::int32_t logit) {
  if (logit < 0) return 65536 - InterpolatedCurve(-logit);
  const auto k = static_cast<std::size_t>(logit / 128);
  if (k + 1 == kLogisticCurve.size()) return kLogisticCurve[k];
  return kLogisticCurve[k] + ((kLogisticCurve[k + 1] - kLogisticCurve[k]) * (logit % 128) + 64) / 128;
}

// The place of a logit from -kMaxLogit to kMaxLogit in a table.
constexpr std::size_t LogitIndex(std::int32_t logit) {
  const std::int32_t index = logit + kMaxLogit;
  return static_cast<std::size_t>(index);
}

struct LogisticTables {
  std::array<std::uint16_t, 2 * kMaxLogit + 1> probability{};
  std::array<std::int16_t, 4096> logit{};

  constexpr LogisticTables() {
    for (std::int32_t x = -kMaxLogit; x <= kMaxLogit; ++x) {
      probability[LogitIndex(x)] = static_cast<std::uint16_t>(InterpolatedCurve(x));
    }
    std::int32_t x = -kMaxLogit;
    for (std::size_t i = 0; i < logit.size(); ++i) {
      while (x < kMaxLogit && probability[LogitIndex(x)] < 16 * i + 8) ++x;
      logit[i] = static_cast<std::int16_t>(x);
    }
  }
};
extern const LogisticTables kLogisticTables;

inline std::int32_t Probability(std::int32_t logit) {
  return kLogisticTables.probability[LogitIndex(std::clamp(logit, -kMaxLogit, kMaxLogit))];
}

// The least logit whose probability is at least that of the middle of the sixteen values that share p >> 4.
inline std::int32_t Logit(std::uint32_t p) { return kLogisticTables.logit[p >> 4]; }

// The class of `x` in half octaves: 0, 1, 2 and 3 are their own classes, then 4 holds 4 and 5, 5 holds 6 and 7, 6 holds
// 8 to 11, two classes an octave.
inline std::uint32_t HalfOctave(std::uint32_t x) {
  if (x < 4) return x;
  const auto octave = static_cast<std::uint32_t>(std::bit_width(x)) - 1;
  return 2 * octave + ((x >> (octave - 1)) & 1);
}

}  // namespace sac
