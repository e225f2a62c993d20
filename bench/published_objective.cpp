// SPDX-License-Identifier: Apache-2.0
// Minimizes the objective of Neumann et al. 2013 as it was published, without areas, rigid motion and a scale of its
// own, by the alternation of decomposition/, and prints a line of JSON. bench/components_reference runs it beside the
// published algorithm.
// usage: published_objective MESH CACHE COUNT ITERATIONS
//        published_objective MESH CACHE distances
// The second form reads numbers of vertices, each a line, and answers with the distances of all vertices from it along
// the surface of the first frame, in longest sides of its box, as raw doubles.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "decomposition/alternation.h"
#include "decomposition/rest_alignment.h"
#include "decomposition/surface_distance.h"
#include "files/clip_input.h"

namespace sac::bench {
namespace {

constexpr double kLambda = 2, kNear = 0.1, kFar = 0.7;  // the radii in longest sides of the rest shape's box

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Displacements {
  NodeField field;
  PositionMatrix rest;
  double scale = 1;  // by which the field's values are to be multiplied
  double side = 0;   // the longest side of the box of all frames
};

// The displacements from the first frame, divided by the deviation of all their coordinates.
Status Read(ClipReader& clip, Displacements& read) {
  std::vector<PositionMatrix> frames;
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(INFINITY), high = -low;
  SAC_RETURN_IF_ERROR(
      ForEachFrame(clip, clip.mesh().positions.size(), [&](std::uint32_t, const PositionMatrix& positions) {
        low = low.cwiseMin(positions.colwise().minCoeff());
        high = high.cwiseMax(positions.colwise().maxCoeff());
        frames.push_back(positions);
        return Status::Ok();
      }));
  if (frames.empty()) return Status::InvalidArgument("no frames");
  read.side = (high - low).maxCoeff();
  read.rest = frames.front();
  const auto values = static_cast<double>(frames.size()) * static_cast<double>(read.rest.size());
  double sum = 0, square = 0;
  for (PositionMatrix& frame : frames) {
    frame -= read.rest;
    sum += frame.sum();
    square += frame.squaredNorm();
  }
  read.scale = std::sqrt(std::max(square / values - sum * sum / (values * values), 1e-300));
  NodeField& field = read.field;
  field.nodes = static_cast<std::size_t>(read.rest.rows());
  field.channels = 3;
  field.columns = frames.size();
  field.values.resize(3 * field.nodes * field.columns);
  field.mass.assign(field.nodes, 1);
  for (std::size_t i = 0; i < 3 * field.nodes; ++i) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const double x = frames[f](static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
      field.values[i * field.columns + f] = static_cast<float>(x / read.scale);
    }
  }
  return Status::Ok();
}

Status Answer(const SurfaceDistance& distance, double unit, std::size_t vertices) {
  unsigned long vertex = 0;
  while (std::scanf("%lu", &vertex) == 1) {
    if (vertex >= vertices) return Status::InvalidArgument("there is no vertex " + std::to_string(vertex));
    const SurfaceDistance::Seed seed{static_cast<std::uint32_t>(vertex), 0};
    std::vector<double> answer = distance.From({&seed, 1}, INFINITY);
    for (double& d : answer) d /= unit;
    std::fwrite(answer.data(), sizeof(double), answer.size(), stdout);
    std::fflush(stdout);
  }
  return Status::Ok();
}

Status Run(char** arguments) {
  std::unique_ptr<ClipInput> clip;
  SAC_RETURN_IF_ERROR(ClipInput::Open({arguments[1], arguments[2]}, clip));
  Displacements read;
  SAC_RETURN_IF_ERROR(Read(*clip, read));
  const SurfaceDistance distance(read.rest, clip->mesh().triangles);
  const double unit = (read.rest.colwise().maxCoeff() - read.rest.colwise().minCoeff()).maxCoeff();
  if (std::string(arguments[3]) == "distances") return Answer(distance, unit, read.field.nodes);
  AlternationSettings settings;
  settings.count = static_cast<std::size_t>(std::strtoul(arguments[3], nullptr, 10));
  settings.iterations = static_cast<std::uint32_t>(std::strtoul(arguments[4], nullptr, 10));
  settings.sparsity = kLambda / static_cast<double>(read.field.frames());
  settings.near = kNear * unit;
  settings.far = kFar * unit;
  settings.steep = 1;
  settings.positive = true;
  settings.tolerance = 0;
  settings.threads = 1;
  settings.distance = [&distance](const std::vector<std::uint32_t>& nodes, double most) {
    std::vector<SurfaceDistance::Seed> seeds;
    for (const std::uint32_t v : nodes) seeds.push_back({v, 0});
    return distance.From(seeds, most);
  };
  const double start = CpuSeconds();
  std::vector<double> seconds;
  settings.progress = [&](std::uint32_t iteration, double) {
    if (iteration > 0) seconds.push_back(CpuSeconds() - start);
    return true;
  };
  Alternation found;
  SAC_RETURN_IF_ERROR(Alternate(read.field, settings, found));
  std::size_t moves = 0;
  for (std::size_t i = 0; i < read.field.nodes; ++i) {
    for (std::size_t k = 0; k < found.count; ++k) {
      const float* c = found.components.data() + 3 * i * found.count + k;
      moves += c[0] != 0 || c[found.count] != 0 || c[2 * found.count] != 0 ? 1 : 0;
    }
  }
  const auto values = static_cast<double>(3 * read.field.nodes * read.field.frames());
  std::printf("{\"erms\": %.6g, \"nonzero\": %.6g, \"objective\": [",
              1000 * read.scale * std::sqrt(found.residual / values) / read.side,
              static_cast<double>(moves) / static_cast<double>(read.field.nodes * found.count));
  for (std::size_t i = 0; i < found.objective.size(); ++i) {
    std::printf("%s[%.8g, %.4g]", i > 0 ? ", " : "", found.objective[i], seconds[i]);
  }
  std::printf("]}\n");
  return Status::Ok();
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  if (argc != 5 && !(argc == 4 && std::string(argv[3]) == "distances")) {
    std::fprintf(stderr, "usage: published_objective MESH CACHE (COUNT ITERATIONS | distances)\n");
    return 2;
  }
  const sac::Status status = sac::bench::Run(argv);
  if (!status.ok()) std::fprintf(stderr, "published_objective: %s\n", status.message().c_str());
  return status.ok() ? 0 : 1;
}
