// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/bit_mixer.h"
#include "format/plane_layout.h"
#include "format/range_coder.h"
#include "format/residual_contexts.h"

namespace sac {

// The adaptive models of a plane's residuals (spec.md 7.4).
class PlaneModels {
 public:
  PlaneModels(std::size_t plane, const PlaneLayout& layout);

  ResidualContexts contexts;

  // Writes or reads a residual. Returns false when its magnitude is out of range.
  template <class Coder>
  bool Code(Coder& coder, const ResidualContext& context, std::int32_t& value);

 private:
  static constexpr std::size_t kInputs = ResidualContext::kStates + ResidualContext::kFeatures;
  static constexpr std::size_t kUnary = 14;  // bins of a magnitude that have contexts
  static constexpr std::size_t kKinds = 3;   // of bins that have mixers of their own: above 0, 1, and 2 or more

  using ResidualMixer = Mixer<kInputs>;
  using SignMixer = Mixer<2>;
  // The bins of one residual that share a context: first whether it is zero, then the unary bins.
  using Bins = std::array<BitModel, 1 + kUnary>;

  template <class Coder>
  void CodeBin(Coder& coder, const ResidualContext& context, std::size_t bin, bool& value);
  template <class Coder>
  void CodeSign(Coder& coder, const ResidualContext& context, bool& negative);

  std::array<std::vector<Bins>, ResidualContext::kStates> states_;
  std::array<std::vector<BitModel>, 2> sign_states_;
  std::vector<ResidualMixer> by_level_;     // kinds x levels
  std::vector<ResidualMixer> by_activity_;  // kinds x activities
  std::vector<SignMixer> sign_by_level_;
  SignMixer sign_;
  std::array<BitModel, 20> escape_;
};

}  // namespace sac
