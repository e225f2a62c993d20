// SPDX-License-Identifier: Apache-2.0
#include "format/frame_coder.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace sac {
namespace {

// Adds the bits of an encoder to what they code.
template <class Coder>
class Accounting {
 public:
  Accounting(const Coder& coder, FrameBits* bits) : coder_(coder), bits_(bits) { Mark(); }

  // Adds the bits since the last call, or since the object was made, to `part`.
  void Add(double FrameBits::*part) {
    if (bits_) bits_->*part += Mark();
  }
  void AddPlane(std::size_t plane) {
    if (bits_) bits_->planes[plane] += Mark();
  }

 private:
  double Mark() {
    const double before = mark_;
    if constexpr (!Coder::kDecodes) mark_ = coder_.bits();
    return mark_ - before;
  }

  const Coder& coder_;
  FrameBits* const bits_;
  double mark_ = 0;
};

}  // namespace

std::vector<GroupLayer> LayersOf(const std::vector<FrameSlot>& slots, std::uint32_t base_levels,
                                 const PlaneLayouts& layouts) {
  std::vector<GroupLayer> layers;
  std::size_t end = 0;
  for (std::uint64_t levels = base_levels; end < slots.size(); ++levels) {
    const std::size_t first = end;
    while (end < slots.size() && slots[end].level < levels) ++end;
    layers.push_back({first, end, kMotion});
  }
  for (const std::size_t plane : {std::size_t{kDetail}, std::size_t{kCorrection}}) {
    if (layouts[plane].size() > 0) layers.push_back({0, slots.size(), plane});
  }
  return layers;
}

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
bool FrameCoder<Coder>::CodePlane(Coder& coder, std::size_t index, std::size_t plane, FrameSyntax& frame) {
  frame.planes[plane].resize(layouts_[plane].size());
  if (layouts_[plane].size() == 0) return true;
  PlaneValues& values = frame.planes[plane];
  ResidualContexts& contexts = planes_[plane].contexts;
  bool empty = false;
  if constexpr (!Coder::kDecodes) {
    empty = std::all_of(values.begin(), values.end(), [](std::int32_t v) { return v == 0; });
  }
  coder.Bit(ModelsOf(frame.slot).empty[plane], empty);
  if (empty) {
    std::fill(values.begin(), values.end(), 0);
  } else {
    contexts.Start(frame.slot.level, LevelStep(header_, plane, frame.slot.level), plane,
                   predictor_.FindReferences(frame.slot, index), ReferenceResiduals(frame, plane, 0),
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
  for (std::size_t i = 0; i < RigidMotion::size(); ++i) {
    CodeSigned(coder, models.rigid[i / 3], rigid[i]);
    if (std::abs(static_cast<std::int64_t>(rigid[i])) > kMaxCoefficient) return false;
  }
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::CodeFrame(Coder& coder, const FrameSlot& slot, std::size_t planes, FrameSyntax& frame,
                                  FrameBits* bits) {
  Accounting<Coder> accounting(coder, bits);
  if (!CodeReferences(coder, slot, frame) || !CodeRigid(coder, ModelsOf(slot), frame.rigid)) return false;
  accounting.Add(&FrameBits::side);
  for (std::size_t p = 0; p < planes; ++p) {
    if (!CodePlane(coder, coded_.size(), p, frame)) return false;
    accounting.AddPlane(p);
  }
  coded_.push_back(frame);
  for (std::size_t p = planes; p < kPlanes; ++p) coded_.back().planes[p] = zeros_[p];
  return coder.ok() && predictor_.Add(coded_.back());
}

template <class Coder>
bool FrameCoder<Coder>::Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits) {
  return CodeFrame(coder, slot, kPlanes, frame, bits);
}

template <class Coder>
bool FrameCoder<Coder>::CodeBase(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits) {
  return CodeFrame(coder, slot, kDetail, frame, bits);
}

template <class Coder>
bool FrameCoder<Coder>::CodeLater(Coder& coder, std::size_t index, std::size_t plane, FrameSyntax& frame,
                                  FrameBits* bits) {
  Accounting<Coder> accounting(coder, bits);
  if constexpr (Coder::kDecodes) frame.slot = coded_[index].slot;
  if (!CodePlane(coder, index, plane, frame)) return false;
  accounting.AddPlane(plane);
  coded_[index].planes[plane] = frame.planes[plane];
  return coder.ok() && predictor_.AddPlane(index, coded_[index], plane);
}

template <class Coder>
bool FrameCoder<Coder>::Skip(const FrameSlot& slot) {
  coded_.push_back({slot, {}, zeros_});
  return predictor_.Add(coded_.back());
}

template class FrameCoder<RangeEncoder>;
template class FrameCoder<RangeDecoder>;

}  // namespace sac
