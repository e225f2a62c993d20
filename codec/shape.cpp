// SPDX-License-Identifier: Apache-2.0
#include "codec/shape.h"

#include <algorithm>
#include <string>
#include <utility>

#include "format/memory.h"
#include "geometry/sparse_cholesky.h"

namespace sac {

namespace {

constexpr std::uint64_t kFactorMemory = 12;  // bytes per value of a sparse factor: a double and its row
constexpr std::uint64_t kFieldMemory = 700;  // bytes per vertex of a Reconstructor and of the frames it has ready

// Checks the sizes of the harmonics against the limits and notes in `shape` their work and memory.
Status CheckHarmonics(const SequenceHeader& header, std::span<const Component> components,
                      std::span<const std::uint32_t> counts, std::uint32_t samples_per_harmonic, const Limits& limits,
                      Shape& shape) {
  double& work = shape.work;
  double memory = static_cast<double>(MeshMemory(header.vertices, header.triangles));
  std::uint64_t values = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0 || counts[i] > components[i].count) {
      return Status::Corrupt("I-frame: more harmonics than vertices in a component");
    }
    if (counts[i] > limits.expert.harmonics) return Status::Limit("more harmonics in a component than the limit");
    values += static_cast<std::uint64_t>(counts[i]) * components[i].count;
    const double samples = static_cast<double>(samples_per_harmonic) * counts[i];
    work += HarmonicsWork(components[i].count, counts[i], samples);
    memory += HarmonicsMemory(components[i].count, counts[i], samples);
  }
  if (header.detail_step > 0) {
    work += 10.0 * header.patch_size * header.patch_size * header.vertices;
    values += static_cast<std::uint64_t>(header.patch_size) * header.vertices;
    memory += static_cast<double>(sizeof(double)) * header.patch_size * header.vertices;
  }
  if (work > limits.work) return Status::Limit("the harmonic basis takes more work than the limit");
  if (values > limits.expert.basis_values) return Status::Limit("the harmonic basis is larger than the limit");
  if (memory > static_cast<double>(limits.memory))
    return Status::Limit("the harmonic basis takes more memory than the limit");
  shape.memory = static_cast<std::uint64_t>(memory);
  return Status::Ok();
}

// Checks the work and memory of the sparse linear systems against the limits and adds them to those of `shape`. The
// factorization of the whole mesh's Laplacian is analyzed here, and those of its components and patches are counted as
// no larger: the shape is charged with the work of three and the memory of two, and each frame that references the
// frame before with the work of one more.
Status CheckSystems(const SequenceHeader& header, const Limits& limits, Shape& shape) {
  const auto vertices = static_cast<std::uint32_t>(shape.vertices());
  const FactorSize max_size{std::min(limits.expert.factor_values, (limits.memory - shape.memory) / (2 * kFactorMemory)),
                            (limits.work - shape.work) / 3};
  SparseCholesky probe;
  if (!probe.Analyze(LaplacianMatrix(shape.edges.ends, shape.weights, 0, vertices), max_size)) {
    return Status::Limit("the mesh is too entangled: its linear system takes more work or memory than the limit");
  }
  shape.work += 3 * probe.size().work;
  shape.memory += 2 * kFactorMemory * probe.size().values;
  shape.reconstructor_memory = kFactorMemory * probe.size().values + kFieldMemory * vertices;
  if (MaxGroupValues(limits, shape) < FrameValues(shape.layouts))
    return Status::Limit("a frame takes more memory than the limit");
  double frame = 6.0 * static_cast<double>(probe.size().values);
  for (const PlaneLayout& layout : {shape.layouts[kMotion], shape.layouts[kDisplacement]}) {
    frame += static_cast<double>(layout.size()) * vertices;
  }
  if (header.references_previous()) frame += probe.size().work;
  if (frame > limits.expert.frame_work) return Status::Limit("a frame takes more work than the limit");
  return Status::Ok();
}

}  // namespace

Limits LimitsOfIFrame(const Limits& limits, std::size_t i_frame_bytes) {
  Limits narrowed = limits;
  narrowed.work =
      std::min(limits.work, limits.expert.free_work + limits.expert.work_per_byte * static_cast<double>(i_frame_bytes));
  return narrowed;
}

std::uint64_t MaxGroupValues(const Limits& limits, const Shape& shape) {
  return std::min(limits.expert.group_values,
                  (limits.memory - std::min(limits.memory, shape.memory)) / kCoefficientMemory);
}

unsigned UseThreads(unsigned threads, const Limits& limits, Shape& shape) {
  const std::uint64_t spare = limits.memory - std::min(limits.memory, shape.memory);
  const std::uint64_t more =
      std::min<std::uint64_t>(threads - 1, spare / 2 / std::max<std::uint64_t>(1, shape.reconstructor_memory));
  shape.memory += more * shape.reconstructor_memory;
  return static_cast<unsigned>(1 + more);
}

Status BuildShape(const SequenceHeader& header, DecodedMesh mesh, std::span<const std::uint32_t> counts,
                  std::uint32_t samples_per_harmonic, const Limits& limits, Shape& shape) {
  if (counts.size() != mesh.components.size()) {
    return Status::Corrupt("I-frame: " + std::to_string(mesh.components.size()) + " components, but harmonics for " +
                           std::to_string(counts.size()));
  }
  shape.work = 0;
  SAC_RETURN_IF_ERROR(CheckHarmonics(header, mesh.components, counts, samples_per_harmonic, limits, shape));

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
  SAC_RETURN_IF_ERROR(CheckSystems(header, limits, shape));
  if (header.detail_step > 0) {
    // Equal masses make the harmonics of each patch orthogonal without weights.
    const Eigen::VectorXd alike = Eigen::VectorXd::Ones(shape.positions.rows());
    SAC_RETURN_IF_ERROR(ComputeHarmonics({shape.edges, shape.weights, alike, mesh.grid, mesh.patches, patch_sizes}, {},
                                         shape.patch_basis));
  }
  const Spare spare{limits.work - shape.work, static_cast<double>(limits.memory - shape.memory)};
  return ComputeHarmonics(
      {shape.edges, shape.weights, shape.masses, mesh.grid, shape.components, counts, samples_per_harmonic}, spare,
      shape.basis);
}

}  // namespace sac
