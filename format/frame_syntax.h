#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/group_structure.h"
#include "format/integer_coder.h"
#include "format/plane_layout.h"
#include "format/range_coder.h"

namespace sac {

// What the bitstream carries of one frame, and nothing else (spec.md 6.2): integers, in units of the header's steps.
struct FrameSyntax {
  FrameSlot slot;                          // references may differ from the structure's
  std::array<std::int32_t, 6> rigid = {};  // residual of rotation (3), translation (3)
  FramePlanes planes;                      // residuals

  bool intra() const { return slot.references.empty(); }
};

// Residuals of planes stay within this magnitude (spec.md 6.2).
inline constexpr std::int32_t kMaxResidual = 1 << 20;
// Residuals of the rigid motion, and all coefficients (spec.md 6.3).
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

// Bits of a group by what they say.
struct FrameBits {
  double side = 0;
  std::array<double, kPlanes> planes = {};
};

// Codes the frames of one group in coding order; holds the adaptive models and the residuals that contexts look at.
// Encoder and decoder instantiate the same body.
template <class Coder>
class FrameCoder {
 public:
  explicit FrameCoder(const PlaneLayouts& layouts);

  // Writes or reads `frame`, the one at `slot` of the group's structure. False when a value is out of range or the code
  // ran past its end. `bits` accounts for what an encoder writes.
  bool Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits = nullptr);

 private:
  struct CoefficientModels {
    BitModel nonzero;
    std::array<BitModel, 14> unary;
    std::array<BitModel, 20> escape;
  };
  struct PlaneModels {
    BitModel empty;
    std::vector<CoefficientModels> coefficients;  // by context
  };
  static constexpr std::size_t kLevels = 3;  // of a pyramid that have models of their own
  struct LevelModels {
    BitModel moves;
    std::array<SignedModels, 2> rigid;
    std::array<PlaneModels, kPlanes> planes;
  };

  bool CodeReferences(Coder& coder, const FrameSlot& slot, FrameSyntax& frame);
  bool CodeRigid(Coder& coder, LevelModels& models, std::array<std::int32_t, 6>& rigid);
  bool CodeCoefficient(Coder& coder, CoefficientModels& models, std::int32_t& value);
  // Residuals of a plane of the frame's first (0) or second (1) reference, or the only one twice.
  std::span<const std::int32_t> ReferenceResiduals(const FrameSyntax& frame, std::size_t plane, std::size_t i) const;
  bool CodePlane(Coder& coder, PlaneModels& models, std::size_t plane, FrameSyntax& frame);

  PlaneLayouts layouts_;
  std::vector<FrameSyntax> coded_;
  FramePlanes zeros_;
  BitModel explicit_model_;
  std::array<BitModel, 2> reference_count_models_;
  UnsignedModels reference_models_;
  std::array<LevelModels, kLevels> models_;
};

extern template class FrameCoder<RangeEncoder>;
extern template class FrameCoder<RangeDecoder>;

}  // namespace sac
