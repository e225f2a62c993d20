// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>
#include <vector>

#include "codec/encode/error_bound.h"
#include "codec/encode/quantizer.h"
#include "codec/encode/reference_search.h"

namespace sac {
namespace {

// References are tried when their motion takes at most so many times the bits of the structure's.
constexpr double kWorthTrying = 1.3;
// About how many bits it takes to name references.
constexpr double kExplicitBits = 30;

// About how many bits a residual takes, and those of a plane.
double EstimatedBits(std::int32_t residual) {
  return residual == 0 ? 0 : 4 + 2 * std::bit_width(static_cast<std::uint32_t>(std::abs(residual)));
}
double EstimatedBits(const PlaneValues& residual) {
  double bits = 0;
  for (const std::int32_t v : residual) bits += EstimatedBits(v);
  return bits;
}

// Whether a residual is as large as the format allows: then it says less than it should.
bool IsSaturated(const PlaneValues& values) {
  return std::any_of(values.begin(), values.end(), [](std::int32_t v) { return std::abs(v) >= kMaxResidual; });
}

// Corrects each vertex of which the decoded float is farther off than `max_error`, to within half a step along each
// axis. `remainder`: what the other planes leave to correct, before the rigid motion; `error`: the same after it.
void CorrectOverBound(const PositionMatrix& remainder, const PositionMatrix& exact, const PositionMatrix& error,
                      double step, double max_error, PlaneValues& correction) {
  for (Eigen::Index v = 0; v < remainder.rows(); ++v) {
    if (DistanceAfterRounding(exact.row(v), error.row(v)) <= max_error) continue;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double steps = std::clamp(std::round(remainder(v, a) / step), -1.0 * kMaxResidual, 1.0 * kMaxResidual);
      correction[static_cast<std::size_t>(3 * v + a)] = static_cast<std::int32_t>(steps);
    }
  }
}

}  // namespace

Status MotionTooFar() { return Status::InvalidArgument("the motion is too far from the first frame for these steps"); }

FrameEncoder::FrameEncoder(const Shape& shape, const SequenceHeader& header, double max_error,
                           const Projection& projection)
    : shape_(shape),
      header_(header),
      max_error_(max_error),
      fields_(shape.triangles),
      projection_(projection),
      units_{PlaneUnits(shape, header, kMotion), PlaneUnits(shape, header, kDisplacement),
             PlaneUnits(shape, header, kDetail)},
      reconstructor_(shape, header) {}

void FrameEncoder::StartGroup() {
  reconstructor_.StartGroup();
  fields_.Restart();
}

Status FrameEncoder::StartFrame(bool intra) { return reconstructor_.StartFrame(intra) ? Status::Ok() : MotionTooFar(); }

void FrameEncoder::Show(const FrameCoefficients& frame) { reconstructor_.Reconstruct(frame); }

Eigen::MatrixXd FrameEncoder::MeasureMotion(const PositionMatrix& positions, const RigidMotion& rigid) {
  const PositionMatrix aligned = reconstructor_.RemoveRigid(positions, rigid);
  if (!UsesKeyReference()) fields_.Restart();  // the frame before is the reference: what it did is no part of it
  return projection_.ProjectTriangles(fields_.Measure(reconstructor_.reference(), aligned));
}

Status FrameEncoder::Choose(const Predictor& predictor, FrameDraft& draft) {
  draft.aligned = reconstructor_.RemoveRigid(draft.positions, draft.rigid);
  ChooseReferences(predictor, draft);
  if (header_.detail_step > 0) ChooseDetail(draft);
  for (std::size_t i = 0; i < 6; ++i) draft.syntax.rigid[i] = draft.rigid[i] - draft.coefficients.rigid[i];
  // Planes before the correction may be saturated: it alone has to hold the bound.
  if (header_.correction_step > 0) return ChooseCorrection(draft);
  const FramePlanes& planes = draft.syntax.planes;
  if (std::none_of(planes.begin(), planes.end(), IsSaturated)) return Status::Ok();
  draft.failed_vertex = FarthestVertex(draft.positions, draft.rigid);
  return MotionTooFar();
}

std::uint32_t FrameEncoder::FarthestVertex(const PositionMatrix& positions, const RigidMotion& rigid) const {
  Eigen::Index vertex = 0;
  (reconstructor_.RemoveRigid(positions, rigid) - shape_.positions).rowwise().squaredNorm().maxCoeff(&vertex);
  return static_cast<std::uint32_t>(vertex);
}

void FrameEncoder::Quantize(Plane plane, const Eigen::MatrixXd& target, FrameDraft& draft) const {
  const std::int32_t step = LevelStep(header_, plane, draft.syntax.slot.level);
  PlaneValues& residual = draft.syntax.planes[plane];
  PlaneValues& coefficients = draft.coefficients.planes[plane];
  QuantizePlane(target, units_[plane], step, plane == kMotion ? kMotionDeadZone : kDisplacementDeadZone, coefficients,
                residual);
  for (std::size_t i = 0; i < residual.size(); ++i) coefficients[i] += residual[i] * step;
}

double FrameEncoder::ChooseMotion(const Predictor& predictor, FrameDraft& draft) const {
  draft.coefficients = predictor.Predict(draft.syntax.slot);
  double bits = 0;
  for (std::size_t i = 0; i < 6; ++i) bits += EstimatedBits(draft.rigid[i] - draft.coefficients.rigid[i]);
  Quantize(kMotion, draft.motion, draft);
  return bits + EstimatedBits(draft.syntax.planes[kMotion]);
}

double FrameEncoder::ChooseDisplacement(FrameDraft& draft) {
  draft.remainder = draft.aligned - reconstructor_.ReconstructMotion(draft.coefficients.planes[kMotion]);
  Quantize(kDisplacement, projection_.ProjectVertices(draft.remainder), draft);
  draft.remainder = draft.aligned - reconstructor_.Add(kDisplacement, draft.coefficients.planes[kDisplacement]);
  return EstimatedBits(draft.syntax.planes[kDisplacement]);
}

void FrameEncoder::ChooseReferences(const Predictor& predictor, FrameDraft& draft) {
  const auto motion_bits = [&](const References& references) {
    draft.syntax.slot.references = references;
    return ChooseMotion(predictor, draft);
  };
  const auto whole_bits = [&](const References& references) {
    const double bits = motion_bits(references);
    return bits + ChooseDisplacement(draft);
  };
  const References own = draft.syntax.slot.references;
  if (!UsesKeyReference() || own.empty()) {
    whole_bits(own);
    return;
  }
  const double limit = kWorthTrying * motion_bits(own);
  const std::vector<References> likely =
      LikelyReferences(static_cast<std::uint32_t>(predictor.frames().size()), motion_bits, limit);
  References best = own;
  double least = whole_bits(own);
  for (const References& references : likely) {
    const double bits = whole_bits(references) + kExplicitBits;
    if (bits >= least) continue;
    least = bits;
    best = references;
  }
  if (draft.syntax.slot.references != best) whole_bits(best);
}

void FrameEncoder::ChooseDetail(FrameDraft& draft) {
  Quantize(kDetail, projection_.ProjectPatches(draft.remainder), draft);
  draft.remainder = draft.aligned - reconstructor_.Add(kDetail, draft.coefficients.planes[kDetail]);
}

PositionMatrix FrameEncoder::ErrorOf(const FrameDraft& draft) const {
  return reconstructor_.ApplyRigid(draft.aligned - draft.remainder, draft.rigid) - draft.positions;
}

Status FrameEncoder::ChooseCorrection(FrameDraft& draft) {
  PlaneValues& residual = draft.syntax.planes[kCorrection];
  PlaneValues& coefficients = draft.coefficients.planes[kCorrection];
  CorrectOverBound(draft.remainder, draft.positions, ErrorOf(draft), header_.correction_step, max_error_, residual);
  for (std::size_t i = 0; i < residual.size(); ++i) coefficients[i] = residual[i] * kCoefficientsPerStep;
  draft.remainder = draft.aligned - reconstructor_.Add(kCorrection, coefficients);
  return CheckBound(draft);
}

Status FrameEncoder::CheckBound(FrameDraft& draft) const {
  const PositionMatrix error = ErrorOf(draft);
  double largest = 0;
  for (Eigen::Index v = 0; v < error.rows(); ++v) {
    const double distance = DistanceAfterRounding(draft.positions.row(v), error.row(v));
    if (distance <= largest) continue;
    largest = distance;
    draft.failed_vertex = static_cast<std::uint32_t>(v);
  }
  if (largest <= max_error_) return Status::Ok();
  std::ostringstream message;
  message << "stays " << largest << " from where it should be, more than the largest error allowed, " << max_error_
          << "; the smallest possible here is " << std::setprecision(3) << 1.05 * largest;
  return Status::InvalidArgument(message.str());
}

}  // namespace sac
