// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "decomposition/node_field.h"
#include "sac/status.h"

namespace sac {

// Where a component is: its support grows from `nodes`.
struct ComponentSite {
  std::vector<std::uint32_t> nodes;
  bool fixed = false;         // the alternation never moves the site
  std::vector<float> values;  // nodes x channels that the component keeps; empty: it is found
};

struct AlternationSettings {
  std::size_t count = 40;
  double sparsity = 0.03;  // lambda is sparsity * frames, so that repeating all frames changes nothing
  double near = 0.1, far = 0.5,
         steep = 3;       // the ramp of lambda: 0 up to `near`, 1 at `far`, at most `steep`; as distances
  bool positive = false;  // 0 <= w <= 1, otherwise |w| <= 1
  std::uint32_t iterations = 60, moving = 20;
  double tolerance = 1e-4;
  std::uint32_t threads = 0;
  std::vector<ComponentSite> sites;  // of the first components
  std::vector<std::uint32_t> still;  // nodes at which every component is zero
  std::function<std::vector<double>(const std::vector<std::uint32_t>& nodes, double most)> distance;
  std::function<bool(std::uint32_t iteration, double objective)> progress;  // false: stop with kCancelled
};

// W and C of the objective
//
//   E = 1/2 sum_i m_i |X_i - W C_i|^2 + lambda sum_k sum_i m_i ramp(d(i, J_k)) |c_ki|,   |w| <= 1 or 0 <= w <= 1,
//
// of Neumann et al. 2013, equations 3 to 6, with the nodes' masses m and the site J_k of each component among what is
// found.
struct Alternation {
  std::size_t count = 0;
  Eigen::MatrixXd weights;        // frames x count
  std::vector<float> components;  // [node][channel][count]
  std::vector<float> cost;        // [node][count]: lambda times ramp
  std::vector<ComponentSite> sites;
  std::vector<double> objective;  // E after each iteration
  double square = 0;              // sum of m |X|^2
  double residual = 0;            // sum of m |X - W C|^2
  bool converged = false;
};

// Minimizes E for `field` by exact block coordinate descent: deflation, then weights, sites and components in turn. No
// step raises E. The result does not depend on the number of threads. Components are in the order of their energy,
// those of settings.sites first in their own. kCancelled where progress asked for it.
Status Alternate(const NodeField& field, const AlternationSettings& settings, Alternation& result);

}  // namespace sac
