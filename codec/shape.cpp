// SPDX-License-Identifier: Apache-2.0
#include "codec/shape.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "codec/handles.h"
#include "format/memory.h"
#include "geometry/sparse_cholesky.h"

namespace sac {

namespace {

constexpr std::uint64_t kFactorMemory = 12;     // bytes per value of a sparse factor: a double and its row
constexpr std::uint64_t kFieldMemory = 100;     // bytes per vertex of a Reconstructor and of the frames it has ready
constexpr std::uint64_t kHandleMemory = 220;    // bytes per handle of a Reconstructor
constexpr std::uint64_t kFunctionMemory = 110;  // bytes per function of a Reconstructor

// The number of handles of each component. A shape that changes from frame to frame has its vertices for handles.
std::vector<std::uint32_t> HandleCounts(const SequenceHeader& header, std::span<const Component> components,
                                        std::span<const std::uint32_t> harmonics, std::uint32_t handles_per_harmonic) {
  std::vector<std::uint32_t> counts;
  for (std::size_t i = 0; i < components.size(); ++i) {
    counts.push_back(
        HandleCount(components[i].count, harmonics[i], header.references_previous() ? 0 : handles_per_harmonic));
  }
  return counts;
}

// Checks the sizes of the harmonics against the limits and notes in `shape` their work and memory.
Status CheckHarmonics(const SequenceHeader& header, std::span<const Component> components,
                      std::span<const std::uint32_t> counts, std::span<const std::uint32_t> handles,
                      const Limits& limits, Shape& shape) {
  double& work = shape.work;
  double memory = static_cast<double>(MeshMemory(header.vertices, header.copies, header.triangles));
  double values = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > limits.expert.harmonics) return Status::Limit("more harmonics in a component than the limit");
    values += (handles[i] == components[i].count ? 1.0 : 5.0) * counts[i] * handles[i];
    work += HarmonicsWork(components[i].count, counts[i], handles[i]);
    memory += HarmonicsMemory(components[i].count, counts[i], handles[i]);
  }
  if (header.detail_step > 0) {
    work += 10.0 * header.patch_size * header.patch_size * header.vertices;
    values += static_cast<double>(header.patch_size) * header.vertices;
    memory += static_cast<double>(sizeof(double)) * header.patch_size * header.vertices;
  }
  if (work > limits.work) return Status::Limit("the harmonic basis takes more work than the limit");
  if (values > static_cast<double>(limits.expert.basis_values))
    return Status::Limit("the harmonic basis is larger than the limit");
  if (memory > static_cast<double>(limits.memory))
    return Status::Limit("the harmonic basis takes more memory than the limit");
  shape.memory = static_cast<std::uint64_t>(memory);
  return Status::Ok();
}

// Factorizes the linear system after checking its work and memory against the limits, and adds them to those of
// `shape`. The factors of components and patches are counted as no larger: the shape is charged with the work of three
// and the memory of two, and each frame that references the frame before with the work and memory of one more.
Status FactorizeSystem(const SequenceHeader& header, std::span<const std::uint32_t> harmonics, const Limits& limits,
                       Shape& shape) {
  const std::uint64_t spare = limits.memory - std::min(limits.memory, shape.memory + shape.system->memory());
  const FactorSize max_size{std::min(limits.expert.factor_values, spare / (2 * kFactorMemory)),
                            (limits.work - shape.work) / 3};
  if (!shape.system->Analyze(max_size)) {
    return Status::Limit("the mesh is too entangled: its linear system takes more work or memory than the limit");
  }
  const FactorSize& size = shape.system->size();
  shape.work += 3 * size.work;
  shape.memory += 2 * kFactorMemory * size.values + shape.system->memory();
  shape.reconstructor_memory = kHandleMemory * shape.blend.handles().vertices.size() +
                               kFunctionMemory * shape.blend.columns() +
                               kFieldMemory * (shape.vertices() + header.copies);
  if (header.references_previous()) {
    shape.reconstructor_memory += kFactorMemory * size.values + shape.system->memory();
    shape.memory += kFactorMemory * size.values + shape.system->memory();
  }
  if (MaxGroupValues(limits, shape) < FrameValues(shape.layouts))
    return Status::Limit("a frame takes more memory than the limit");
  double frame = shape.system->work() + 100.0 * static_cast<double>(shape.vertices());
  for (std::size_t c = 0; c < harmonics.size(); ++c) {
    frame += harmonics[c] * (9.0 * shape.blend.handles().components[c].count + 3.0 * shape.blend.functions()[c].count);
  }
  if (header.references_previous()) frame += size.work;
  if (frame > limits.expert.frame_work) return Status::Limit("a frame takes more work than the limit");
  return shape.system->Factorize() ? Status::Ok() : Status::Corrupt("the first frame's shape is singular");
}

}  // namespace

PositionMatrix ShapePositions(const SequenceHeader& header, const DecodedMesh& mesh) {
  PositionMatrix positions(static_cast<Eigen::Index>(mesh.grid.size()), 3);
  const Eigen::RowVector3d origin(header.origin_x, header.origin_y, header.origin_z);
  const auto row = [](const GridPosition& p) { return Eigen::RowVector3d(p[0], p[1], p[2]); };
  for (std::size_t c = 0; c < mesh.components.size(); ++c) {
    const PartScale scale = mesh.scales.empty() ? PartScale{} : mesh.scales[c];
    const Component& component = mesh.components[c];
    for (std::uint32_t v = component.first; v < component.first + component.count; ++v) {
      positions.row(v) =
          origin + static_cast<double>(header.cell) * (row(scale.origin) + scale.factor() * row(mesh.grid[v]));
    }
  }
  return positions;
}

std::vector<double> Product(std::span<const double> weights, std::span<const double> unevenness) {
  std::vector<double> product(weights.size());
  std::transform(weights.begin(), weights.end(), unevenness.begin(), product.begin(), std::multiplies<>());
  return product;
}

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
                  std::uint32_t handles_per_harmonic, const Limits& limits, Shape& shape) {
  if (counts.size() != mesh.components.size()) {
    return Status::Corrupt("I-frame: " + std::to_string(mesh.components.size()) + " components, but harmonics for " +
                           std::to_string(counts.size()));
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0 || counts[i] > mesh.components[i].count) {
      return Status::Corrupt("I-frame: more harmonics than vertices in a component");
    }
  }
  shape.work = 0;
  const std::vector<std::uint32_t> handle_counts = HandleCounts(header, mesh.components, counts, handles_per_harmonic);
  SAC_RETURN_IF_ERROR(CheckHarmonics(header, mesh.components, counts, handle_counts, limits, shape));

  shape.triangles = std::move(mesh.triangles);
  shape.vertex_of_copy = std::move(mesh.vertex_of_copy);
  shape.positions = ShapePositions(header, mesh);
  for (const PartScale& scale : mesh.scales) shape.factors.push_back(scale.factor());
  shape.components = std::move(mesh.components);
  shape.edges = BuildEdges(shape.triangles);
  shape.graph = BuildEdgeGraph(static_cast<std::uint32_t>(mesh.grid.size()), shape.edges);
  shape.masses = VertexMasses(shape.positions, shape.triangles);
  shape.centre = shape.masses.transpose() * shape.positions;
  std::vector<std::uint32_t> patch_sizes;
  for (const Component& patch : mesh.patches) patch_sizes.push_back(patch.count);
  shape.layouts = LayOutPlanes(header, counts, patch_sizes);

  std::vector<std::uint32_t> leaders;
  for (std::size_t i = 0; i < counts.size(); ++i) leaders.push_back(LeaderCount(handle_counts[i], counts[i]));
  Handles handles;
  SAC_RETURN_IF_ERROR(ChooseHandles(shape.graph, EdgeLengths(shape.edges, mesh.grid), shape.components, handle_counts,
                                    leaders, limits.work - shape.work, handles));
  shape.blend = Blend(std::move(handles), shape.components, shape.graph, shape.positions, shape.centre);
  shape.unevenness = Unevenness(shape.edges, mesh.grid, shape.components);
  const std::vector<double> weights = CotangentWeights(shape.positions, shape.triangles, shape.edges);
  shape.system = std::make_unique<BlendSystem>();
  shape.system->SetReference(shape.blend, shape.graph, Product(weights, shape.unevenness), shape.masses,
                             shape.positions);
  SAC_RETURN_IF_ERROR(FactorizeSystem(header, counts, limits, shape));
  if (header.detail_step > 0) {
    // Equal masses make the harmonics of each patch orthogonal without weights.
    const Eigen::VectorXd alike = Eigen::VectorXd::Ones(shape.positions.rows());
    const std::vector<double> uneven = Product(weights, Unevenness(shape.edges, mesh.grid, mesh.patches));
    SAC_RETURN_IF_ERROR(ComputeHarmonics({shape.edges, uneven, alike, mesh.patches, patch_sizes}, shape.patch_basis));
  }
  SAC_RETURN_IF_ERROR(ComputeBlendHarmonics(shape.blend, *shape.system, shape.graph, shape.components, shape.masses,
                                            counts, shape.basis));
  for (std::size_t c = 0; c < shape.components.size(); ++c) {
    shape.at_handles.push_back(shape.blend.IsAffine(c) ? shape.blend.AtHandles(c, shape.basis.components[c].vectors)
                                                       : Eigen::MatrixXd());
  }
  return Status::Ok();
}

}  // namespace sac
