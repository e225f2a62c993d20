// SPDX-License-Identifier: Apache-2.0
#include "format/prediction.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace sac {
namespace {

// From this level of a pyramid on, frames are near enough in time to lie on a smooth curve.
constexpr std::uint32_t kBendingLevel = 3;

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
  return plane != kCorrection && !header_.references_previous();
}

const FrameCoefficients* Predictor::FrameAt(std::int64_t display, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (displays_[i] == display) return &frames_[i];
  }
  return nullptr;
}

ReferenceFrames Predictor::FindReferences(const FrameSlot& slot, std::size_t index) const {
  if (slot.references.empty()) return {};
  const std::uint32_t a = slot.references[0], b = slot.references.back();
  ReferenceFrames frames{&frames_[a], &frames_[b], nullptr, nullptr, slot.references.size() == 1};
  const std::int64_t from = displays_[a], to = frames.one ? slot.display : displays_[b];
  frames.before = FrameAt(2 * from - to, index);
  if (!frames.one) frames.after = FrameAt(2 * to - from, index);
  return frames;
}

void Predictor::PredictPlane(const FrameSlot& slot, const ReferenceFrames& frames, std::size_t plane,
                             PlaneValues& values) const {
  if (slot.references.empty() || !Predicts(plane)) return;
  values = frames.first->planes[plane];
  if (slot.references.size() < 2) return;
  const PlaneValues& second = frames.second->planes[plane];
  if (slot.level < kBendingLevel || (plane != kMotion && plane != kDisplacement)) return Mean(values, second);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::int64_t sum = 8 * (std::int64_t{values[i]} + second[i]) + frames.Bend(plane, i);
    values[i] = static_cast<std::int32_t>((sum + 8) >> 4);
  }
}

FrameCoefficients Predictor::Predict(const FrameSlot& slot) const {
  FrameCoefficients prediction{{}, zeros_};
  if (slot.references.empty()) return prediction;
  const ReferenceFrames frames = FindReferences(slot, frames_.size());
  prediction.rigid = frames.first->rigid;
  if (slot.references.size() == 2) Mean(prediction.rigid, frames.second->rigid);
  for (std::size_t p = 0; p < kPlanes; ++p) PredictPlane(slot, frames, p, prediction.planes[p]);
  return prediction;
}

bool Predictor::AddPlane(std::size_t index, const FrameSyntax& frame, std::size_t plane) {
  PlaneValues values = zeros_[plane];
  PredictPlane(frame.slot, FindReferences(frame.slot, index), plane, values);
  const bool good = AddInto(values, frame.planes[plane], LevelStep(header_, plane, frame.slot.level));
  frames_[index].planes[plane] = std::move(values);
  return good;
}

bool Predictor::Add(const FrameSyntax& frame) {
  FrameCoefficients sum = Predict(frame.slot);
  if (!AddInto(sum.rigid, frame.rigid, 1)) return false;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    if (!AddInto(sum.planes[p], frame.planes[p], LevelStep(header_, p, frame.slot.level))) return false;
  }
  frames_.push_back(std::move(sum));
  displays_.push_back(frame.slot.display);
  return true;
}

}  // namespace sac
