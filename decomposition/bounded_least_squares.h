// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace sac {

// Minimizes 1/2 w^T h w - g^T w over low <= w <= high by coordinate descent from `start`, `h` symmetric and positive
// semidefinite. Variables whose diagonal is 0 keep their start.
Eigen::VectorXd BoundedLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& start,
                                    double low, double high);

// Minimizes 1/2 w^T h w - g^T w + sum of price_k |w_k| over low <= w <= high, from 0.
Eigen::VectorXd SparseLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& price,
                                   const Eigen::VectorXd& low, const Eigen::VectorXd& high);

}  // namespace sac
