#pragma once

#include <Eigen/Core>
#include <functional>

#include "format/status.h"

namespace sac {

// How the logarithms of KG and STED (rows) answer to ten steps of quality and to the logarithm of the motion step
// (columns), about. It is learnt on the way.
struct Sensitivity {
  Eigen::Matrix2d matrix = (Eigen::Matrix2d() << -0.3, 0.1, -0.25, 0.4).finished();
};

// How far the motion step goes from the table of qualities, logarithms.
inline constexpr double kFinestMotion = -1.5, kCoarsestMotion = 1.1;

struct TwoBandsProblem {
  // Logarithms of figure / target.
  std::function<Status(double quality, double log_motion, double& kg, double& sted)> evaluate;
  double least_quality, most_quality;
};

// Looks for a quality and a motion step at which KG and STED are in their bands (codec/encode/search/band.h): the
// secant method of Broyden, "A class of methods for solving nonlinear simultaneous equations", 1965. Where the motion
// step has no more say, only the figure that remains critical is followed.
Status FindInTwoBands(const TwoBandsProblem& problem, Sensitivity& sensitivity, double& quality, double& log_motion);

}  // namespace sac
