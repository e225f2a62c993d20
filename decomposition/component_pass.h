// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "decomposition/alternation.h"
#include "decomposition/node_field.h"

namespace sac {

// All that weights and sites need of the components: one pass over the nodes.
struct PassSums {
  Eigen::MatrixXd p;                // X C^T m, frames x count
  Eigen::MatrixXd h;                // C m C^T, count x count
  Eigen::VectorXd penalty;          // one a component
  std::vector<std::uint32_t> peak;  // the node of each component's largest |c|
  std::vector<float> peak_square;   // and that |c|^2
};

// Computes the sums and, with `update`, first finds the components anew for the weights as they are, each node by
// coordinate descent over its components. `sites` of `state` that keep their values are left alone.
void RunPass(const NodeField& field, bool update, std::uint32_t threads, Alternation& state, PassSums& sums);

// The sum of m |X - W C|^2 over nodes, frames and channels, from the differences themselves.
double ResidualSquare(const NodeField& field, const Alternation& state, std::uint32_t threads);

}  // namespace sac
