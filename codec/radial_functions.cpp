// SPDX-License-Identifier: Apache-2.0
#include "codec/radial_functions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sac {
namespace {

constexpr double kReach = 3;  // radius of a function in covering radii

std::uint64_t SquaredDistance(const GridPosition& a, const GridPosition& b) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t d = static_cast<std::int64_t>(a[i]) - b[i];
    sum += static_cast<std::uint64_t>(d * d);
  }
  return sum;
}

// Wendland's C2 function (Wendland 1995) of t = distance / radius, 0 <= t < 1.
double Wendland(double t) {
  const double s = (1 - t) * (1 - t);
  return s * s * (4 * t + 1);
}

}  // namespace

bool RadialFunctions(std::span<const GridPosition> grid, std::uint32_t samples, double max_values,
                     Eigen::SparseMatrix<double>& functions) {
  functions.resize(0, 0);
  // Farthest-point sampling begins with the first vertex. Of equally far vertices it takes the first.
  std::vector<std::uint64_t> distance(grid.size(), std::numeric_limits<std::uint64_t>::max());
  std::vector<std::size_t> chosen = {0};
  std::uint64_t covering = 0;
  for (;;) {
    std::size_t farthest = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
      distance[v] = std::min(distance[v], SquaredDistance(grid[v], grid[chosen.back()]));
      if (distance[v] > distance[farthest]) farthest = v;
    }
    covering = distance[farthest];
    if (chosen.size() == samples) break;
    if (covering == 0) return true;
    chosen.push_back(farthest);
  }

  const double radius = kReach * std::sqrt(static_cast<double>(std::max<std::uint64_t>(covering, 1)));
  functions.resize(static_cast<Eigen::Index>(grid.size()), samples);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    functions.startVec(static_cast<Eigen::Index>(i));
    for (std::size_t v = 0; v < grid.size(); ++v) {
      const double t = std::sqrt(static_cast<double>(SquaredDistance(grid[v], grid[chosen[i]]))) / radius;
      if (t >= 1) continue;
      if (static_cast<double>(functions.data().size()) >= max_values) return false;
      const double value = Wendland(t);
      functions.insertBack(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(i)) = value;
      sum[static_cast<Eigen::Index>(v)] += value;
    }
  }
  functions.finalize();
  sum = sum.cwiseInverse();
  for (Eigen::Index i = 0; i < functions.outerSize(); ++i) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(functions, i); it; ++it) it.valueRef() *= sum[it.row()];
  }
  return true;
}

}  // namespace sac
