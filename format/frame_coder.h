// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/frame_syntax.h"
#include "format/integer_coder.h"
#include "format/plane_layout.h"
#include "format/plane_models.h"
#include "format/prediction.h"
#include "format/range_coder.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"

namespace sac {

// The bits of a group by what they code.
struct FrameBits {
  double side = 0;
  std::array<double, kPlanes> planes = {};
};

// Codes the frames of one group in coding order. It holds the adaptive models and the frames that the contexts look at.
// Encoder and decoder instantiate the same body.
template <class Coder>
class FrameCoder {
 public:
  FrameCoder(const SequenceHeader& header, const PlaneLayouts& layouts);

  // Writes or reads `frame`, which stands at `slot` of the group's structure. Returns false when a residual or
  // coefficient is out of range or when the code ran past its end. An encoder's bits are added to `bits` unless it is
  // null.
  bool Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits = nullptr);

  // The predictor holds the coefficients of the frames coded so far.
  const Predictor& predictor() const { return predictor_; }
  std::vector<FrameCoefficients> TakeFrames() { return predictor_.TakeFrames(); }

 private:
  static constexpr std::size_t kLevels = 3;  // of a pyramid that have models of their own
  struct LevelModels {
    BitModel moves;
    std::array<SignedModels, 2> rigid;
    std::array<BitModel, kPlanes> empty;
  };

  bool CodeReferences(Coder& coder, const FrameSlot& slot, FrameSyntax& frame);
  bool CodeRigid(Coder& coder, LevelModels& models, RigidMotion& rigid);
  // The residuals of `plane` of the first (i = 0) or second (i = 1) reference of `frame`. A single reference stands for
  // both.
  std::span<const std::int32_t> ReferenceResiduals(const FrameSyntax& frame, std::size_t plane, std::size_t i) const;
  bool CodePlane(Coder& coder, BitModel& empty_model, std::size_t plane, FrameSyntax& frame);

  SequenceHeader header_;
  PlaneLayouts layouts_;
  Predictor predictor_;
  std::vector<FrameSyntax> coded_;
  FramePlanes zeros_;
  BitModel explicit_model_;
  std::array<BitModel, 2> reference_count_models_;
  UnsignedModels reference_models_;
  std::array<LevelModels, kLevels> models_;
  std::vector<PlaneModels> planes_;
};

extern template class FrameCoder<RangeEncoder>;
extern template class FrameCoder<RangeDecoder>;

}  // namespace sac
