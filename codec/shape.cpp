#include "codec/shape.h"

#include <string>
#include <utility>

namespace sac {

namespace {

// Multiplications that the harmonics of a component take, about: a dense problem of its vertices or samples, and the
// products with its vertices.
double BasisWork(double vertices, double harmonics, double samples) {
  const bool reduced = samples > 0 && samples < vertices;
  const bool dense = 2 * harmonics + 20 >= vertices;
  const double size = reduced ? samples : dense ? vertices : 0;
  return size * size * size + 10 * vertices * harmonics * harmonics;
}

}  // namespace

Status BuildShape(const SequenceHeader& header, DecodedMesh mesh, std::span<const std::uint32_t> counts,
                  std::uint32_t samples_per_harmonic, const Limits& limits, Shape& shape) {
  if (counts.size() != mesh.components.size()) {
    return Status::Corrupt("I-frame: " + std::to_string(mesh.components.size()) + " components, but harmonics for " +
                           std::to_string(counts.size()));
  }
  std::uint64_t values = 0;
  double work = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0 || counts[i] > mesh.components[i].count) {
      return Status::Corrupt("I-frame: more harmonics than vertices in a component");
    }
    if (counts[i] > limits.harmonics) return Status::Limit("more harmonics in a component than the limit");
    values += static_cast<std::uint64_t>(counts[i]) * mesh.components[i].count;
    work += BasisWork(mesh.components[i].count, counts[i], static_cast<double>(samples_per_harmonic) * counts[i]);
  }
  if (header.detail_step > 0) work += 10.0 * header.patch_size * header.patch_size * header.vertices;
  if (work > limits.basis_work) return Status::Limit("the harmonic basis takes more work than the limit");
  if (header.detail_step > 0) values += static_cast<std::uint64_t>(header.patch_size) * header.vertices;
  if (values > limits.basis_values) return Status::Limit("the harmonic basis is larger than the limit");

  shape.triangles = std::move(mesh.triangles);
  shape.components = std::move(mesh.components);
  shape.edges = BuildEdges(shape.triangles);
  shape.positions.resize(static_cast<Eigen::Index>(mesh.grid.size()), 3);
  const Eigen::RowVector3d origin(header.origin_x, header.origin_y, header.origin_z);
  for (std::size_t v = 0; v < mesh.grid.size(); ++v) {
    const GridPosition& g = mesh.grid[v];
    shape.positions.row(static_cast<Eigen::Index>(v)) =
        origin + static_cast<double>(header.cell) * Eigen::RowVector3d(g[0], g[1], g[2]);
  }
  shape.weights = CotangentWeights(shape.positions, shape.triangles, shape.edges);
  shape.masses = VertexMasses(shape.positions, shape.triangles);
  shape.centre = shape.masses.transpose() * shape.positions;
  std::vector<std::uint32_t> patch_sizes;
  for (const Component& patch : mesh.patches) patch_sizes.push_back(patch.count);
  shape.layouts = LayOutPlanes(header, counts, patch_sizes);
  if (header.detail_step > 0) {
    // Every vertex alike: a plain orthogonal basis of each patch.
    const Eigen::VectorXd alike = Eigen::VectorXd::Ones(shape.positions.rows());
    SAC_RETURN_IF_ERROR(ComputeHarmonics(shape.edges, shape.weights, alike, mesh.grid, mesh.patches, patch_sizes, 0,
                                         shape.patch_basis));
  }
  return ComputeHarmonics(shape.edges, shape.weights, shape.masses, mesh.grid, shape.components, counts,
                          samples_per_harmonic, shape.basis);
}

}  // namespace sac
