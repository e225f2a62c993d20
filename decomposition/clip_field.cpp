// SPDX-License-Identifier: Apache-2.0
#include "decomposition/clip_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "decomposition/frame_sketch.h"
#include "geometry/triangle_fields.h"

namespace sac {
namespace {

constexpr std::size_t kBatch = 16;  // frames that are put among the nodes at once, a cache line of each row

// Values of one frame: nodes x channels, row by row.
using FrameValues = std::vector<float>;

// Measures one frame after the other.
class FrameMeasure {
 public:
  FrameMeasure(const RestAlignment& alignment, const std::vector<Triangle>& triangles, ComponentDomain domain)
      : alignment_(alignment), triangles_(triangles), domain_(domain) {}

  void Measure(const PositionMatrix& frame, RigidPose& pose, FrameValues& values) const {
    const PositionMatrix aligned = alignment_.Align(frame, pose);
    if (domain_ == ComponentDomain::kDisplacement) {
      Store(aligned - alignment_.rest(), values);
    } else {
      // Each frame's rotations are those below half a turn: unwrapped in time, neighbours land on different branches.
      TriangleFields fields(triangles_);
      Store(fields.Measure(alignment_.rest(), aligned), values);
    }
  }

 private:
  template <class Matrix>
  static void Store(const Matrix& m, FrameValues& values) {
    values.resize(static_cast<std::size_t>(m.size()));
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      for (Eigen::Index a = 0; a < m.cols(); ++a) {
        values[static_cast<std::size_t>(i * m.cols() + a)] = static_cast<float>(m(i, a));
      }
    }
  }

  const RestAlignment& alignment_;
  const std::vector<Triangle>& triangles_;
  ComponentDomain domain_;
};

std::vector<float> NodeMasses(const RestAlignment& alignment, const std::vector<Triangle>& triangles,
                              ComponentDomain domain) {
  Eigen::VectorXd mass = alignment.mass();
  if (domain == ComponentDomain::kGradient) {
    TriangleFields fields(triangles);
    fields.Measure(alignment.rest(), alignment.rest());
    mass = fields.areas();
  }
  const double mean = mass.mean();
  std::vector<float> scaled(static_cast<std::size_t>(mass.size()));
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    scaled[i] = static_cast<float>(mass[static_cast<Eigen::Index>(i)] / (mean > 0 ? mean : 1));
  }
  return scaled;
}

// The rest shape; the mean shape is that of all frames, each on the first.
Status MakeAlignment(ClipReader& clip, const DecompositionSettings& settings, std::unique_ptr<RestAlignment>& result) {
  const Mesh& mesh = clip.mesh();
  PositionMatrix first;
  std::uint32_t frames = 0;
  const bool all = settings.rest_shape == RestShape::kMean;
  PositionMatrix sum = PositionMatrix::Zero(static_cast<Eigen::Index>(mesh.positions.size()), 3);
  SAC_RETURN_IF_ERROR(ForEachFrame(clip, mesh.positions.size(), [&](std::uint32_t f, const PositionMatrix& positions) {
    if (f == 0) {
      first = positions;
      result = std::make_unique<RestAlignment>(first, mesh.triangles);
    }
    RigidPose pose;
    if (all) sum += result->Align(positions, pose);
    ++frames;
    return Status::Ok();
  }));
  if (frames == 0) return Status::InvalidArgument(AtClip(clip, "has no frames"));
  if (all) result = std::make_unique<RestAlignment>(sum / frames, mesh.triangles);
  if (settings.rest_shape == RestShape::kGiven) {
    result = std::make_unique<RestAlignment>(MatrixOf(settings.rest), mesh.triangles);
  }
  return Status::Ok();
}

// The values of all frames, each a column.
class FieldColumns {
 public:
  explicit FieldColumns(NodeField& field) : field_(field) {}

  void Add(FrameValues& values) {
    batch_.push_back(std::move(values));
    if (batch_.size() == kBatch) Flush();
  }

  void Flush() {
    const std::size_t rows = field_.nodes * field_.channels;
    for (std::size_t i = 0; i < rows; ++i) {
      float* row = field_.values.data() + i * field_.columns + done_;
      for (std::size_t b = 0; b < batch_.size(); ++b) row[b] = batch_[b][i];
    }
    done_ += batch_.size();
    batch_.clear();
  }

 private:
  NodeField& field_;
  std::vector<FrameValues> batch_;
  std::size_t done_ = 0;
};

void Scale(ClipField& result) {
  NodeField& field = result.field;
  double sum = 0;
  const std::size_t width = field.channels * field.columns;
  for (std::size_t i = 0; i < field.nodes; ++i) {
    Eigen::Map<Eigen::VectorXf> x(field.row(i), static_cast<Eigen::Index>(width));
    if (field.mass[i] == 0) x.setZero();
    sum += static_cast<double>(field.mass[i]) * static_cast<double>(x.squaredNorm());
  }
  const auto values = static_cast<double>(field.nodes * field.channels * field.frames());
  const double scale = std::sqrt(sum / values);
  result.scale = scale > 0 && std::isfinite(scale) ? scale : 1;
  const auto factor = static_cast<float>(1 / result.scale);
  for (float& x : field.values) x *= factor;
}

Status CountFrames(ClipReader& clip, std::size_t& frames) {
  frames = 0;
  return ForEachFrame(clip, clip.mesh().positions.size(), [&](std::uint32_t, const PositionMatrix&) {
    ++frames;
    return Status::Ok();
  });
}

}  // namespace

Status ReadClipField(ClipReader& clip, const DecompositionSettings& settings, ClipField& result) {
  result = {};
  const Mesh& mesh = clip.mesh();
  SAC_RETURN_IF_ERROR(MakeAlignment(clip, settings, result.alignment));
  std::size_t frames = 0;
  SAC_RETURN_IF_ERROR(CountFrames(clip, frames));
  result.track.resize(frames);
  NodeField& field = result.field;
  const bool gradient = settings.domain == ComponentDomain::kGradient;
  field.nodes = gradient ? mesh.triangles.size() : mesh.positions.size();
  field.channels = gradient ? 9 : 3;
  field.mass = NodeMasses(*result.alignment, mesh.triangles, settings.domain);
  const FrameMeasure measure(*result.alignment, mesh.triangles, settings.domain);
  FrameValues values;
  const auto for_each = [&](const std::function<void(std::uint32_t, FrameValues&)>& take) {
    return ForEachFrame(clip, mesh.positions.size(), [&](std::uint32_t f, const PositionMatrix& positions) {
      if (f >= frames) return Status::InvalidArgument(AtClip(clip, "has changed while it was read"));
      measure.Measure(positions, result.track[f], values);
      take(f, values);
      return Status::Ok();
    });
  };
  const std::size_t rows = field.nodes * field.channels;
  const std::size_t most = std::max<std::size_t>(1, settings.field_memory / (rows * sizeof(float)));
  field.columns = std::min(frames, most);
  if (field.columns < frames) {
    FrameSketch sketch(frames, field.columns);
    SAC_RETURN_IF_ERROR(
        for_each([&](std::uint32_t f, FrameValues& v) { sketch.Add(f, v, field.mass, field.channels); }));
    field.basis = sketch.Basis();
  }
  field.values.assign(rows * field.columns, 0);
  double energy = 0;
  FieldColumns columns(field);
  SAC_RETURN_IF_ERROR(for_each([&](std::uint32_t f, FrameValues& v) {
    if (field.basis.size() == 0) {
      columns.Add(v);
    } else {
      energy += AddToBasis(f, v, field);
    }
  }));
  columns.Flush();
  if (field.basis.size() > 0) field.dropped_energy = DroppedEnergy(field, energy);
  Scale(result);
  return Status::Ok();
}

}  // namespace sac
