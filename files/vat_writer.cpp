// SPDX-License-Identifier: Apache-2.0
#include "files/vat_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/gltf/gltf_writer.h"
#include "files/overwriting.h"
#include "files/path.h"
#include "files/texture_file.h"
#include "geometry/normals.h"

namespace sac {
namespace {

// The side of a texture that graphics hardware has taken for long.
constexpr std::size_t kLargestSide = 16384;

std::string Beside(const std::string& path, const std::string& ending) {
  const std::filesystem::path p = path;
  return (p.parent_path() / (p.stem().string() + ending)).string();
}

}  // namespace

bool IsVatName(const std::string& path) { return Extension(path) == ".vat"; }

std::vector<std::string> FilesOfVat(const std::string& path, bool exr) {
  const std::string kind = exr ? ".exr" : ".png";
  return {path, Beside(path, "_positions" + kind), Beside(path, "_normals" + kind), Beside(path, ".glb")};
}

Status VatWriter::Open(const std::string& path, const Mesh& mesh, const VatSettings& settings) {
  path_ = path;
  mesh_ = mesh;
  settings_ = settings;
  split_ = SplitAtSeams(mesh);
  return Status::Ok();
}

Status VatWriter::Write(std::int64_t /*number*/, const Positions& positions, const std::vector<Vec3f>& normals) {
  frames_.push_back(positions);
  normals_.push_back(mesh_.normals.empty() ? VertexNormals(positions, mesh_.triangles) : normals);
  return Status::Ok();
}

// As near to a square as can be.
Status VatWriter::ChooseLayout() {
  std::size_t best = std::numeric_limits<std::size_t>::max();
  for (std::size_t rows = 1; rows <= split_.size(); ++rows) {
    const std::size_t width = (split_.size() + rows - 1) / rows, side = std::max(width, rows * frames_.size());
    if (side >= best) break;
    best = side;
    width_ = width;
    rows_ = rows;
  }
  if (best > kLargestSide) {
    return Status::Limit(path_ + ": " + std::to_string(split_.size()) + " vertices in " +
                         std::to_string(frames_.size()) + " frames are more than a texture of " +
                         std::to_string(kLargestSide) + " x " + std::to_string(kLargestSide) +
                         " texels has room for; decode fewer --frames");
  }
  return Status::Ok();
}

std::size_t VatWriter::Texel(std::size_t frame, std::size_t vertex) const {
  return (frame * rows_ + vertex / width_) * width_ + vertex % width_;
}

VatWriter::Texture VatWriter::PositionTexture() const {
  Texture texture;
  texture.texels.resize(width_ * rows_ * frames_.size());
  if (!settings_.exr) {
    for (int k = 0; k < 3; ++k) texture.scale[k] = high_[k] > low_[k] ? high_[k] - low_[k] : 1;
    texture.bias = low_;
  }
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (std::size_t i = 0; i < split_.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const double x = static_cast<double>(frames_[f][split_.vertices[i]][k]);
        texture.texels[Texel(f, i)][k] = static_cast<float>((x - texture.bias[k]) / texture.scale[k]);
      }
    }
  }
  return texture;
}

VatWriter::Texture VatWriter::NormalTexture() const {
  Texture texture;
  texture.texels.resize(width_ * rows_ * frames_.size());
  if (!settings_.exr) {
    texture.scale.fill(2);
    texture.bias.fill(-1);
  }
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (std::size_t i = 0; i < split_.size(); ++i) {
      const Vec3f& n = normals_[f][split_.normals.empty() ? split_.vertices[i] : split_.normals[i]];
      for (int k = 0; k < 3; ++k) texture.texels[Texel(f, i)][k] = settings_.exr ? n[k] : (n[k] + 1) / 2;
    }
  }
  return texture;
}

Status VatWriter::Keep(const std::string& path, const std::string& bytes, bool named) {
  if (!named && !settings_.force) SAC_RETURN_IF_ERROR(CheckUnnamed(path, bytes));
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes));
  SAC_RETURN_IF_ERROR(file.Close());
  files_.push_back(std::move(file));
  return Status::Ok();
}

Status VatWriter::WriteTexture(const std::string& path, const Texture& texture) {
  std::string bytes;
  const std::size_t height = rows_ * frames_.size();
  SAC_RETURN_IF_ERROR(Named(path, [&] {
    return settings_.exr ? FormatExr(texture.texels, width_, height, bytes)
                         : FormatPng16(texture.texels, width_, height, bytes);
  }));
  return Keep(path, bytes, false);
}

Status VatWriter::WriteMeshFile(const std::string& path) {
  GltfWriter writer;
  Mesh mesh = mesh_;
  if (mesh.normals.empty()) mesh.normals = normals_.front();
  std::string bytes;
  SAC_RETURN_IF_ERROR(writer.FormatFrame(path, mesh, frames_.front(), normals_.front(), bytes));
  return Keep(path, bytes, false);
}

Status VatWriter::Commit() {
  if (frames_.empty()) return Status::InvalidArgument(path_ + ": no frames");
  SAC_RETURN_IF_ERROR(ChooseLayout());
  low_.fill(std::numeric_limits<double>::infinity());
  high_.fill(-std::numeric_limits<double>::infinity());
  for (const Positions& frame : frames_) {
    for (const Vec3f& p : frame) {
      for (int k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], static_cast<double>(p[k]));
        high_[k] = std::max(high_[k], static_cast<double>(p[k]));
      }
    }
  }
  const std::vector<std::string> names = FilesOfVat(path_, settings_.exr);
  const Texture positions = PositionTexture(), normals = NormalTexture();
  SAC_RETURN_IF_ERROR(WriteTexture(names[1], positions));
  SAC_RETURN_IF_ERROR(WriteTexture(names[2], normals));
  SAC_RETURN_IF_ERROR(WriteMeshFile(names[3]));
  const auto file = [](const std::string& name) { return std::filesystem::path(name).filename().string(); };
  nlohmann::ordered_json json = {
      {"format", "sac vertex animation texture"},
      {"version", 1},
      {"vertices", split_.size()},
      {"frames", frames_.size()},
      {"fps", settings_.fps},
      {"width", width_},
      {"rows", rows_},
      {"height", rows_ * frames_.size()},
      {"offset", settings_.offset},
      {"low", low_},
      {"high", high_},
      {"mesh", file(names[3])},
      {"positions", {{"file", file(names[1])}, {"scale", positions.scale}, {"bias", positions.bias}}},
      {"normals", {{"file", file(names[2])}, {"scale", normals.scale}, {"bias", normals.bias}}}};
  SAC_RETURN_IF_ERROR(Keep(path_, json.dump(2) + "\n", true));
  for (OutputFile& written : files_) SAC_RETURN_IF_ERROR(written.Commit());
  return Status::Ok();
}

Warnings VatWriter::warnings() const {
  Warnings warnings;
  if (const std::size_t doubles = split_.size() - mesh_.positions.size(); doubles > 0) {
    warnings.push_back(path_ + ": " + std::to_string(doubles) +
                       " vertices come twice, after all others: corners of them have normals or texture coordinates of "
                       "their own");
  }
  return warnings;
}

}  // namespace sac
