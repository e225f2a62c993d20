// SPDX-License-Identifier: Apache-2.0
#include "format/plane_models.h"

#include <algorithm>
#include <cstdlib>

#include "format/frame_syntax.h"
#include "format/integer_coder.h"

namespace sac {
namespace {

// What the mixers of each kind of bin begin with, in 1/64: learnt from clips that are not among those reported
// (docs/decisions.md).
using Weights = std::array<std::int32_t, ResidualContext::kStates + ResidualContext::kFeatures>;
using PlaneWeights = std::array<Weights, 3>;
constexpr PlaneWeights kMotionWeights = {{{23, 22, 18, 9, 17, 32, 113, 26, 0, -6, 64, -74},
                                          {19, 14, 9, 15, 4, 14, -6, 16, 3, 8, 32, -32},
                                          {8, 2, -4, 14, 6, 18, -2, 16, 8, 4, 12, -55}}};
constexpr PlaneWeights kDisplacementWeights = {{{26, 12, 16, 14, 7, 17, 42, 13, 8, 3, 34, -22},
                                                {22, 14, 21, 8, 2, 7, -20, 20, -8, 2, 13, -30},
                                                {12, 9, 14, 6, -8, 1, -23, 26, -5, -7, 6, -42}}};
constexpr PlaneWeights kDetailWeights = {{{42, 13, 16, -7, -13, 11, 51, 7, 30, -11, 47, -55},
                                          {45, 27, 2, 5, 10, 1, 12, 8, 5, -1, 25, -11},
                                          {31, 16, 5, 5, -11, 5, -30, 13, 6, 1, 19, -17}}};
constexpr std::array<const PlaneWeights*, kPlanes> kWeights = {&kMotionWeights, &kDisplacementWeights, &kDetailWeights,
                                                               &kDetailWeights};
constexpr std::int32_t kWeightUnit = 1024;
constexpr std::int32_t kSignWeight = 40;

Weights Scaled(Weights weights) {
  for (std::int32_t& w : weights) w *= kWeightUnit;
  return weights;
}

}  // namespace

PlaneModels::PlaneModels(std::size_t plane, const PlaneLayout& layout)
    : contexts(layout), sign_(SignMixer::Inputs{kSignWeight * kWeightUnit, kSignWeight * kWeightUnit}) {
  for (std::size_t i = 0; i < states_.size(); ++i) states_[i].resize(contexts.sizes()[i]);
  for (std::size_t i = 0; i < sign_states_.size(); ++i) sign_states_[i].resize(ResidualContexts::kSignContexts[i]);
  for (const Weights& weights : *kWeights[plane]) {
    const ResidualMixer mixer(Scaled(weights));
    by_level_.insert(by_level_.end(), ResidualContexts::kLevels, mixer);
    by_activity_.insert(by_activity_.end(), ResidualContexts::kActivities, mixer);
  }
  sign_by_level_.assign(ResidualContexts::kLevels, sign_);
}

template <class Coder>
void PlaneModels::CodeBin(Coder& coder, const ResidualContext& context, std::size_t bin, bool& value) {
  const std::size_t kind = std::min(bin, kKinds - 1);
  std::array<BitModel*, ResidualContext::kStates> states;
  for (std::size_t i = 0; i < states.size(); ++i) states[i] = &states_[i][context.states[i]][bin];
  ResidualMixer::Inputs inputs;
  std::copy(context.features.begin(), context.features.end(), inputs.begin() + states.size());
  CodeMixed(coder, by_level_[kind * ResidualContexts::kLevels + context.level],
            by_activity_[kind * ResidualContexts::kActivities + context.activity], inputs, states, value);
}

template <class Coder>
void PlaneModels::CodeSign(Coder& coder, const ResidualContext& context, bool& negative) {
  const std::array states = {&sign_states_[0][context.sign_states[0]], &sign_states_[1][context.sign_states[1]]};
  SignMixer::Inputs inputs;
  CodeMixed(coder, sign_by_level_[context.level], sign_, inputs, states, negative);
}

template <class Coder>
bool PlaneModels::Code(Coder& coder, const ResidualContext& context, std::int32_t& value) {
  bool nonzero = value != 0;
  CodeBin(coder, context, 0, nonzero);
  if (!nonzero) {
    value = 0;
    return true;
  }
  bool negative = value < 0;
  CodeSign(coder, context, negative);
  auto magnitude = static_cast<std::uint32_t>(std::abs(value));  // of no meaning yet to a decoder
  const std::uint32_t unary =
      CodeUnary<Coder>(magnitude, kUnary, [&](std::size_t bin, bool& more) { CodeBin(coder, context, bin, more); });
  if (unary <= kUnary) {
    magnitude = unary;
  } else {  // Exp-Golomb of what is over 15
    std::uint32_t rest = magnitude - 15 + 1;
    std::size_t width = 0;
    if constexpr (!Coder::kDecodes) {
      while ((rest >> (width + 1)) != 0) ++width;
    }
    for (std::size_t i = 0; i < escape_.size(); ++i) {
      bool more = i < width;
      coder.Bit(escape_[i], more);
      if (!more) break;
      if constexpr (Coder::kDecodes) width = i + 1;
    }
    std::uint32_t low = rest & ((1u << width) - 1);
    coder.Raw(low, static_cast<int>(width));
    if constexpr (Coder::kDecodes) magnitude = ((1u << width) | low) - 1 + 15;
  }
  value = negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
  return magnitude <= kMaxResidual;
}

template bool PlaneModels::Code(RangeEncoder&, const ResidualContext&, std::int32_t&);
template bool PlaneModels::Code(RangeDecoder&, const ResidualContext&, std::int32_t&);

}  // namespace sac
