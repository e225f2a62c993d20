// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/handle_output.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/bounding_box.h"

namespace sac {
namespace {

// A box that holds what `matrix`, 3 rows x 4 columns, makes of `box`.
Box Transformed(const Box& box, const float* matrix) {
  Box out;
  for (std::size_t r = 0; r < 3; ++r) {
    const float* const row = matrix + 4 * r;
    double middle = static_cast<double>(row[3]), reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto factor = static_cast<double>(row[k]);
      middle += factor * (box.low[k] + box.high[k]) / 2;
      reach += std::abs(factor) * (box.high[k] - box.low[k]) / 2;
    }
    out.low[r] = middle - reach;
    out.high[r] = middle + reach;
  }
  return out;
}

}  // namespace

HandleOutput::HandleOutput(const Shape& shape) : shape_(shape), boxes_(shape.blend.handles().vertices.size()) {
  const Blend& blend = shape.blend;
  const PositionMatrix& positions = shape.positions;
  const Handles& handles = blend.handles();
  for (std::size_t c = 0; c < handles.components.size(); ++c) {
    const Component& run = handles.components[c];
    for (std::uint32_t h = run.first; h < run.first + run.count; ++h) {
      functions_.push_back(blend.Translation(c, h));
      affine_.push_back(blend.IsAffine(c));
    }
  }
  std::vector<bool> moves(boxes_.size());
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const Box point{{positions(v, 0), positions(v, 1), positions(v, 2)},
                    {positions(v, 0), positions(v, 1), positions(v, 2)}};
    for (const std::uint32_t h : handles.FollowedBy(static_cast<std::uint32_t>(v))) {
      boxes_[h] = moves[h] ? Union(boxes_[h], point) : point;
      moves[h] = true;
    }
  }
}

BlendWeights HandleOutput::Weights() const {
  const Handles& handles = shape_.blend.handles();
  BlendWeights out;
  out.handle_count = static_cast<std::uint32_t>(boxes_.size());
  out.first = handles.offsets;
  out.handles = handles.followed;
  out.weights.assign(handles.weights.begin(), handles.weights.end());
  if (shape_.vertex_of_copy.empty()) return out;
  BlendWeights of_copies;
  of_copies.handle_count = out.handle_count;
  of_copies.first.push_back(0);
  for (const std::uint32_t v : shape_.vertex_of_copy) {
    for (std::uint32_t i = out.first[v]; i < out.first[v + 1]; ++i) {
      of_copies.handles.push_back(out.handles[i]);
      of_copies.weights.push_back(out.weights[i]);
    }
    of_copies.first.push_back(static_cast<std::uint32_t>(of_copies.handles.size()));
  }
  return of_copies;
}

Box HandleOutput::Fill(const RowMatrix& about_origin, std::span<float> matrices) const {
  Box all;
  for (std::size_t h = 0; h < boxes_.size(); ++h) {
    float* const matrix = matrices.data() + 12 * h;
    const auto last = static_cast<Eigen::Index>(functions_[h]);
    for (Eigen::Index r = 0; r < 3; ++r) {
      double shift = about_origin(last, r);
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double factor = affine_[h] ? about_origin(last - 3 + k, r) : 0;
        matrix[4 * r + k] = static_cast<float>(factor);
        shift -= factor * shape_.centre[k];
      }
      matrix[4 * r + 3] = static_cast<float>(shift);
    }
    const Box box = Transformed(boxes_[h], matrix);
    all = h == 0 ? box : Union(all, box);
  }
  return all;
}

}  // namespace sac
