// SPDX-License-Identifier: Apache-2.0
#include "format/frame_coder.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace sac {
template <class Coder>
FrameCoder<Coder>::FrameCoder(const SequenceHeader& header, const PlaneLayouts& layouts)
    : header_(header), layouts_(layouts), predictor_(header, layouts), zeros_(EmptyPlanes(layouts)) {
  for (std::size_t p = 0; p < kPlanes; ++p) planes_.emplace_back(p, layouts[p]);
}

// spec.md 6.2: a flag tells whether the references are those of the structure; if not they follow, each as its distance
// back in coding order.
template <class Coder>
bool FrameCoder<Coder>::CodeReferences(Coder& coder, const FrameSlot& slot, FrameSyntax& frame) {
  if constexpr (Coder::kDecodes) frame.slot = slot;
  const auto index = static_cast<std::uint32_t>(coded_.size());
  if (index == 0) return frame.slot.references.empty();
  bool is_explicit = frame.slot.references != slot.references;
  coder.Bit(explicit_model_, is_explicit);
  if (!is_explicit) return true;
  std::size_t count = frame.slot.references.size();
  bool any = count > 0, two = count > 1;
  coder.Bit(reference_count_models_[0], any);
  if (any) coder.Bit(reference_count_models_[1], two);
  if constexpr (Coder::kDecodes) frame.slot.references.resize(any ? (two ? 2 : 1) : 0);
  for (std::uint32_t& reference : frame.slot.references) {
    std::uint32_t distance = index - 1 - reference;
    CodeUnsigned(coder, reference_models_, distance);
    if (distance >= index) return false;
    reference = index - 1 - distance;
  }
  return true;
}

template <class Coder>
std::span<const std::int32_t> FrameCoder<Coder>::ReferenceResiduals(const FrameSyntax& frame, std::size_t plane,
                                                                    std::size_t i) const {
  const References& references = frame.slot.references;
  return references.empty() ? zeros_[plane] : coded_[references[std::min(i, references.size() - 1)]].planes[plane];
}

template <class Coder>
bool FrameCoder<Coder>::CodePlane(Coder& coder, BitModel& empty_model, std::size_t plane, FrameSyntax& frame) {
  PlaneValues& values = frame.planes[plane];
  ResidualContexts& contexts = planes_[plane].contexts;
  bool empty = false;
  if constexpr (!Coder::kDecodes) {
    empty = std::all_of(values.begin(), values.end(), [](std::int32_t v) { return v == 0; });
  }
  coder.Bit(empty_model, empty);
  if (empty) {
    std::fill(values.begin(), values.end(), 0);
  } else {
    contexts.Start(frame.slot.level, LevelStep(header_, plane, frame.slot.level), plane,
                   predictor_.FindReferences(frame.slot), ReferenceResiduals(frame, plane, 0),
                   ReferenceResiduals(frame, plane, 1));
    for (std::int32_t& value : values) {
      if (!planes_[plane].Code(coder, contexts.Next(), value)) return false;
      contexts.Put(value);
      if (!coder.ok()) return false;
    }
  }
  contexts.Finish(values);
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::CodeRigid(Coder& coder, LevelModels& models, RigidMotion& rigid) {
  bool moves = !Coder::kDecodes && std::any_of(rigid.begin(), rigid.end(), [](std::int32_t v) { return v != 0; });
  coder.Bit(models.moves, moves);
  if (!moves) {
    rigid = {};
    return true;
  }
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    CodeSigned(coder, models.rigid[i / 3], rigid[i]);
    if (std::abs(static_cast<std::int64_t>(rigid[i])) > kMaxCoefficient) return false;
  }
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits) {
  double mark = 0;
  if constexpr (!Coder::kDecodes) mark = coder.bits();
  const auto account = [&](double& part) {
    if constexpr (!Coder::kDecodes) {
      part += coder.bits() - mark;
      mark = coder.bits();
    }
  };
  FrameBits unused;
  FrameBits& parts = bits ? *bits : unused;
  LevelModels& models = models_[std::min<std::size_t>(slot.level, kLevels - 1)];
  if (!CodeReferences(coder, slot, frame) || !CodeRigid(coder, models, frame.rigid)) return false;
  account(parts.side);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    frame.planes[p].resize(layouts_[p].size());
    if (layouts_[p].size() > 0 && !CodePlane(coder, models.empty[p], p, frame)) return false;
    account(parts.planes[p]);
  }
  coded_.push_back(frame);
  return coder.ok() && predictor_.Add(frame);
}

template class FrameCoder<RangeEncoder>;
template class FrameCoder<RangeDecoder>;

}  // namespace sac
