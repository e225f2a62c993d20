// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

// What a layer of a group has (spec.md 6.1): frames, by their slots in coding order from `first` to before `end`, with
// motion and displacement; or the plane `plane`, which is kDetail or kCorrection, of all frames.
struct GroupLayer {
  std::size_t first = 0, end = 0;
  std::size_t plane = kMotion;

  bool has_frames() const { return plane == kMotion; }
};

// The layers of a layered group, of which the first is in the group's own packet. `slots` are in LayeredOrder().
std::vector<GroupLayer> LayersOf(const std::vector<FrameSlot>& slots, std::uint32_t base_levels,
                                 const PlaneLayouts& layouts);

// Codes the frames of one group in coding order. It holds the adaptive models and the frames that the contexts look at.
// Encoder and decoder instantiate the same body.
template <class Coder>
class FrameCoder {
 public:
  FrameCoder(const SequenceHeader& header, const PlaneLayouts& layouts);

  // Writes or reads `frame`, which stands at `slot` of the group's structure, with all of its planes. Returns false
  // when a residual or coefficient is out of range or when the code ran past its end. An encoder's bits are added to
  // `bits` unless it is null.
  bool Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits = nullptr);
  // The same of a layered group, whose frames have motion and displacement alone at first.
  bool CodeBase(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits = nullptr);
  // Writes or reads a later plane of frame number `index` in coding order, which CodeBase() has coded.
  bool CodeLater(Coder& coder, std::size_t index, std::size_t plane, FrameSyntax& frame, FrameBits* bits = nullptr);
  // Takes a frame whose layer is missing: all of its residuals are 0.
  bool Skip(const FrameSlot& slot);

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
  // `index`: of the frame in coding order.
  bool CodePlane(Coder& coder, std::size_t index, std::size_t plane, FrameSyntax& frame);
  // Codes a frame with its first `planes` planes.
  bool CodeFrame(Coder& coder, const FrameSlot& slot, std::size_t planes, FrameSyntax& frame, FrameBits* bits);
  LevelModels& ModelsOf(const FrameSlot& slot) { return models_[std::min<std::size_t>(slot.level, kLevels - 1)]; }

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
