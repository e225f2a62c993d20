#include "format/frame_coder.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "format/activity.h"

namespace sac {
namespace {

constexpr std::size_t kBands = 7;

}  // namespace

template <class Coder>
FrameCoder<Coder>::FrameCoder(const SequenceHeader& header, const PlaneLayouts& layouts)
    : layouts_(layouts), predictor_(header, layouts), zeros_(EmptyPlanes(layouts)) {
  for (LevelModels& level : models_) {
    for (std::size_t p = 0; p < kPlanes; ++p) {
      if (layouts[p].size() > 0) level.planes[p].coefficients.resize(kActivities * kBands);
    }
  }
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
  if constexpr (Coder::kDecodes) frame.slot.references.assign(any ? (two ? 2 : 1) : 0, 0);
  for (std::uint32_t& reference : frame.slot.references) {
    std::uint32_t distance = index - 1 - reference;
    CodeUnsigned(coder, reference_models_, distance);
    if (distance >= index) return false;
    reference = index - 1 - distance;
  }
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::CodeCoefficient(Coder& coder, CoefficientModels& models, std::int32_t& value) {
  bool nonzero = value != 0;
  coder.Bit(models.nonzero, nonzero);
  if (!nonzero) {
    value = 0;
    return true;
  }
  std::uint32_t negative = value < 0;
  coder.Raw(negative, 1);
  std::int32_t magnitude = Coder::kDecodes ? 1 : std::abs(value);
  std::size_t step = 0;
  for (; step < models.unary.size(); ++step) {
    bool more = magnitude > static_cast<std::int32_t>(step) + 1;
    coder.Bit(models.unary[step], more);
    if (!more) break;
    if constexpr (Coder::kDecodes) ++magnitude;
  }
  if (step == models.unary.size()) {  // Exp-Golomb of what is over 15
    std::uint32_t rest = static_cast<std::uint32_t>(magnitude) - 15 + 1;
    std::size_t width = 0;
    if constexpr (!Coder::kDecodes) {
      while ((rest >> (width + 1)) != 0) ++width;
    }
    for (std::size_t i = 0; i < models.escape.size(); ++i) {
      bool more = i < width;
      coder.Bit(models.escape[i], more);
      if (!more) break;
      if constexpr (Coder::kDecodes) width = i + 1;
    }
    std::uint32_t low = rest & ((1u << width) - 1);
    coder.Raw(low, static_cast<int>(width));
    if constexpr (Coder::kDecodes) magnitude = static_cast<std::int32_t>(((1u << width) | low) - 1 + 15);
  }
  value = negative ? -magnitude : magnitude;
  return magnitude <= kMaxResidual;
}

template <class Coder>
std::span<const std::int32_t> FrameCoder<Coder>::ReferenceResiduals(const FrameSyntax& frame, std::size_t plane,
                                                                    std::size_t i) const {
  const auto& references = frame.slot.references;
  return references.empty() ? zeros_[plane] : coded_[references[std::min(i, references.size() - 1)]].planes[plane];
}

template <class Coder>
bool FrameCoder<Coder>::CodePlane(Coder& coder, PlaneModels& models, std::size_t plane, FrameSyntax& frame) {
  PlaneValues& values = frame.planes[plane];
  bool empty = false;
  if constexpr (!Coder::kDecodes) {
    empty = std::all_of(values.begin(), values.end(), [](std::int32_t v) { return v == 0; });
  }
  coder.Bit(models.empty, empty);
  if (empty) {
    std::fill(values.begin(), values.end(), 0);
    return true;
  }
  const std::array references = {ReferenceResiduals(frame, plane, 0), ReferenceResiduals(frame, plane, 1)};
  const std::size_t channels = layouts_[plane].channels;
  const auto width = static_cast<std::ptrdiff_t>(channels);
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  // Magnitude of one residual, bounded so that sums stay small; zero outside the plane.
  const auto at = [size](std::span<const std::int32_t> p, std::ptrdiff_t i) -> std::int64_t {
    return i < 0 || i >= size ? 0 : std::min(std::abs(p[static_cast<std::size_t>(i)]), 1 << 15);
  };
  std::ptrdiff_t i = 0;
  for (const std::uint8_t band : layouts_[plane].bands) {
    std::int64_t before = 0;  // sum over the channels before, same row
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      std::int64_t s = 12 * at(values, i - width) + 6 * at(values, i - 2 * width) + 3 * at(values, i - 3 * width) +
                       3 * at(values, i - 4 * width);
      for (const auto& reference : references) {
        s += 4 * at(reference, i) + 2 * at(reference, i - width) + 2 * at(reference, i + width);
      }
      if (c > 0) s += 24 * before / static_cast<std::int64_t>(c);
      CoefficientModels& context = models.coefficients[ActivityClass(s) * kBands + band];
      if (!CodeCoefficient(coder, context, values[static_cast<std::size_t>(i)])) return false;
      before += at(values, i);
    }
    if (!coder.ok()) return false;
  }
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::CodeRigid(Coder& coder, LevelModels& models, std::array<std::int32_t, 6>& rigid) {
  bool moves = !Coder::kDecodes && std::any_of(rigid.begin(), rigid.end(), [](std::int32_t v) { return v != 0; });
  coder.Bit(models.moves, moves);
  if (!moves) {
    rigid = {};
    return true;
  }
  for (std::size_t i = 0; i < 6; ++i) {
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
    if (layouts_[p].size() > 0 && !CodePlane(coder, models.planes[p], p, frame)) return false;
    account(parts.planes[p]);
  }
  coded_.push_back(frame);
  return coder.ok() && predictor_.Add(frame);
}

template class FrameCoder<RangeEncoder>;
template class FrameCoder<RangeDecoder>;

}  // namespace sac
