#include "codec/prediction.h"

#include <cstdlib>

namespace sac {
namespace {

template <class Values>
bool AddInto(Values& sum, const Values& residual) {
  bool good = true;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const std::int64_t v = static_cast<std::int64_t>(sum[i]) + residual[i];
    good = good && std::abs(v) <= kMaxCoefficient;
    sum[i] = static_cast<std::int32_t>(v);
  }
  return good;
}

}  // namespace

Predictor::Predictor(ReferenceShape reference_shape, std::size_t harmonics)
    : reference_shape_(reference_shape), harmonics_(harmonics), last_(harmonics) {}

void Predictor::StartGroup() {
  last_ = FrameCoefficients(harmonics_);
  rigid_velocity_ = {};
}

FrameCoefficients Predictor::Predict(bool intra) const {
  FrameCoefficients prediction(harmonics_);
  if (intra) return prediction;
  for (std::size_t i = 0; i < 6; ++i) prediction.rigid[i] = last_.rigid[i] + rigid_velocity_[i];
  // Against the previous reconstruction, the planes are already differences (Wang et al. 2015, section 4).
  if (reference_shape_ == ReferenceShape::kKey) {
    prediction.motion = last_.motion;
    prediction.displacement = last_.displacement;
  }
  return prediction;
}

bool Predictor::Add(const FrameSyntax& frame, FrameCoefficients& out) {
  out = Predict(frame.intra);
  const bool good = AddInto(out.rigid, frame.rigid) && AddInto(out.motion, frame.motion) &&
                    AddInto(out.displacement, frame.displacement);
  if (!good) return false;
  for (std::size_t i = 0; i < 6; ++i) rigid_velocity_[i] = frame.intra ? 0 : out.rigid[i] - last_.rigid[i];
  last_ = out;
  return true;
}

}  // namespace sac
