#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/harmonic_order.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"

namespace sac {

inline constexpr int kMotionChannels = 9;        // log-rotation (3), stretch (6)
inline constexpr int kDisplacementChannels = 3;  // x, y, z

// What the bitstream carries of one frame, and nothing else (spec.md 6.2): integers, in units of the header's steps.
// Planes are stored harmonic by harmonic, in HarmonicOrder, all channels of one together.
struct FrameSyntax {
  bool intra =
      false;  // predicted from zero (and, of `previous`, measured against the I-frame); else from the frame before
  std::array<std::int32_t, 6> rigid = {};  // rotation (3), translation (3)
  std::vector<std::int32_t> motion;        // harmonics x kMotionChannels
  std::vector<std::int32_t> displacement;  // harmonics x kDisplacementChannels
};

// Residuals stay within this magnitude (spec.md 6.2), coefficients within kMaxCoefficient.
inline constexpr std::int32_t kMaxResidual = 1 << 20;
inline constexpr std::int32_t kMaxCoefficient = 1 << 24;

// Bits of a group by what they say.
struct FrameBits {
  double side = 0;
  double motion = 0;
  double displacement = 0;
};

// Codes the frames of one group in turn; holds the adaptive models and the residuals that contexts look at. Encoder and
// decoder instantiate the same body.
template <class Coder>
class FrameCoder {
 public:
  explicit FrameCoder(std::span<const std::uint32_t> harmonics_per_component);

  // Writes or reads `frame`. False when a residual is out of range or the code ran past its end. The first frame of a
  // group is intra, and says nothing about it.
  bool Code(Coder& coder, FrameSyntax& frame, FrameBits* bits = nullptr);

 private:
  struct CoefficientModels {
    BitModel nonzero;
    std::array<BitModel, 14> unary;
    std::array<BitModel, 20> escape;
  };
  using PlaneModels = std::vector<CoefficientModels>;

  bool CodeCoefficient(Coder& coder, CoefficientModels& models, std::int32_t& value);
  bool CodePlane(Coder& coder, PlaneModels& models, int channels, std::span<const std::int32_t> reference,
                 std::span<std::int32_t> plane);

  std::vector<HarmonicIndex> order_;
  bool first_ = true;
  FrameSyntax last_;
  BitModel intra_model_;
  BitModel repeat_model_;
  std::array<SignedModels, 2> rigid_models_;
  PlaneModels motion_models_;
  PlaneModels displacement_models_;
};

extern template class FrameCoder<RangeEncoder>;
extern template class FrameCoder<RangeDecoder>;

}  // namespace sac
