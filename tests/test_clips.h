// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "sac/clip.h"
#include "sac/decoder.h"
#include "sac/encoder.h"
#include "tests/test_meshes.h"

namespace sac {

struct Encoded {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint32_t> order;
  StreamBytes parts;
};

struct Decoded {
  Status status;  // of the first call that failed, Finish() included
  std::vector<DecodedFrame> frames;
  Mesh mesh;
  std::vector<std::uint32_t> order;
};

inline Encoded Encode(const Clip& clip, const EncoderSettings& settings) {
  Encoded out;
  std::unique_ptr<Encoder> encoder;
  Status status = Encoder::Create(clip.mesh, settings, encoder);
  EXPECT_TRUE(status.ok()) << status.message();
  if (!encoder) return out;
  const auto take = [&] {
    const auto bytes = encoder->TakeBytes();
    out.bytes.insert(out.bytes.end(), bytes.begin(), bytes.end());
  };
  for (const Positions& frame : clip.frames) {
    status = encoder->Send(frame);
    EXPECT_TRUE(status.ok()) << status.message();
    take();
  }
  status = encoder->Finish();
  EXPECT_TRUE(status.ok()) << status.message();
  take();
  out.order = encoder->order();
  out.parts = encoder->stream_bytes();
  return out;
}

// Decodes in chunks, each in a buffer of exactly its size.
inline Decoded Decode(std::span<const std::uint8_t> stream, std::size_t chunk, const DecoderSettings& settings = {}) {
  Decoded out;
  Decoder decoder(settings);
  const auto drain = [&] {
    DecodedFrame frame;
    while ((out.status = decoder.Receive(frame)).ok()) out.frames.push_back(frame);
    return out.status.code() == StatusCode::kNeedMoreData;
  };
  bool good = true;
  for (std::size_t at = 0; good && at < stream.size(); at += chunk) {
    const auto part = stream.subspan(at, std::min(chunk, stream.size() - at));
    const std::vector<std::uint8_t> buffer(part.begin(), part.end());
    for (std::span<const std::uint8_t> rest(buffer); good && !rest.empty();) {
      out.status = decoder.Send(rest);
      good = out.status.ok() && drain();
    }
  }
  if (good) out.status = decoder.Finish();
  if (decoder.mesh()) out.mesh = *decoder.mesh();
  out.order = decoder.order();
  return out;
}

inline Decoded Decode(const std::vector<std::uint8_t>& stream) {
  return Decode(stream, std::max<std::size_t>(1, stream.size()));
}

// The root mean square of a frame's vertices about their mean.
inline double RmsRadius(const Positions& positions) {
  const PositionMatrix p = ToMatrix(positions);
  return (p.rowwise() - p.colwise().mean()).norm() / std::sqrt(static_cast<double>(p.rows()));
}

// The root mean square distance of decoded vertices to the input's.
inline double RmsError(const Positions& input, const Positions& decoded, const std::vector<std::uint32_t>& order) {
  EXPECT_EQ(input.size(), decoded.size());
  EXPECT_EQ(input.size(), order.size());
  const PositionMatrix a = ToMatrix(input), b = ToMatrix(decoded);
  double sum = 0;
  for (std::size_t v = 0; v < order.size(); ++v) {
    sum += (a.row(order[v]) - b.row(static_cast<Eigen::Index>(v))).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(order.size()));
}

inline double MaxError(const Positions& input, const Positions& decoded, const std::vector<std::uint32_t>& order) {
  double most = 0;
  for (std::size_t v = 0; v < order.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      most = std::max(most, std::abs(static_cast<double>(input[order[v]][a]) - static_cast<double>(decoded[v][a])));
    }
  }
  return most;
}

// The largest distance of a decoded vertex to the input's.
inline double MaxDistance(const Positions& input, const Positions& decoded, const std::vector<std::uint32_t>& order) {
  const PositionMatrix a = ToMatrix(input), b = ToMatrix(decoded);
  double most = 0;
  for (std::size_t v = 0; v < order.size(); ++v) {
    most = std::max(most, (a.row(order[v]) - b.row(static_cast<Eigen::Index>(v))).norm());
  }
  return most;
}

// A tube that bends from straight to and fro.
inline Clip BendingClip(std::size_t frames, double angle = 2) {
  Clip clip{TubeMesh(10, 8), {}};
  for (std::size_t t = 0; t < frames; ++t) {
    clip.frames.push_back(BentTube(clip.mesh, angle * std::sin(0.1 * static_cast<double>(t))));
  }
  return clip;
}

// Parts that turn and drift, each its own way.
inline Clip TurningPartsClip(std::size_t frames) {
  Clip clip{PartsMesh(), {}};
  std::uint32_t components = 0;
  const auto labels =
      LabelComponents(static_cast<std::uint32_t>(clip.mesh.positions.size()), clip.mesh.triangles, components);
  for (std::size_t t = 0; t < frames; ++t) {
    Positions p = clip.mesh.positions;
    for (std::size_t v = 0; v < p.size(); ++v) {
      const double c = labels[v], angle = (0.05 + 0.03 * c) * static_cast<double>(t);
      const Eigen::Vector3d x(p[v][0], p[v][1], p[v][2]);
      p[v] = ToVec3f(AxisAngle({1, c, -1}, angle) * x + Eigen::Vector3d(0, 0.2 * c, 0) * angle);
    }
    clip.frames.push_back(p);
  }
  return clip;
}

}  // namespace sac
