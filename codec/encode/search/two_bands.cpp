#include "codec/encode/search/two_bands.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "codec/encode/search/band.h"

namespace sac {
namespace {

constexpr int kMostEvaluations = 6;
constexpr double kTens = 10;  // of quality

// Keeps the signs that the problem has, whatever a noisy pair of trials says.
void Restrain(Eigen::Matrix2d& j) {
  j(0, 0) = std::clamp(j(0, 0), -2.0, -0.1);
  j(0, 1) = std::clamp(j(0, 1), 0.0, 0.6);
  j(1, 0) = std::clamp(j(1, 0), -2.0, -0.05);
  j(1, 1) = std::clamp(j(1, 1), 0.05, 1.0);
}

}  // namespace

Status FindInTwoBands(const TwoBandsProblem& problem, Sensitivity& sensitivity, double& quality, double& log_motion) {
  Eigen::Matrix2d& j = sensitivity.matrix;
  Eigen::Vector2d last_x = Eigen::Vector2d::Zero(), last_y = Eigen::Vector2d::Zero();
  for (int i = 0; i < kMostEvaluations; ++i) {
    double kg = 0, sted = 0;
    SAC_RETURN_IF_ERROR(problem.evaluate(quality, log_motion, kg, sted));
    const Eigen::Vector2d x(quality / kTens, log_motion), y(kg, sted);
    if (i > 0) {
      const Eigen::Vector2d dx = x - last_x;
      if (dx.squaredNorm() > 1e-8) j += (y - last_y - j * dx) * dx.transpose() / dx.squaredNorm();
      Restrain(j);
    }
    const bool coarsest = log_motion >= kCoarsestMotion, finest = log_motion <= kFinestMotion;
    if ((InBand(kg) || (finest && kg < 0)) && (InBand(sted) || (coarsest && sted < 0)) &&
        (InBand(kg) || InBand(sted))) {
      return Status::Ok();
    }
    const Eigen::Vector2d wanted = Eigen::Vector2d::Constant(kBandAim) - y;
    Eigen::Vector2d step = j.inverse() * wanted;
    step[1] = std::clamp(step[1], -0.8, 0.8);
    const double motion = std::clamp(log_motion + step[1], kFinestMotion, kCoarsestMotion);
    step[1] = motion - log_motion;
    // With the motion step settled or at its end: the quality for the figure that is critical.
    const double for_kg = (wanted[0] - j(0, 1) * step[1]) / j(0, 0);
    const double for_sted = (wanted[1] - j(1, 1) * step[1]) / j(1, 0);
    step[0] = std::clamp(std::max(for_kg, for_sted), -1.5, 1.5);
    if (motion > kFinestMotion && motion < kCoarsestMotion) step[0] = std::clamp(for_kg, -1.5, 1.5);
    last_x = x;
    last_y = y;
    quality = std::clamp(quality + kTens * step[0], problem.least_quality, problem.most_quality);
    log_motion = motion;
  }
  return Status::Ok();
}

}  // namespace sac
