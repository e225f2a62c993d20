// SPDX-License-Identifier: Apache-2.0
// The times of an Alembic scene's frames.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "files/alembic/alembic_scene.h"
#include "files/frame_rate.h"

namespace sac {
namespace {

// Times are at a frame if they are this near to it, in frames: programs round rates to three decimals.
constexpr double kNear = 2e-3;

std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

bool IsWhole(double value) { return std::abs(value - std::round(value)) <= kNear; }

// Whether every sample is at a frame.
bool IsOnGrid(const AlembicSamples& samples, double start, double period) {
  const AlembicTimeSampling& times = samples.times();
  if (!times.acyclic && !IsWhole(times.period / period)) return false;
  // Those of a period stand for all; those of their own are as many as the file lists.
  return std::all_of(times.times.begin(), times.times.end(),
                     [=](double time) { return IsWhole((time - start) / period); });
}

}  // namespace

std::vector<const AlembicSamples*> AlembicScene::MovingSamples() const {
  std::vector<const AlembicSamples*> moving;
  std::vector<bool> used(nodes_.size());
  const auto add = [&moving](const AlembicSamples& samples) {
    if (samples.size() > 1) moving.push_back(&samples);
  };
  for (const SceneMesh& mesh : meshes_) {
    add(mesh.mesh->points());
    add(mesh.mesh->face_indices());
    for (std::optional<std::size_t> node = mesh.node; node && !used[*node]; node = nodes_[*node].parent) {
      used[*node] = true;
      add(nodes_[*node].transform->numbers());
    }
  }
  return moving;
}

Status AlembicScene::ChooseFrames(const FrameRate& wanted) {
  rate_ = wanted;
  const std::vector<const AlembicSamples*> moving = MovingSamples();
  double rate = 0, first = std::numeric_limits<double>::infinity(), last = -first;
  for (const AlembicSamples* samples : moving) {
    const AlembicTimeSampling& times = samples->times();
    // Of the samples of a period, as for motion blur, that is the frame which is at a whole period.
    double begin = times.Time(0);
    for (std::size_t i = 1; !times.acyclic && i < times.times.size(); ++i) {
      if (IsWhole(times.times[i] / times.period)) begin = times.times[i];
    }
    first = std::min(first, begin);
    last = std::max(last, times.Time(samples->size() - 1));
    if (const double own = times.Rate(samples->size()); own > rate) {
      rate = own;
      period_ = times.acyclic ? 1 / own : times.period;
    }
  }
  if (moving.empty() || rate == 0) {
    start_ = meshes_.front().mesh->points().times().Time(0);
    return Status::Ok();
  }
  start_ = first;
  const FrameRate nearest = NearestFrameRate(rate);
  const bool resampled = wanted.numerator != 0 && std::abs(wanted.per_second() - nearest.per_second()) > 1e-9;
  // Where the rate is the file's own, so are the times: its rounding may differ from that of the rate.
  if (resampled) period_ = 1 / wanted.per_second();
  if (wanted.numerator == 0) rate_ = nearest;
  const double frames = std::floor((last - start_) / period_ + kNear) + 1;
  if (!(frames <= limits_.frames)) {
    return Status::Limit("its samples from " + Text(start_) + " s to " + Text(last) + " s are " + Text(frames) +
                         " frames, more than " + std::to_string(limits_.frames));
  }
  frame_count_ = static_cast<std::uint32_t>(std::max(frames, 1.0));
  TellTimes(moving, resampled);
  return Status::Ok();
}

void AlembicScene::TellTimes(const std::vector<const AlembicSamples*>& moving, bool resampled) {
  if (std::abs(start_) > 1e-6 * period_) {
    warnings_.push_back("its first time " + Text(start_) + " s is not kept; frames begin at 0 s");
  }
  const bool on_grid = std::all_of(moving.begin(), moving.end(), [this](const AlembicSamples* samples) {
    return IsOnGrid(*samples, start_, period_);
  });
  if (on_grid || resampled) return;
  warnings_.push_back("not all of its samples are at the times of its frames, " + Text(1 / period_) +
                      " a second; frames lie between them. --fps takes another rate");
}

}  // namespace sac
