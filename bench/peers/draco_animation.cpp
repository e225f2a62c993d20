// SPDX-License-Identifier: Apache-2.0
// Draco's keyframe animation: the coordinates of vertices as animation data over the frames. A track has at most 255
// components, so 85 vertices share one.
#include <draco/animation/keyframe_animation.h>
#include <draco/animation/keyframe_animation_decoder.h>
#include <draco/animation/keyframe_animation_encoder.h>
#include <draco/core/draco_version.h>

#include <algorithm>

#include "bench/peers/array_peer.h"

namespace sac::bench {
namespace {

constexpr std::size_t kVerticesPerTrack = 85;

Status Encode(const std::vector<Positions>& frames, double bits, ByteWriter& out) {
  const std::size_t n = frames.front().size();
  draco::KeyframeAnimation animation;
  std::vector<float> times;
  for (std::size_t f = 0; f < frames.size(); ++f) times.push_back(static_cast<float>(f));
  if (!animation.SetTimestamps(times)) return Status::Unsupported("Draco: timestamps");
  draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
  options.SetSpeed(0, 0);
  for (std::size_t first = 0; first < n; first += kVerticesPerTrack) {
    const std::size_t end = std::min(first + kVerticesPerTrack, n);
    std::vector<float> data;
    for (const Positions& frame : frames) {
      for (std::size_t v = first; v < end; ++v) {
        const Vec3f& p = frame[v];
        data.insert(data.end(), p.begin(), p.end());
      }
    }
    const int id = animation.AddKeyframes(draco::DT_FLOAT32, static_cast<std::uint32_t>(3 * (end - first)), data);
    if (id < 0) return Status::Unsupported("Draco: keyframes");
    options.SetAttributeInt(id, "quantization_bits", static_cast<int>(bits));
  }
  draco::EncoderBuffer buffer;
  draco::KeyframeAnimationEncoder encoder;
  if (const draco::Status status = encoder.EncodeKeyframeAnimation(animation, options, &buffer); !status.ok()) {
    return Status::Unsupported(std::string("Draco: ") + status.error_msg());
  }
  out.Bytes({reinterpret_cast<const std::uint8_t*>(buffer.data()), buffer.size()});
  return Status::Ok();
}

Status Decode(ByteReader& in, std::vector<Positions>& frames) {
  const auto rest = in.Bytes(in.remaining());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(rest.data()), rest.size());
  draco::KeyframeAnimation animation;
  draco::KeyframeAnimationDecoder decoder;
  if (const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, &animation); !status.ok()) {
    return Status::Corrupt(std::string("Draco: ") + status.error_msg());
  }
  const std::size_t n = frames.front().size();
  std::size_t first = 0;
  for (int id = 1; id <= animation.num_animations(); ++id) {
    const draco::PointAttribute& track = *animation.keyframes(id);
    const std::size_t count = track.num_components() / 3u;
    std::vector<float> values(3 * count);
    if (first + count > n) return Status::Corrupt("too many tracks");
    for (std::uint32_t f = 0; f < frames.size(); ++f) {
      track.GetMappedValue(draco::PointIndex(f), values.data());
      for (std::size_t v = 0; v < count; ++v) {
        frames[f][first + v] = {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
      }
    }
    first += count;
  }
  return first == n ? Status::Ok() : Status::Corrupt("too few tracks");
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunArrayPeer(argc, argv,
                                  {"Draco, keyframe animation",
                                   draco::kDracoVersion,
                                   "bits",
                                   {"7", "8", "9", "10", "11", "12", "13", "14"},
                                   sac::bench::Encode,
                                   sac::bench::Decode});
}
