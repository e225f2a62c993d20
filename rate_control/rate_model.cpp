// SPDX-License-Identifier: Apache-2.0
#include "rate_control/rate_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sac {
namespace {

constexpr double kPositionBits = 3.3;  // bits per vertex for one more bit on each axis

// A distance of two settings, scaled such that it is about the difference of the logarithms of the resulting figures.
double Distance(const OperatingPoint& a, const OperatingPoint& b) {
  const auto ratio = [](double x, double y) { return std::abs(std::log(x / y)); };
  return 0.3 * ratio(a.motion_step, b.motion_step) + 0.3 * ratio(a.displacement_step, b.displacement_step) +
         (a.detail_step > 0 ? 0.6 * ratio(a.detail_step, b.detail_step) : 0) +
         0.3 * std::abs(a.position_bits - b.position_bits) + 0.3 * ratio(a.harmonics, b.harmonics);
}

// The logarithm of the square root of a weighted sum of parts, whose weights are exp(logs).
double LogRoot(const Eigen::Array3d& parts, const Eigen::Array3d& logs) {
  return 0.5 * std::log((parts * logs.exp()).sum());
}

}  // namespace

RateModel::Parts RateModel::KgParts(const OperatingPoint& p) {
  if (p.detail_step > 0) {
    return {0.9 * std::pow(p.detail_step / 0.005, 1.4), 0.05 * std::pow(p.displacement_step / 5e-4, 1.4),
            0.05 * std::exp2(-2 * (p.position_bits - 12))};
  }
  return {0.55 * std::pow(p.displacement_step / 6e-4, 1.75), 0.4 * std::pow(p.harmonics / 200, -1.2),
          0.05 * std::pow(p.motion_step / 0.02, 1.5)};
}

RateModel::Parts RateModel::StedParts(const OperatingPoint& p) {
  const double positions = std::exp2(-2 * (p.position_bits - 11)), motion = std::pow(p.motion_step / 0.02, 1.7);
  if (p.detail_step > 0) return {0.5 * positions, 0.1 * motion, 0.4 * (p.detail_step / 0.005)};
  return {0.3 * positions, 0.25 * motion, 0.45 * std::pow(p.harmonics / 200, -0.2)};
}

RateModel::RateModel(const std::vector<const Trial*>& trials, const Trial& centre)
    : centre_(centre),
      kg_(Fit(trials, KgParts, &Trial::kg)),
      sted_(Fit(trials, StedParts, &Trial::sted)),
      bytes_per_bit_(kPositionBits * centre.vertices / 8) {
  // The bytes per bit are measured where a trial has another number of position bits, and estimated otherwise.
  double widest = 0.2;
  for (const Trial* trial : trials) {
    const double bits = trial->point.position_bits - centre.point.position_bits;
    if (std::abs(bits) <= widest) continue;
    widest = std::abs(bits);
    const double secant = (trial->parts.i_frame - centre.parts.i_frame) / bits;
    bytes_per_bit_ =
        std::clamp(secant, 0.3 * kPositionBits * centre.vertices / 8, 0.2 * centre.vertices * kPositionBits);
  }
  for (const Trial* trial : trials) {
    const RateFigures f = Formulas(trial->point);
    misses_.push_back({trial->point,
                       {std::log(static_cast<double>(trial->bytes) / f.bytes), std::log(trial->kg / f.kg),
                        std::log(trial->sted / f.sted)}});
  }
}

RateModel::Sum RateModel::Fit(const std::vector<const Trial*>& trials, Parts (*parts)(const OperatingPoint&),
                              double Trial::*figure) const {
  // Levenberg's method with a prior: without evidence the parts stay as they are on a typical clip. kPriorSpread says
  // that the parts of clips differ by a factor of about two, kNoise that the figures of small meshes scatter by a few
  // percent from one setting to the next.
  constexpr double kPriorSpread = 0.7, kNoise = 0.02, kModelError = 0.25;
  Sum sum{Parts::Zero(), std::log(centre_.*figure) - LogRoot(parts(centre_.point), Parts::Zero())};
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() / (kPriorSpread * kPriorSpread);
    normal(3, 3) = 0;  // there is no prior for the scale
    Eigen::Vector4d right;
    right << -sum.logs.matrix() / (kPriorSpread * kPriorSpread), 0;
    for (const Trial* trial : trials) {
      const Parts p = parts(trial->point) * sum.logs.exp();
      const double spread = kNoise + kModelError * Distance(trial->point, centre_.point);
      const double residual = std::log(trial->*figure) - sum.scale - 0.5 * std::log(p.sum());
      Eigen::Vector4d gradient;
      gradient << 0.5 * (p / p.sum()).matrix(), 1;
      normal += gradient * gradient.transpose() / (spread * spread);
      right += gradient * residual / (spread * spread);
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    sum.logs = (sum.logs + step.head<3>().array().max(-0.7).min(0.7)).max(-6).min(6);
    sum.scale += step[3];
    if (step.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  return sum;
}

RateFigures RateModel::Predict(const OperatingPoint& p) const {
  // The errors of the formulas at the trials are interpolated by inverse distance weighting (Shepard 1968). Bytes
  // scatter less than KG and STED, so they follow the nearest trial more closely.
  constexpr double kBytesReach = 0.01, kErrorReach = 0.05;
  Eigen::Array3d sum = Eigen::Array3d::Zero(), weights = Eigen::Array3d::Zero();
  for (const Miss& miss : misses_) {
    const double distance = Distance(miss.point, p);
    const Eigen::Array3d reach(kBytesReach, kErrorReach, kErrorReach);
    const Eigen::Array3d weight = 1 / (distance * distance + reach.square());
    sum += weight * miss.logs;
    weights += weight;
  }
  const Eigen::Array3d correction = (sum / weights).exp();
  RateFigures f = Formulas(p);
  f.bytes *= correction[0];
  f.kg *= correction[1];
  f.sted *= correction[2];
  return f;
}

RateFigures RateModel::Formulas(const OperatingPoint& p) const {
  const OperatingPoint& c = centre_.point;
  const double motion = p.motion_step / c.motion_step, displacement = p.displacement_step / c.displacement_step;
  const double harmonics = p.harmonics / c.harmonics;
  RateFigures f;
  f.bytes = static_cast<double>(centre_.bytes) + bytes_per_bit_ * (p.position_bits - c.position_bits) +
            centre_.parts.motion * (std::pow(motion, -1.1) * std::pow(harmonics, 0.5) - 1) +
            centre_.parts.displacement *
                (std::pow(displacement, -0.75) * std::pow(motion, 0.2) * std::pow(harmonics, 0.25) - 1);
  if (c.detail_step > 0) f.bytes += centre_.parts.detail * (std::pow(p.detail_step / c.detail_step, -0.8) - 1);
  f.bytes = std::max(f.bytes, 0.05 * static_cast<double>(centre_.bytes));
  f.kg = std::exp(kg_.scale + LogRoot(KgParts(p), kg_.logs));
  f.sted = std::exp(sted_.scale + LogRoot(StedParts(p), sted_.logs));
  return f;
}

}  // namespace sac
