#include "format/frame_syntax.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace sac {
namespace {

constexpr std::size_t kActivities = 16;
constexpr std::size_t kBands = 7;

// spec.md 7.4: the class of an activity of s / 24 is floor(2 log2(1 + 3 s / 24)), at most 15; here by its thresholds,
// ceil(8 (2^(c / 2) - 1)) for class c.
constexpr std::array<std::int64_t, kActivities - 1> kThresholds = {4,   8,   15,  24,  38,  56,   83,  120,
                                                                   174, 248, 355, 504, 717, 1016, 1441};

std::size_t ActivityClass(std::int64_t s) {
  return static_cast<std::size_t>(std::upper_bound(kThresholds.begin(), kThresholds.end(), s) - kThresholds.begin());
}

}  // namespace

template <class Coder>
FrameCoder<Coder>::FrameCoder(std::span<const std::uint32_t> harmonics_per_component)
    : order_(HarmonicOrder(harmonics_per_component)), zeros_(order_.size() * kMotionChannels) {
  motion_models_.fill(PlaneModels(kActivities * kBands));
  displacement_models_.fill(PlaneModels(kActivities * kBands));
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
bool FrameCoder<Coder>::CodePlane(Coder& coder, PlaneModels& models, int channels,
                                  const std::array<std::span<const std::int32_t>, 2>& references,
                                  std::span<std::int32_t> plane) {
  const auto width = static_cast<std::size_t>(channels);
  const auto size = static_cast<std::ptrdiff_t>(plane.size());
  // Magnitude of one residual, bounded so that sums stay small; zero outside the plane.
  const auto at = [size](std::span<const std::int32_t> p, std::ptrdiff_t i) -> std::int64_t {
    return i < 0 || i >= size ? 0 : std::min(std::abs(p[static_cast<std::size_t>(i)]), 1 << 15);
  };
  for (std::size_t k = 0; k < order_.size(); ++k) {
    std::int64_t before = 0;  // sum over the channels before, same harmonic
    for (std::size_t c = 0; c < width; ++c) {
      const auto i = static_cast<std::ptrdiff_t>(k * width + c);
      const std::ptrdiff_t w = channels;
      std::int64_t s =
          12 * at(plane, i - w) + 6 * at(plane, i - 2 * w) + 3 * at(plane, i - 3 * w) + 3 * at(plane, i - 4 * w);
      for (const auto& reference : references) {
        s += 4 * at(reference, i) + 2 * at(reference, i - w) + 2 * at(reference, i + w);
      }
      if (c > 0) s += 24 * before / static_cast<std::int64_t>(c);
      std::int32_t& value = plane[static_cast<std::size_t>(i)];
      if (!CodeCoefficient(coder, models[ActivityClass(s) * kBands + order_[k].band], value)) return false;
      before += at(plane, i);
    }
    if (!coder.ok()) return false;
  }
  return true;
}

template <class Coder>
bool FrameCoder<Coder>::Code(Coder& coder, const FrameSlot& slot, FrameSyntax& frame, FrameBits* bits) {
  double mark = 0;
  if constexpr (!Coder::kDecodes) mark = coder.bits();
  const auto account = [&](double FrameBits::*part) {
    if constexpr (!Coder::kDecodes) {
      if (bits) bits->*part += coder.bits() - mark;
      mark = coder.bits();
    }
  };
  if (!CodeReferences(coder, slot, frame)) return false;
  frame.motion.resize(order_.size() * kMotionChannels);
  frame.displacement.resize(order_.size() * kDisplacementChannels);
  const std::size_t level = std::min<std::size_t>(slot.level, kLevels - 1);
  const auto zero = [](std::int32_t v) { return v == 0; };
  bool repeats = false;
  if constexpr (!Coder::kDecodes) {
    repeats = std::all_of(frame.rigid.begin(), frame.rigid.end(), zero) &&
              std::all_of(frame.motion.begin(), frame.motion.end(), zero) &&
              std::all_of(frame.displacement.begin(), frame.displacement.end(), zero);
  }
  coder.Bit(repeat_models_[level], repeats);
  bool good = true;
  if (repeats) {
    frame.rigid = {};
    std::fill(frame.motion.begin(), frame.motion.end(), 0);
    std::fill(frame.displacement.begin(), frame.displacement.end(), 0);
    account(&FrameBits::side);
  } else {
    for (std::size_t i = 0; i < 6; ++i) {
      CodeSigned(coder, rigid_models_[2 * level + i / 3], frame.rigid[i]);
      good = good && std::abs(static_cast<std::int64_t>(frame.rigid[i])) <= kMaxCoefficient;
    }
    account(&FrameBits::side);
    // The first of two references, or the only one twice; nothing counts before an intra frame.
    const auto residuals = [&](std::vector<std::int32_t> FrameSyntax::*plane, std::size_t i) {
      const auto& references = frame.slot.references;
      if (references.empty()) return std::span<const std::int32_t>(zeros_).first((frame.*plane).size());
      return std::span<const std::int32_t>(coded_[references[std::min(i, references.size() - 1)]].*plane);
    };
    const auto code = [&](std::vector<std::int32_t> FrameSyntax::*plane, PlaneModels& models, int channels) {
      return CodePlane(coder, models, channels, {residuals(plane, 0), residuals(plane, 1)}, frame.*plane);
    };
    good = good && code(&FrameSyntax::motion, motion_models_[level], kMotionChannels);
    account(&FrameBits::motion);
    good = good && code(&FrameSyntax::displacement, displacement_models_[level], kDisplacementChannels);
    account(&FrameBits::displacement);
  }
  coded_.push_back(frame);
  return good && coder.ok();
}

template class FrameCoder<RangeEncoder>;
template class FrameCoder<RangeDecoder>;

}  // namespace sac
