#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/group_structure.h"
#include "format/harmonic_order.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"

namespace sac {

inline constexpr int kMotionChannels = 9;        // log-rotation (3), stretch (6)
inline constexpr int kDisplacementChannels = 3;  // x, y, z

// What the bitstream carries of one frame, and nothing else (spec.md 6.2): integers, in units of the header's steps.
// Planes are stored harmonic by harmonic, in HarmonicOrder, all channels of one together.
struct FrameSyntax {
  FrameSlot slot;                          // references may differ from the structure's
  std::array<std::int32_t, 6> rigid = {};  // residual of rotation (3), translation (3)
  std::vector<std::int32_t> motion;        // residual, harmonics x kMotionChannels
  std::vector<std::int32_t> displacement;  // residual, harmonics x kDisplacementChannels

  bool intra() const { return slot.references.empty(); }
};

// Residuals of planes stay within this magnitude (spec.md 6.2).
inline constexpr std::int32_t kMaxResidual = 1 << 20;
// Residuals of the rigid motion, and all coefficients (spec.md 6.3).
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

// Bits of a group by what they say.
struct FrameBits {
  double side = 0;
  double motion = 0;
  double displacement = 0;
};

// Codes the frames of one group in coding order; holds the adaptive models and the residuals that contexts look at.
// Encoder and decoder instantiate the same body.
template <class Coder>
class FrameCoder {
 public:
  explicit FrameCoder(std::span<const std::uint32_t> harmonics_per_component);

  // Writes or reads `frame`, the one at `slot` of the group's structure. False when a value is out of range or the code
  // ran past its end. `bits` accounts for what an encoder writes.
  bool Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits = nullptr);

 private:
  struct CoefficientModels {
    BitModel nonzero;
    std::array<BitModel, 14> unary;
    std::array<BitModel, 20> escape;
  };
  using PlaneModels = std::vector<CoefficientModels>;

  static constexpr std::size_t kLevels = 3;  // of a pyramid that have models of their own

  bool CodeReferences(Coder& coder, const FrameSlot& slot, FrameSyntax& frame);
  bool CodeCoefficient(Coder& coder, CoefficientModels& models, std::int32_t& value);
  // `references`: the same plane's residuals of the frames predicted from.
  bool CodePlane(Coder& coder, PlaneModels& models, int channels,
                 const std::array<std::span<const std::int32_t>, 2>& references, std::span<std::int32_t> plane);

  std::vector<HarmonicIndex> order_;
  std::vector<FrameSyntax> coded_;
  std::vector<std::int32_t> zeros_;
  BitModel explicit_model_;
  std::array<BitModel, 2> reference_count_models_;
  UnsignedModels reference_models_;
  std::array<BitModel, kLevels> repeat_models_;
  std::array<SignedModels, 2 * kLevels> rigid_models_;
  std::array<PlaneModels, kLevels> motion_models_;
  std::array<PlaneModels, kLevels> displacement_models_;
};

extern template class FrameCoder<RangeEncoder>;
extern template class FrameCoder<RangeDecoder>;

}  // namespace sac
