// SPDX-License-Identifier: Apache-2.0
// A small mesh and its frames, and the encoder's settings, out of the input: what is encoded must decode, and with a
// bound on the error be within it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "sac/decoder.h"
#include "sac/encoder.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace sac;

// The vertex whose place a vertex takes where some coincide.
std::uint32_t Lowest(std::uint32_t v) { return v % 3 == 0 ? v : v % 9 / 3; }

void Coincide(Positions& positions) {
  for (std::uint32_t v = 3; v < positions.size(); ++v) positions[v] = positions[Lowest(v)];
}

Mesh MakeMesh(Choices& in, bool& joins) {
  Mesh mesh;
  mesh.positions.resize(1 + in.Below(40));
  const float unit = std::ldexp(1.0f, in.Signed() / 4), away = std::ldexp(1.0f, in.Signed() / 4);
  for (Vec3f& p : mesh.positions) {
    for (float& x : p) x = static_cast<float>(in.Signed()) * unit + away;
  }
  mesh.triangles.resize(in.Below(80));
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = in.U8() % static_cast<std::uint32_t>(mesh.positions.size());
  }
  const std::uint8_t attributes = in.U8();
  if ((attributes & 1) != 0) {
    mesh.uvs.resize(1 + in.Below(16));
    for (auto& uv : mesh.uvs) uv = {static_cast<float>(in.Signed()) / 16, static_cast<float>(in.Signed()) / 16};
    mesh.uv_triangles.resize(mesh.triangles.size());
    for (Triangle& t : mesh.uv_triangles) {
      for (std::uint32_t& i : t) i = in.U8() % static_cast<std::uint32_t>(mesh.uvs.size());
    }
  }
  if ((attributes & 2) != 0) {
    mesh.normals.resize(mesh.positions.size());
    for (Vec3f& n : mesh.normals) n = {1.0f * in.Signed(), 1.0f * in.Signed(), 1.0f * in.Signed()};
  }
  if ((attributes & 8) != 0 && !mesh.normals.empty()) {
    mesh.normal_triangles.resize(mesh.triangles.size());
    for (Triangle& t : mesh.normal_triangles) {
      for (std::uint32_t& i : t) i = in.U8() % static_cast<std::uint32_t>(mesh.normals.size());
    }
  }
  if ((attributes & 4) != 0) {
    mesh.colors.resize(mesh.positions.size());
    for (auto& c : mesh.colors) c = {in.U8(), in.U8(), in.U8(), in.U8()};
  }
  joins = (attributes & 16) != 0;
  if (joins) Coincide(mesh.positions);
  return mesh;
}

EncoderSettings MakeSettings(Choices& in) {
  EncoderSettings s;
  s.quality = in.Below(101);
  s.harmonics = 1 + in.Below(60);
  s.handles_per_harmonic = in.Below(4);
  s.group = 1 + in.Below(12);
  s.pyramid = 1 + in.Below(12);
  s.level_growth = 1 + in.Below(65) / 64.0;
  s.low_delay = in.Flag();
  s.reference_shape = in.Flag() ? ReferenceShape::kPrevious : ReferenceShape::kKey;
  s.keep_order = in.Flag();
  if (in.Flag()) s.max_error = std::ldexp(1.0, in.Signed() / 4);
  if (in.Flag()) s.detail_step = std::ldexp(in.Below(2), in.Signed() / 8);
  if (in.Flag()) s.motion_step = std::ldexp(1.0, in.Signed() / 8);
  if (in.Flag()) s.displacement_step = std::ldexp(1.0, in.Signed() / 8);
  if (in.Flag()) s.position_bits = 1 + in.Below(24);
  return s;
}

// The frame before, some of its vertices moved.
Positions MakeFrame(Positions positions, Choices& in) {
  const float unit = std::ldexp(1.0f, in.Signed() / 4);
  for (std::uint32_t i = in.Below(static_cast<std::uint32_t>(positions.size()) + 1); i > 0; --i) {
    positions[in.U8() % positions.size()][in.Below(3)] += static_cast<float>(in.Signed()) * unit;
  }
  return positions;
}

double Distance(const Vec3f& a, const Vec3f& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum = std::hypot(sum, static_cast<double>(a[i]) - static_cast<double>(b[i]));
  return sum;
}

bool IsPermutation(std::vector<std::uint32_t> order, std::size_t size) {
  std::vector<std::uint32_t> all(size);
  std::iota(all.begin(), all.end(), 0u);
  std::sort(order.begin(), order.end());
  return order == all;
}

// Triangles with the author's vertices, the smallest first.
std::vector<Triangle> Turned(std::vector<Triangle> triangles, const std::vector<std::uint32_t>& order) {
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = order.empty() ? v : order[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices in(std::span(data, size));
  EncoderSettings settings = MakeSettings(in);
  bool joins = false;
  const Mesh mesh = MakeMesh(in, joins);
  settings.join = joins;
  std::unique_ptr<Encoder> encoder;
  if (!Encoder::Create(mesh, settings, encoder).ok()) return 0;
  std::vector<Positions> frames = {mesh.positions};
  while (in.left() > 0 && frames.size() < 20) {
    frames.push_back(MakeFrame(frames.back(), in));
    if (joins) Coincide(frames.back());
  }
  for (const Positions& frame : frames) {
    if (!encoder->Send(frame).ok()) return 0;  // such as one too far away for the steps
  }
  if (!encoder->Finish().ok()) return 0;
  const std::vector<std::uint8_t> stream = encoder->TakeBytes();
  FUZZ_REQUIRE(IsPermutation(encoder->order(), mesh.positions.size()));

  Decoder decoder;
  DecodedFrame decoded;
  std::size_t count = 0;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    FUZZ_REQUIRE(decoder.Send(rest).ok());
    Status status;
    while ((status = decoder.Receive(decoded)).ok()) {
      FUZZ_REQUIRE(count < frames.size() && decoded.positions.size() == mesh.positions.size());
      for (std::size_t v = 0; settings.max_error && v < decoded.positions.size(); ++v) {
        FUZZ_REQUIRE(Distance(decoded.positions[v], frames[count][encoder->order()[v]]) <= *settings.max_error);
      }
      ++count;
    }
    FUZZ_REQUIRE(status.code() == StatusCode::kNeedMoreData);
  }
  FUZZ_REQUIRE(decoder.Finish().ok());
  FUZZ_REQUIRE(count == frames.size());
  FUZZ_REQUIRE(Turned(decoder.mesh()->triangles, encoder->order()) == Turned(mesh.triangles, {}));
  const auto& colors = decoder.mesh()->colors;
  for (std::size_t v = 0; v < colors.size(); ++v) FUZZ_REQUIRE(colors[v] == mesh.colors[encoder->order()[v]]);
  if (settings.keep_order) FUZZ_REQUIRE(decoder.order() == encoder->order());
  return 0;
}
