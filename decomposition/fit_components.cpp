// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decomposition/rest_alignment.h"
#include "decomposition/run_parallel.h"
#include "sac/component_poser.h"
#include "sac/sparse_components.h"

namespace sac {
namespace {

constexpr std::size_t kBatch = 8;  // frames that are fitted side by side

// Calls `work` for the frames of `clip`, some at a time side by side, then `done` for each in order.
Status ForEachBatch(ClipReader& clip, std::size_t vertices, std::uint32_t threads,
                    const std::function<void(std::size_t slot, std::uint32_t frame, const Positions&)>& work,
                    const std::function<Status(std::size_t slot, std::uint32_t frame)>& done) {
  std::vector<Positions> batch;
  std::uint32_t first = 0;
  const auto flush = [&]() -> Status {
    RunParallel(batch.size(), threads,
                [&](std::size_t i) { work(i, first + static_cast<std::uint32_t>(i), batch[i]); });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      SAC_RETURN_IF_ERROR(done(i, first + static_cast<std::uint32_t>(i)));
    }
    first += static_cast<std::uint32_t>(batch.size());
    batch.clear();
    return Status::Ok();
  };
  const Status status = ForEachFrame(clip, vertices, [&](std::uint32_t, const PositionMatrix& positions) {
    batch.push_back(PositionsOf(positions));
    return batch.size() == kBatch ? flush() : Status::Ok();
  });
  return status.ok() ? flush() : status;
}

}  // namespace

Status FitComponents(ClipReader& clip, const SparseComponents& components, std::uint32_t threads,
                     const std::function<bool(std::uint32_t frames)>& progress, SparseComponents& fitted) {
  std::unique_ptr<ComponentPoser> poser;
  SAC_RETURN_IF_ERROR(ComponentPoser::Create(components, poser));
  fitted = components;
  fitted.rate = clip.rate();
  fitted.weights.clear();
  fitted.track.clear();
  std::vector<std::vector<float>> weights(kBatch);
  std::vector<RigidPose> poses(kBatch);
  std::vector<Status> statuses(kBatch);
  const Status status = ForEachBatch(
      clip, components.rest.size(), threads,
      [&](std::size_t slot, std::uint32_t, const Positions& frame) {
        statuses[slot] = poser->Fit(frame, weights[slot], poses[slot]);
      },
      [&](std::size_t slot, std::uint32_t frame) {
        SAC_RETURN_IF_ERROR(statuses[slot]);
        fitted.weights.insert(fitted.weights.end(), weights[slot].begin(), weights[slot].end());
        fitted.track.push_back(poses[slot]);
        return progress && !progress(frame + 1) ? Status::Cancelled() : Status::Ok();
      });
  SAC_RETURN_IF_ERROR(status);
  if (fitted.track.empty()) return Status::InvalidArgument(AtClip(clip, "has no frames"));
  return Status::Ok();
}

namespace {

// What one frame adds to the error.
struct FrameError {
  Status status;
  double square = 0, largest = 0;
  Eigen::RowVector3d low, high;
};

FrameError MeasureFrame(const ComponentPoser& poser, std::uint32_t f, const Positions& frame) {
  const SparseComponents& components = poser.components();
  FrameError error;
  if (f >= components.frames()) {
    error.status = Status::InvalidArgument("has more frames than the weights");
    return error;
  }
  Positions posed;
  const std::size_t count = components.components.size();
  error.status =
      poser.Compose(std::span<const float>(components.weights).subspan(f * count, count), components.track[f], posed);
  if (!error.status.ok()) return error;
  const PositionMatrix original = MatrixOf(frame), difference = MatrixOf(posed) - original;
  error.square = difference.squaredNorm();
  error.largest = difference.rowwise().squaredNorm().maxCoeff();
  error.low = original.colwise().minCoeff();
  error.high = original.colwise().maxCoeff();
  return error;
}

}  // namespace

Status MeasureComponents(ClipReader& clip, const SparseComponents& components, ReconstructionError& error) {
  error = {};
  std::unique_ptr<ComponentPoser> poser;
  SAC_RETURN_IF_ERROR(ComponentPoser::Create(components, poser));
  std::vector<FrameError> slots(kBatch);
  FrameError all;
  all.low = Eigen::RowVector3d::Constant(INFINITY);
  all.high = -all.low;
  std::size_t frames = 0;
  const Status status = ForEachBatch(
      clip, components.rest.size(), 0,
      [&](std::size_t slot, std::uint32_t f, const Positions& frame) { slots[slot] = MeasureFrame(*poser, f, frame); },
      [&](std::size_t slot, std::uint32_t) {
        const FrameError& one = slots[slot];
        if (!one.status.ok()) return Status(one.status.code(), AtClip(clip, one.status.message()));
        all.square += one.square;
        all.largest = std::max(all.largest, one.largest);
        all.low = all.low.cwiseMin(one.low);
        all.high = all.high.cwiseMax(one.high);
        ++frames;
        return Status::Ok();
      });
  SAC_RETURN_IF_ERROR(status);
  if (frames != components.frames()) {
    return Status::InvalidArgument(AtClip(clip, "has fewer frames than the weights"));
  }
  const auto values = static_cast<double>(3 * frames * components.rest.size());
  error.max = std::sqrt(all.largest);
  error.erms = all.square == 0 ? 0 : 1000 * std::sqrt(all.square / values) / (all.high - all.low).maxCoeff();
  return Status::Ok();
}

}  // namespace sac
