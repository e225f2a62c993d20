// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/frame_source.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "codec/decode/run_jobs.h"

namespace sac {
namespace {

constexpr std::size_t kRun = 4;  // frames that a job reconstructs, one after another

std::int32_t Between(std::int32_t a, std::int32_t b, double t) {
  return static_cast<std::int32_t>(std::lround(a + t * (static_cast<double>(b) - a)));
}

void Between(const FramePlanes& a, const FramePlanes& b, double t, FramePlanes& out) {
  for (std::size_t p = 0; p < kPlanes; ++p) {
    out[p].resize(a[p].size());
    for (std::size_t i = 0; i < out[p].size(); ++i) out[p][i] = Between(a[p][i], b[p][i], t);
  }
}

Status CorruptFrame(std::uint32_t frame, const char* why) {
  return Status::Corrupt("frame " + std::to_string(frame) + ": " + why);
}

// Rounds the reconstructed positions `matrix` of `frame` to floats, and gives them to the copies of each vertex.
// Returns kCorrupt when a float cannot hold them.
Status Round(const Shape& shape, const PositionMatrix& matrix, std::uint32_t frame, Positions& positions) {
  if (!(matrix.array().abs() <= std::numeric_limits<float>::max()).all()) {
    return CorruptFrame(frame, "positions that are not finite");
  }
  ToPositions(matrix, positions);
  SpreadToCopies(shape.vertex_of_copy, positions);
  return Status::Ok();
}

}  // namespace

FrameSource::FrameSource(const Shape& shape, const SequenceHeader& header, unsigned threads, const JobRunner& run_jobs)
    : shape_(shape), header_(header), run_jobs_(run_jobs) {
  reconstructors_.resize(threads);
}

void FrameSource::Take(CodedFrames frames, bool starts_group) {
  before_.reset();
  if (!now_.frames.empty() && now_.end() == frames.first) before_ = std::move(now_.frames.back());
  now_ = {};
  DropReady();
  if (starts_group || !reconstructors_[0]) Restart();
  now_ = std::move(frames);
}

void FrameSource::Drop() {
  before_.reset();
  now_ = {};
  DropReady();
}

void FrameSource::Restart() {
  DropReady();
  for (std::unique_ptr<Reconstructor>& r : reconstructors_) {
    if (!r) r = std::make_unique<Reconstructor>(shape_, header_);
    r->StartGroup();
  }
}

const CodedFrames::Frame* FrameSource::Find(std::uint32_t frame) const {
  if (before_ && std::uint64_t{frame} + 1 == now_.first) return &*before_;
  if (frame < now_.first || frame >= now_.end()) return nullptr;
  return &now_.frames[frame - now_.first];
}

Status FrameSource::ReconstructWith(Reconstructor& with, std::uint32_t frame, Positions& positions) const {
  const CodedFrames::Frame& coded = now_.frames[frame - now_.first];
  if (!coded.whole) return CorruptFrame(frame, "its bytes are missing");
  if (!with.StartFrame(coded.intra)) return CorruptFrame(frame, "the reference shape is singular");
  return Round(shape_, with.Reconstruct(coded.coefficients), frame, positions);
}

void FrameSource::ReconstructRun(std::size_t job) {
  for (std::size_t i = job * kRun; i < std::min(ready_count_, (job + 1) * kRun); ++i) {
    Ready& r = ready_[i];
    try {
      r.status = ReconstructWith(*reconstructors_[job], r.frame, r.positions);
    } catch (const std::exception&) {
      r.status = Status::Limit("out of memory");
    }
    r.done = true;
  }
}

Status FrameSource::ReconstructAhead(std::uint32_t frame, std::uint32_t step) {
  DropReady();
  ready_.resize(kRun * reconstructors_.size());
  for (std::uint64_t f = frame; f < now_.end() && ready_count_ < ready_.size(); f += step) {
    Ready& ready = ready_[ready_count_++];
    ready.frame = static_cast<std::uint32_t>(f);
    ready.done = false;
  }
  const std::size_t jobs = (ready_count_ + kRun - 1) / kRun;
  const auto job = [this](std::size_t j) { ReconstructRun(j); };
  if (!run_jobs_ || jobs == 1) {
    RunOnThreads(jobs, job);
    return Status::Ok();
  }
  try {
    run_jobs_(jobs, job);
  } catch (const std::bad_alloc&) {
    DropReady();
    throw;
  } catch (...) {  // the caller's code may throw anything
    DropReady();
    return Status::InvalidArgument("run_jobs threw an exception");
  }
  return Status::Ok();
}

void FrameSource::Blend(const FramePlanes& planes, const RigidTransform& transform, FrameOutput& output) {
  output.blend = &reconstructors_[0]->ReconstructBlend(planes, transform);
  const auto is_zero = [](const PlaneValues& plane) {
    return std::all_of(plane.begin(), plane.end(), [](std::int32_t c) { return c == 0; });
  };
  output.exact = is_zero(planes[kDetail]) && is_zero(planes[kCorrection]);
}

Status FrameSource::Reconstruct(std::uint32_t frame, std::uint32_t step, FrameOutput& output) {
  if (output.positions == nullptr) {
    const CodedFrames::Frame& coded = now_.frames[frame - now_.first];
    if (!coded.whole) return CorruptFrame(frame, "its bytes are missing");
    Blend(coded.coefficients.planes, reconstructors_[0]->TransformOf(coded.coefficients.rigid), output);
    return Status::Ok();
  }
  Positions& positions = *output.positions;
  if (reconstructors_.size() == 1 || now_.frames.size() == 1) {
    return ReconstructWith(*reconstructors_[0], frame, positions);
  }
  while (first_ready_ < ready_count_ && ready_[first_ready_].frame != frame) ++first_ready_;
  if (first_ready_ == ready_count_) SAC_RETURN_IF_ERROR(ReconstructAhead(frame, step));
  Ready& ready = ready_[first_ready_++];
  if (!ready.done) return Status::InvalidArgument("run_jobs has left a job out");
  positions.swap(ready.positions);
  return ready.status;
}

Status FrameSource::Interpolate(double time, FrameOutput& output) {
  const double floor = std::floor(time);
  const auto frame = static_cast<std::uint32_t>(floor);
  const CodedFrames::Frame* const a = Find(frame);
  const CodedFrames::Frame* const b = time == floor ? a : Find(frame + 1);
  if (!a->whole || !b->whole) return Status::Corrupt("frame " + std::to_string(frame) + " or the next is lost");
  const FrameCoefficients &from = a->coefficients, &to = b->coefficients;
  const double t = time - floor;
  Between(from.planes, to.planes, t, between_);
  Reconstructor& with = *reconstructors_[0];
  const RigidTransform transform = with.TransformBetween(from.rigid, to.rigid, t);
  if (output.positions != nullptr)
    return Round(shape_, with.Reconstruct(between_, transform), frame, *output.positions);
  Blend(between_, transform, output);
  return Status::Ok();
}

}  // namespace sac
