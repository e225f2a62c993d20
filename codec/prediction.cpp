#include "codec/prediction.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace sac {
namespace {

template <class Values>
bool AddInto(Values& sum, const Values& residual, std::int64_t step) {
  bool good = true;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const std::int64_t v = sum[i] + residual[i] * step;
    good = good && std::abs(v) <= kMaxCoefficient;
    sum[i] = static_cast<std::int32_t>(v);
  }
  return good;
}

// Halves are rounded up.
template <class Values>
void Mean(Values& a, const Values& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = (a[i] + b[i] + 1) >> 1;
}

}  // namespace

std::int32_t LevelStep(const SequenceHeader& header, std::uint32_t level) {
  std::int32_t step = kCoefficientsPerStep;
  for (std::uint32_t i = 0; i < level && step < 4096; ++i) step = (step * header.level_growth + 32) / 64;
  return std::min(step, 4096);
}

Predictor::Predictor(const SequenceHeader& header, std::size_t harmonics) : header_(header), harmonics_(harmonics) {}

FrameCoefficients Predictor::Predict(const std::vector<std::uint32_t>& references) const {
  if (references.empty()) return FrameCoefficients(harmonics_);
  FrameCoefficients prediction = frames_[references[0]];
  if (references.size() == 2) {
    const FrameCoefficients& other = frames_[references[1]];
    Mean(prediction.rigid, other.rigid);
    Mean(prediction.motion, other.motion);
    Mean(prediction.displacement, other.displacement);
  }
  // Against the previous reconstruction, the planes are already differences (Wang et al. 2015, section 4).
  if (header_.reference_shape == static_cast<std::uint8_t>(ReferenceShape::kPrevious)) {
    std::fill(prediction.motion.begin(), prediction.motion.end(), 0);
    std::fill(prediction.displacement.begin(), prediction.displacement.end(), 0);
  }
  return prediction;
}

bool Predictor::Add(const FrameSyntax& frame) {
  FrameCoefficients sum = Predict(frame.slot.references);
  const std::int32_t step = LevelStep(header_, frame.slot.level);
  if (!AddInto(sum.rigid, frame.rigid, 1) || !AddInto(sum.motion, frame.motion, step) ||
      !AddInto(sum.displacement, frame.displacement, step)) {
    return false;
  }
  frames_.push_back(std::move(sum));
  return true;
}

}  // namespace sac
