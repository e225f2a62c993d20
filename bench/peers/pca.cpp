// SPDX-License-Identifier: Apache-2.0
// Trajectory PCA with neighbour prediction: the family of CoDDyaC (Vasa and Skala, "CODDYAC: connectivity driven
// dynamic mesh compression", 3DTV 2007; "COBRA: compression of the basis for PCA represented animations", CGF 28(6),
// 2009).
//
// The path of a vertex over all F frames is a vector of 3F coordinates. The mean of the paths and their K principal
// directions are sent, and for each vertex K coefficients, predicted by parallelograms from decoded neighbours.
// Coefficients, directions and mean are quantized and coded by an adaptive range coder with models of its own for each
// of the K components.
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bench/peers/connectivity.h"
#include "bench/peers/neighbour_prediction.h"
#include "bench/peers/peer.h"
#include "format/bytes.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"

namespace sac::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The contents of a stream as integers. The decoder fills it in.
struct Code {
  std::uint32_t frames = 0, components = 0;
  float step = 0;                          // step of the coefficients, model units
  std::vector<float> basis_steps;          // step of the entries of each direction
  std::vector<std::vector<int>> rows;      // the mean, then each direction; 3F integers each
  std::vector<std::vector<int>> vertices;  // the residuals of each vertex; K integers each
};

// Predicts an entry of the mean or a direction, which move smoothly, on the line through the two frames before.
int Extrapolate(const std::vector<int>& row, std::size_t i) {
  return i >= 6 ? 2 * row[i - 3] - row[i - 6] : i >= 3 ? row[i - 3] : 0;
}

template <class Coder>
void CodeRows(Coder& coder, Code& code) {
  for (std::vector<int>& row : code.rows) {
    SignedModels models;  // rows differ in scale
    for (std::size_t i = 0; i < row.size(); ++i) {
      const int predicted = Extrapolate(row, i);
      int residual = Coder::kDecodes ? 0 : row[i] - predicted;
      CodeSigned(coder, models, residual);
      row[i] = predicted + residual;
    }
  }
}

// Codes the residuals. The context is the size of the magnitudes of the vertex before, which are likely to be similar.
template <class Coder>
void CodeVertices(Coder& coder, Code& code) {
  constexpr std::size_t kActivities = 6;
  std::vector<std::array<SignedModels, kActivities>> models(code.components);
  std::vector<double> activity(code.components);
  for (std::vector<int>& vertex : code.vertices) {
    for (std::size_t k = 0; k < code.components; ++k) {
      const auto context = static_cast<std::size_t>(std::clamp(std::log2(activity[k] + 0.25) + 2, 0.0, 5.0));
      CodeSigned(coder, models[k][context], vertex[k]);
      activity[k] = 0.8 * activity[k] + 0.2 * std::abs(vertex[k]);
    }
  }
}

// The step of the mean, chosen such that the squared error of all its entries together is a quarter of that of a
// vertex's coefficients.
float MeanStep(const Code& code) {
  return 0.5f * code.step * std::sqrt(static_cast<float>(code.components) / static_cast<float>(3 * code.frames));
}

MatrixXd Dequantize(const Code& code) {  // 3F x (1 + K), the mean first
  MatrixXd rows(3 * code.frames, code.components + 1);
  for (std::size_t k = 0; k <= code.components; ++k) {
    const float step = k == 0 ? MeanStep(code) : code.basis_steps[k - 1];
    for (std::size_t i = 0; i < code.rows[k].size(); ++i) {
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = static_cast<double>(step) * code.rows[k][i];
    }
  }
  return rows;
}

std::vector<int> Quantize(const VectorXd& values, float step) {
  std::vector<int> out;
  for (const double x : values) out.push_back(static_cast<int>(std::lround(x / static_cast<double>(step))));
  return out;
}

// The paths of the vertices as columns, in the order in which they are coded: 3F x n.
MatrixXd PathsOf(const Clip& clip, const std::vector<std::uint32_t>& order) {
  MatrixXd paths(3 * clip.frames.size(), order.size());
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    for (std::size_t v = 0; v < order.size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        paths(static_cast<Eigen::Index>(3 * f + a), static_cast<Eigen::Index>(v)) =
            static_cast<double>(clip.frames[f][order[v]][a]);
      }
    }
  }
  return paths;
}

// Chooses the directions and the steps. The squared error by quantized coefficients is in proportion to the energy that
// the directions leave out, and equal to it for a coarseness of 1; that of the quantized directions is a quarter of it.
// On a captured human, coarseness 0.5 to 1 give the same curve of rate and KG, and 2 gives a worse one.
Code QuantizeBasis(const MatrixXd& centred, const VectorXd& mean, std::uint32_t components) {
  const Eigen::Index n = centred.cols(), dimension = centred.rows();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(centred * centred.transpose());
  const VectorXd energy = solver.eigenvalues().cwiseMax(0).reverse();
  Code code;
  code.frames = static_cast<std::uint32_t>(dimension / 3);
  code.components = std::min(components, static_cast<std::uint32_t>(dimension));
  const auto k = static_cast<Eigen::Index>(code.components);
  const double left = energy.tail(dimension - k).sum() / static_cast<double>(n) + 1e-12 * energy.sum();
  constexpr double kCoarseness = 0.7;
  code.step = static_cast<float>(kCoarseness * std::sqrt(12 * left / static_cast<double>(k)));
  code.rows.push_back(Quantize(mean, MeanStep(code)));
  for (Eigen::Index c = 0; c < k; ++c) {
    const double deviation = std::sqrt(energy[c] / static_cast<double>(n)) + 1e-30;
    const double step = 0.5 * static_cast<double>(code.step) / (deviation * std::sqrt(static_cast<double>(dimension)));
    code.basis_steps.push_back(static_cast<float>(std::min(step, 1.0)));
    code.rows.push_back(Quantize(solver.eigenvectors().col(dimension - 1 - c), code.basis_steps.back()));
  }
  return code;
}

Status Encode(const Clip& clip, const std::string& setting, PeerStream& stream) {
  double wanted = 0;
  if (!ParseNumber(setting, wanted)) return Status::InvalidArgument(setting + ": not a number of components");
  ByteWriter out;
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
  stream.order = connectivity.order;
  const MatrixXd paths = PathsOf(clip, connectivity.order);
  const VectorXd mean = paths.rowwise().mean();
  Code code = QuantizeBasis(paths.colwise() - mean, mean, static_cast<std::uint32_t>(wanted));

  // The coefficients are computed for the decoder's basis, whose quantized directions are not quite orthogonal.
  const MatrixXd rows = Dequantize(code), basis = rows.rightCols(code.components);
  const MatrixXd coefficients =
      (basis.transpose() * basis).ldlt().solve(basis.transpose() * (paths.colwise() - rows.col(0)));
  NeighbourPrediction prediction(connectivity.triangles, connectivity.vertices, code.components);
  code.vertices.assign(connectivity.vertices, std::vector<int>(code.components));
  for (std::size_t i = 0; i < connectivity.vertices; ++i) {
    const std::uint32_t v = prediction.vertex(i);
    const std::vector<int>& predicted = prediction.Predict(i);
    std::vector<int> value = Quantize(coefficients.col(v), code.step);
    for (std::size_t k = 0; k < code.components; ++k) code.vertices[i][k] = value[k] - predicted[k];
    prediction.Set(i, value);
  }
  out.Varint(code.frames);
  out.Varint(code.components);
  out.F32(code.step);
  for (const float step : code.basis_steps) out.F32(step);
  RangeEncoder coder;
  CodeRows(coder, code);
  CodeVertices(coder, code);
  out.Bytes(coder.Finish());
  stream.bytes = out.bytes();
  return Status::Ok();
}

Status Decode(std::span<const std::uint8_t> bytes, Clip& clip) {
  ByteReader in(bytes);
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
  Code code;
  code.frames = in.Varint();
  code.components = in.Varint();
  code.step = in.F32();
  for (std::uint32_t k = 0; k < code.components && in.ok(); ++k) code.basis_steps.push_back(in.F32());
  if (!in.ok()) return Status::Corrupt("truncated stream");
  RangeDecoder coder(in.Bytes(in.remaining()));
  code.rows.assign(code.components + 1, std::vector<int>(std::size_t{3} * code.frames));
  code.vertices.assign(connectivity.vertices, std::vector<int>(code.components));
  CodeRows(coder, code);
  CodeVertices(coder, code);
  if (!coder.ok()) return Status::Corrupt("truncated stream");

  const MatrixXd rows = Dequantize(code), basis = rows.rightCols(code.components);
  NeighbourPrediction prediction(connectivity.triangles, connectivity.vertices, code.components);
  clip.mesh.triangles = connectivity.triangles;
  clip.frames.assign(code.frames, Positions(connectivity.vertices));
  VectorXd coefficients(code.components);
  for (std::size_t i = 0; i < connectivity.vertices; ++i) {
    std::vector<int> value = prediction.Predict(i);
    for (std::size_t k = 0; k < code.components; ++k) {
      value[k] += code.vertices[i][k];
      coefficients[static_cast<Eigen::Index>(k)] = static_cast<double>(code.step) * value[k];
    }
    prediction.Set(i, value);
    const VectorXd path = rows.col(0) + basis * coefficients;
    for (std::uint32_t j = 0; j < 3 * code.frames; ++j) {
      clip.frames[j / 3][prediction.vertex(i)][j % 3] = static_cast<float>(path[j]);
    }
  }
  return Status::Ok();
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(argc, argv,
                             {"trajectory PCA (CoDDyaC family)",
                              "re-implemented",
                              "components",
                              {"10", "20", "40", "60", "90", "120", "160"},
                              sac::bench::Encode,
                              sac::bench::Decode});
}
