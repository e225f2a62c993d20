// SPDX-License-Identifier: Apache-2.0
#include "rate_control/stream_measurement.h"

#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "codec/encode/contain.h"

namespace sac {

void StreamMeasurement::Wait() {
#if SAC_HAS_THREADS
  if (other_.joinable()) other_.join();
#endif
}

void StreamMeasurement::BeginSegment(const Mesh& mesh, const std::vector<std::uint32_t>& order) {
  Wait();
  segments_.push_back({mesh.triangles, order, !mesh.uv_triangles.empty(), !mesh.normals.empty()});
}

void StreamMeasurement::BeginMeasuring(std::size_t index) {
  measured_ = index;
  Segment& segment = segments_[index];
  const std::size_t vertices = segment.order.size();
  if (meter_) {
    meter_->BeginMesh(std::move(segment.triangles), vertices);
  } else {
    meter_.emplace(std::move(segment.triangles), vertices);
  }
  const Mesh& decoded = *decoder_.mesh();
  lost_uvs_ = lost_uvs_ || (segment.has_uvs && decoded.uv_triangles.empty());
  lost_normals_ = lost_normals_ || (segment.has_normals && decoded.normals.empty());
  if (residual_ != nullptr) residual_->Begin(Ordered(decoded.positions));
}

void StreamMeasurement::Compare(const Positions& original, const Positions& decoded) {
  meter_->Add(original, decoded);
  if (residual_ != nullptr) residual_->Add(original, decoded);
}

Status StreamMeasurement::Decode() {
  for (std::span<const std::uint8_t> bytes = bytes_; !bytes.empty();) {
    SAC_RETURN_IF_ERROR(decoder_.Send(bytes));
    Status status;
    while ((status = decoder_.Receive(frame_)).ok()) {
      if (expected_.empty()) return Status::Corrupt("a frame too many");
      const Expected& expected = expected_.front();
      if (expected.segment != frame_.segment) return Status::Corrupt("a frame of another segment");
      if (!meter_ || expected.segment != measured_) BeginMeasuring(expected.segment);
      Compare(expected.positions, Ordered(frame_.positions));
      expected_.pop_front();
    }
    if (status.code() != StatusCode::kNeedMoreData) return status;
  }
  return Status::Ok();
}

Status StreamMeasurement::Take(std::vector<std::uint8_t> bytes) {
  if (bytes.empty()) return Status::Ok();
  Wait();
  SAC_RETURN_IF_ERROR(failure_);
  expected_.insert(expected_.end(), std::make_move_iterator(sent_.begin()), std::make_move_iterator(sent_.end()));
  sent_.clear();
  bytes_ = std::move(bytes);
  const auto decode = [this] { failure_ = Contain([this] { return Decode(); }); };
#if SAC_HAS_THREADS
  if (beside_) {
    try {
      other_ = std::thread(decode);
      return Status::Ok();
    } catch (const std::system_error&) {  // no thread can be started
    }
  }
#endif
  decode();
  return failure_;
}

Status StreamMeasurement::Finish(EncodedClip& result) {
  Wait();
  SAC_RETURN_IF_ERROR(failure_);
  SAC_RETURN_IF_ERROR(decoder_.Finish());
  if (!expected_.empty() || !sent_.empty()) return Status::Corrupt("a frame is missing");
  if (meter_) result.distortion = meter_->Result();
  result.lost_texture_coordinates = lost_uvs_;
  result.lost_normals = lost_normals_;
  return Status::Ok();
}

}  // namespace sac
