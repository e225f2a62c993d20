// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "files/path.h"

namespace sac {
namespace {

constexpr std::uint32_t kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;
// Differences of two positions need one bit more than positions, and a SHORT has 16.
constexpr std::int32_t kLargest = 16383;

using Integers = std::vector<std::array<std::int32_t, 3>>;

void AppendFloat(float value, std::vector<std::uint8_t>& bytes) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
}

GltfValues UvValues(const Mesh& mesh, const SplitVertices& split, bool quantized) {
  const bool fits = std::all_of(mesh.uvs.begin(), mesh.uvs.end(),
                                [](const auto& uv) { return uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1; });
  const bool integers = quantized && fits;
  GltfValues values{{}, integers ? 4U : 8U, split.size(), integers ? kUnsignedShort : kFloat, "VEC2", integers};
  for (const std::uint32_t index : split.uvs) {
    // glTF counts v from the top of an image, a Mesh from below.
    for (const float x : {mesh.uvs[index][0], 1 - mesh.uvs[index][1]}) {
      if (!integers) {
        AppendFloat(x, values.bytes);
        continue;
      }
      const auto level = static_cast<std::uint32_t>(std::lround(x * 65535.0F));
      values.bytes.push_back(static_cast<std::uint8_t>(level));
      values.bytes.push_back(static_cast<std::uint8_t>(level >> 8));
    }
  }
  return values;
}

GltfValues ColorValues(const Mesh& mesh, const SplitVertices& split) {
  GltfValues values{{}, 4, split.size(), kUnsignedByte, "VEC4", true};
  for (const std::uint32_t v : split.vertices) {
    values.bytes.insert(values.bytes.end(), mesh.colors[v].begin(), mesh.colors[v].end());
  }
  return values;
}

// A normal in steps of 1/127.
std::array<std::int32_t, 3> QuantizedNormal(const Vec3f& n) {
  std::array<std::int32_t, 3> q{};
  for (int k = 0; k < 3; ++k) q[k] = static_cast<std::int32_t>(std::lround(std::clamp(n[k], -1.0F, 1.0F) * 127));
  return q;
}

// Normals of length 1 of the split vertices; one of length 0, which glTF does not allow, points up.
std::vector<Vec3f> Normals(const SplitVertices& split, const std::vector<Vec3f>& normals) {
  std::vector<Vec3f> values;
  for (const std::uint32_t index : split.normals) {
    const Vec3f& n = normals[index];
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    values.push_back(length > 0 ? Vec3f{n[0] / length, n[1] / length, n[2] / length} : Vec3f{0, 1, 0});
  }
  return values;
}

}  // namespace

// Position = middle + step * integer, model units; with no step, positions are floats.
struct GltfWriter::Grid {
  std::array<double, 3> middle = {};
  double step = 0;

  std::array<std::int32_t, 3> Point(const Vec3f& p) const {
    std::array<std::int32_t, 3> q{};
    for (int k = 0; k < 3; ++k) {
      const double x = std::round((static_cast<double>(p[k]) - middle[k]) / step);
      q[k] = static_cast<std::int32_t>(std::clamp<double>(x, -kLargest, kLargest));
    }
    return q;
  }
};

Status GltfWriter::Open(const std::string& path, const Mesh& mesh, const GltfOutput& settings) {
  path_ = path;
  mesh_ = mesh;
  settings_ = settings;
  split_ = SplitAtSeams(mesh);
  return file_.Open(path);
}

Status GltfWriter::FormatFrame(const std::string& path, const Mesh& mesh, const Positions& positions,
                               const std::vector<Vec3f>& normals, std::string& bytes) {
  path_ = path;
  mesh_ = mesh;
  split_ = SplitAtSeams(mesh);
  frames_ = {positions};
  if (!mesh.normals.empty()) normals_ = {normals};
  return Named(path, [&] { return Format(bytes); });
}

Status GltfWriter::Write(std::int64_t /*number*/, const Positions& positions, const std::vector<Vec3f>& normals) {
  frames_.push_back(positions);
  if (!mesh_.normals.empty()) normals_.push_back(normals);
  return Status::Ok();
}

GltfWriter::Grid GltfWriter::ChooseGrid() const {
  Grid grid;
  if (settings_.compression == GltfCompression::kNone) return grid;
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Positions& frame : frames_) {
    for (const Vec3f& p : frame) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], static_cast<double>(p[k]));
        high[k] = std::max(high[k], static_cast<double>(p[k]));
      }
    }
  }
  double side = 0;
  for (int k = 0; k < 3; ++k) {
    grid.middle[k] = (low[k] + high[k]) / 2;
    side = std::max(side, high[k] - low[k]);
  }
  grid.step = side > 0 ? side / (2 * kLargest) : 1;
  return grid;
}

void GltfWriter::AddMesh(GltfBuilder& builder, const Grid& grid) const {
  nlohmann::json attributes;
  if (grid.step > 0) {
    Integers points;
    for (const std::uint32_t v : split_.vertices) points.push_back(grid.Point(frames_.front()[v]));
    attributes["POSITION"] = builder.Add(IntegerValues(points, false, false), true);
  } else {
    std::vector<Vec3f> points;
    for (const std::uint32_t v : split_.vertices) points.push_back(frames_.front()[v]);
    attributes["POSITION"] = builder.Add(FloatValues(points), true);
  }
  if (!normals_.empty()) {
    const std::vector<Vec3f> normals = Normals(split_, normals_.front());
    Integers quantized;
    for (const Vec3f& n : normals) quantized.push_back(QuantizedNormal(n));
    attributes["NORMAL"] = builder.Add(grid.step > 0 ? IntegerValues(quantized, true, true) : FloatValues(normals));
  }
  if (!mesh_.uvs.empty()) attributes["TEXCOORD_0"] = builder.Add(UvValues(mesh_, split_, grid.step > 0));
  if (!mesh_.colors.empty()) attributes["COLOR_0"] = builder.Add(ColorValues(mesh_, split_));
  nlohmann::json primitive = {{"attributes", std::move(attributes)}};
  if (!split_.triangles.empty()) {
    primitive["indices"] = builder.AddTriangles(split_.triangles, split_.size());
  } else {
    primitive["mode"] = 0;  // points
  }
  const std::string name = std::filesystem::path(path_).stem().string();
  builder.json()["meshes"] = {{{"name", name}, {"primitives", {std::move(primitive)}}}};
  nlohmann::json node = {{"mesh", 0}, {"name", name}};
  std::array<double, 3> translation = settings_.offset;
  for (int k = 0; k < 3; ++k) translation[k] += grid.middle[k];
  if (translation != std::array<double, 3>{}) node["translation"] = translation;
  if (grid.step > 0) node["scale"] = {grid.step, grid.step, grid.step};
  builder.json()["nodes"] = {std::move(node)};
  builder.json()["scenes"] = {{{"nodes", {0}}}};
  builder.json()["scene"] = 0;
}

void GltfWriter::AddTargets(GltfBuilder& builder, const Grid& grid) const {
  std::vector<Vec3f> first_normals;
  if (!normals_.empty()) first_normals = Normals(split_, normals_.front());
  nlohmann::json targets;
  for (std::size_t f = 1; f < frames_.size(); ++f) {
    nlohmann::json target;
    Integers integers;
    std::vector<Vec3f> floats;
    for (const std::uint32_t v : split_.vertices) {
      const Vec3f &p = frames_[f][v], &q = frames_[0][v];
      if (grid.step > 0) {
        const auto a = grid.Point(p), b = grid.Point(q);
        integers.push_back({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
      } else {
        floats.push_back({p[0] - q[0], p[1] - q[1], p[2] - q[2]});
      }
    }
    target["POSITION"] =
        builder.AddSparse(grid.step > 0 ? IntegerValues(integers, false, false) : FloatValues(floats), true);
    if (!normals_.empty()) {
      const std::vector<Vec3f> normals = Normals(split_, normals_[f]);
      // Normalized integers reach from -1 to 1, differences from -2 to 2.
      bool fits = grid.step > 0;
      integers.clear();
      floats.clear();
      for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3f &p = normals[i], &q = first_normals[i];
        floats.push_back({p[0] - q[0], p[1] - q[1], p[2] - q[2]});
        const auto a = QuantizedNormal(p), b = QuantizedNormal(q);
        integers.push_back({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
        for (const std::int32_t x : integers.back()) fits = fits && std::abs(x) <= 127;
      }
      target["NORMAL"] = builder.AddSparse(fits ? IntegerValues(integers, true, true) : FloatValues(floats));
    }
    targets.push_back(std::move(target));
  }
  nlohmann::json& mesh = builder.json()["meshes"][0];
  mesh["primitives"][0]["targets"] = std::move(targets);
  mesh["weights"] = std::vector<int>(frames_.size() - 1, 0);
}

void GltfWriter::AddAnimation(GltfBuilder& builder) const {
  const std::size_t frames = frames_.size();
  std::vector<float> times;
  for (std::size_t f = 0; f < frames; ++f) times.push_back(static_cast<float>(static_cast<double>(f) / settings_.fps));
  // At its own frame a target has the weight 1, at all others 0.
  GltfValues weights{{}, 1, frames * (frames - 1), kUnsignedByte, "SCALAR", true};
  weights.bytes.resize(weights.count);
  for (std::size_t f = 1; f < frames; ++f) weights.bytes[f * (frames - 1) + f - 1] = 255;
  const std::size_t input = builder.Add(FloatValues(times, 1), true), output = builder.Add(weights);
  builder.json()["animations"] = {
      {{"name", std::filesystem::path(path_).stem().string()},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}}}};
}

Status GltfWriter::Format(std::string& bytes) {
  if (frames_.empty()) return Status::InvalidArgument("no frames");
  GltfBuilder builder(settings_.compression);
  if (settings_.compression != GltfCompression::kNone) builder.UseExtension("KHR_mesh_quantization");
  const Grid grid = ChooseGrid();
  AddMesh(builder, grid);
  if (frames_.size() > 1) {
    AddTargets(builder, grid);
    AddAnimation(builder);
  }
  return builder.Finish(Extension(path_) == ".glb", bytes);
}

Status GltfWriter::Commit() {
  std::string bytes;
  SAC_RETURN_IF_ERROR(Named(path_, [&] { return Format(bytes); }));
  SAC_RETURN_IF_ERROR(file_.Write(bytes));
  return file_.Commit();
}

Warnings GltfWriter::warnings() const {
  Warnings warnings;
  if (const std::size_t doubles = split_.size() - mesh_.positions.size(); doubles > 0) {
    warnings.push_back(path_ + ": " + std::to_string(doubles) +
                       " vertices come twice, after all others: corners of them have normals or texture coordinates of "
                       "their own, and the format has one of each for a vertex");
  }
  return warnings;
}

}  // namespace sac
