// SPDX-License-Identifier: Apache-2.0
#include "decomposition/frame_sketch.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace sac {
namespace {

constexpr std::size_t kOversampling = 2;  // test vectors, times the columns
constexpr std::size_t kMoreTests = 10;
constexpr int kEntries = 4;  // of the test matrix in each of its columns

// A mixing of 64 bits (Steele et al. 2014, SplitMix64), so that tests are the same everywhere.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

FrameSketch::FrameSketch(std::size_t frames, std::size_t columns)
    : columns_(columns),
      sketch_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kOversampling * columns + kMoreTests),
                                    static_cast<Eigen::Index>(frames))) {}

void FrameSketch::Add(std::size_t f, const std::vector<float>& values, const std::vector<float>& mass,
                      std::size_t channels) {
  auto column = sketch_.col(static_cast<Eigen::Index>(f));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = std::sqrt(static_cast<double>(mass[i / channels])) * static_cast<double>(values[i]);
    for (int entry = 0; entry < kEntries; ++entry) {
      const std::uint64_t bits = Mix(kEntries * i + static_cast<std::uint64_t>(entry));
      const auto test = static_cast<Eigen::Index>((bits >> 1) % static_cast<std::uint64_t>(sketch_.rows()));
      column[test] += (bits & 1) != 0 ? x : -x;
    }
  }
}

Eigen::MatrixXf FrameSketch::Basis() const {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(sketch_.transpose(), Eigen::ComputeThinU);
  return svd.matrixU()
      .leftCols(std::min<Eigen::Index>(static_cast<Eigen::Index>(columns_), svd.matrixU().cols()))
      .cast<float>();
}

double AddToBasis(std::size_t f, const std::vector<float>& values, NodeField& field) {
  const Eigen::RowVectorXf coefficients = field.basis.row(static_cast<Eigen::Index>(f));
  double energy = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto x = static_cast<double>(values[i]);
    energy += static_cast<double>(field.mass[i / field.channels]) * x * x;
    Eigen::Map<Eigen::RowVectorXf>(field.values.data() + i * field.columns, static_cast<Eigen::Index>(field.columns)) +=
        values[i] * coefficients;
  }
  return energy;
}

double DroppedEnergy(const NodeField& field, double energy) {
  double kept = 0;
  for (std::size_t i = 0; i < field.nodes; ++i) {
    const Eigen::Map<const Eigen::VectorXf> x(field.row(i), static_cast<Eigen::Index>(field.channels * field.columns));
    kept += static_cast<double>(field.mass[i]) * static_cast<double>(x.squaredNorm());
  }
  return energy > 0 ? std::max(0.0, 1 - kept / energy) : 0;
}

}  // namespace sac
