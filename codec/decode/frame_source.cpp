#include "codec/decode/frame_source.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace sac {
namespace {

constexpr std::uint32_t kRun = 4;  // frames that a thread reconstructs in one go

std::int32_t Between(std::int32_t a, std::int32_t b, double t) {
  return static_cast<std::int32_t>(std::lround(a + t * (static_cast<double>(b) - a)));
}

PlaneValues Between(const PlaneValues& a, const PlaneValues& b, double t) {
  PlaneValues out(a.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = Between(a[i], b[i], t);
  return out;
}

}  // namespace

FrameSource::FrameSource(const Shape& shape, const SequenceHeader& header, unsigned threads)
    : shape_(shape), header_(header) {
  reconstructors_.resize(threads);
}

Status FrameSource::Take(CodedFrames frames, bool starts_group) {
  before_.reset();
  if (!now_.frames.empty() && now_.end() == frames.first) before_ = std::move(now_.frames.back());
  now_ = {};
  ready_.clear();
  if (starts_group || !reconstructors_[0]) SAC_RETURN_IF_ERROR(Restart());
  now_ = std::move(frames);
  return Status::Ok();
}

void FrameSource::Drop() {
  before_.reset();
  now_ = {};
  ready_.clear();
}

Status FrameSource::Restart() {
  ready_.clear();
  for (std::unique_ptr<Reconstructor>& r : reconstructors_) {
    if (!r) r = std::make_unique<Reconstructor>(shape_, header_);
    if (!r->StartGroup()) return Status::Corrupt("the first frame's shape is singular");
  }
  return Status::Ok();
}

const CodedFrames::Frame* FrameSource::Find(std::uint32_t frame) const {
  if (before_ && std::uint64_t{frame} + 1 == now_.first) return &*before_;
  if (frame < now_.first || frame >= now_.end()) return nullptr;
  return &now_.frames[frame - now_.first];
}

Status FrameSource::ReconstructWith(Reconstructor& with, std::uint32_t frame, Positions& positions) const {
  const CodedFrames::Frame& coded = now_.frames[frame - now_.first];
  const auto corrupt = [frame](const char* why) {
    return Status::Corrupt("frame " + std::to_string(frame) + ": " + why);
  };
  if (!coded.whole) return corrupt("its bytes are missing");
  if (!with.StartFrame(coded.intra)) return corrupt("the reference shape is singular");
  const PositionMatrix matrix = with.Reconstruct(coded.coefficients);
  if (!(matrix.array().abs() <= std::numeric_limits<float>::max()).all())
    return corrupt("positions that are not finite");
  positions = ToPositions(matrix);
  return Status::Ok();
}

void FrameSource::ReconstructAhead(std::uint32_t frame, std::uint32_t step) {
  ready_.clear();
  const std::uint64_t most = std::uint64_t{kRun} * reconstructors_.size();
  ready_.reserve(most);
  for (std::uint64_t f = frame; f < now_.end() && ready_.size() < most; f += step) {
    ready_.push_back({static_cast<std::uint32_t>(f), {}, {}});
  }
  const auto run = [this](std::size_t thread) {
    for (std::size_t i = thread * kRun; i < std::min(ready_.size(), (thread + 1) * kRun); ++i) {
      Ready& r = ready_[i];
      try {
        r.status = ReconstructWith(*reconstructors_[thread], r.frame, r.positions);
      } catch (const std::exception&) {
        r.status = Status::Limit("out of memory");
      }
    }
  };
  std::vector<std::jthread> others;
  others.reserve(reconstructors_.size());
  for (std::size_t t = 1; t * kRun < ready_.size(); ++t) {
    try {
      others.emplace_back(run, t);
    } catch (const std::system_error&) {  // there are too many already
      run(t);
    }
  }
  run(0);
}

Status FrameSource::Reconstruct(std::uint32_t frame, std::uint32_t step, Positions& positions) {
  if (reconstructors_.size() == 1 || now_.frames.size() == 1) {
    return ReconstructWith(*reconstructors_[0], frame, positions);
  }
  const auto is_it = [frame](const Ready& r) { return r.frame == frame; };
  auto at = std::find_if(ready_.begin(), ready_.end(), is_it);
  if (at == ready_.end()) {
    ReconstructAhead(frame, step);
    at = ready_.begin();
  }
  const Ready ready = std::move(*at);
  ready_.erase(ready_.begin(), at + 1);
  positions = std::move(ready.positions);
  return ready.status;
}

Status FrameSource::Interpolate(double time, Positions& positions) {
  const double floor = std::floor(time);
  const auto frame = static_cast<std::uint32_t>(floor);
  const CodedFrames::Frame* const a = Find(frame);
  const CodedFrames::Frame* b = time == floor ? a : Find(frame + 1);
  if (!a->whole || !b->whole) {
    return Status::Corrupt("frame " + std::to_string(frame) + " or the next is lost");
  }
  const FrameCoefficients &from = a->coefficients, &to = b->coefficients;
  const double t = time - floor;
  Reconstructor& reconstructor = *reconstructors_[0];
  reconstructor.ReconstructMotion(Between(from.planes[kMotion], to.planes[kMotion], t));
  for (const Plane p : {kDisplacement, kDetail, kCorrection}) {
    reconstructor.Add(p, Between(from.planes[p], to.planes[p], t));
  }
  const PositionMatrix matrix = reconstructor.ApplyRigidBetween(from.rigid, to.rigid, t);
  if (!(matrix.array().abs() <= std::numeric_limits<float>::max()).all()) {
    return Status::Corrupt("frame " + std::to_string(frame) + ": positions that are not finite");
  }
  positions = ToPositions(matrix);
  return Status::Ok();
}

}  // namespace sac
