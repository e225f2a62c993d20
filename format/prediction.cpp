#include "format/prediction.h"

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

std::int32_t LevelStep(const SequenceHeader& header, std::size_t plane, std::uint32_t level) {
  std::int32_t step = kCoefficientsPerStep;
  if (plane == kCorrection) return step;
  for (std::uint32_t i = 0; i < level && step < 4096; ++i) step = (step * header.level_growth + 32) / 64;
  return std::min(step, 4096);
}

Predictor::Predictor(const SequenceHeader& header, const PlaneLayouts& layouts)
    : header_(header), zeros_(EmptyPlanes(layouts)) {}

bool Predictor::Predicts(std::size_t plane) const {
  // A correction has nothing in common with another frame's. Against the previous reconstruction, the other planes are
  // differences already (Wang et al. 2015, section 4).
  return plane != kCorrection && header_.reference_shape == static_cast<std::uint8_t>(ReferenceShape::kKey);
}

FrameCoefficients Predictor::Predict(const std::vector<std::uint32_t>& references) const {
  if (references.empty()) return {{}, zeros_};
  const FrameCoefficients& first = frames_[references[0]];
  const FrameCoefficients& second = frames_[references.back()];
  FrameCoefficients prediction{first.rigid, zeros_};
  if (references.size() == 2) Mean(prediction.rigid, second.rigid);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    if (!Predicts(p)) continue;
    prediction.planes[p] = first.planes[p];
    if (references.size() == 2) Mean(prediction.planes[p], second.planes[p]);
  }
  return prediction;
}

bool Predictor::Add(const FrameSyntax& frame) {
  FrameCoefficients sum = Predict(frame.slot.references);
  if (!AddInto(sum.rigid, frame.rigid, 1)) return false;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    if (!AddInto(sum.planes[p], frame.planes[p], LevelStep(header_, p, frame.slot.level))) return false;
  }
  frames_.push_back(std::move(sum));
  return true;
}

}  // namespace sac
