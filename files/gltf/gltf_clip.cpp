// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_clip.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "files/gltf/gltf_animation.h"
#include "files/gltf/gltf_scene.h"
#include "files/path.h"
#include "files/polygon_mesh.h"

namespace sac {
namespace {

constexpr unsigned kDefaultRate = 30;

std::vector<std::uint8_t> ReadBytes(const std::string& path, std::uint64_t most) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw GltfError(StatusCode::kIoError, error ? error.message() : "cannot be read");
  if (size > most) ThrowLimit(std::to_string(size) + " bytes are more than the limit");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file) throw GltfError(StatusCode::kIoError, "cannot be read");
  return bytes;
}

std::string ListNames(const JsonValue& list) {
  std::string names;
  for (std::size_t i = 0; i < list.size() && i < 8; ++i) {
    const std::string name = list[i]["name"].String();
    names += (i == 0 ? "" : ", ") + (name.empty() ? std::to_string(i) : name.substr(0, 40));
  }
  if (list.size() > 8) names += ", ...";
  for (char& c : names) c = static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? '?' : c;
  return names;
}

// The element of `list` with the name, or the number, `wanted`.
std::size_t Choose(const JsonValue& list, const std::string& wanted) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i]["name"].String() == wanted) return i;
  }
  std::size_t number = 0;
  const auto result = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  if (result.ec == std::errc() && result.ptr == wanted.data() + wanted.size() && number < list.size()) return number;
  throw GltfError(StatusCode::kInvalidArgument, "has no '" + wanted + "' among its " + list.place() + ": " +
                                                    (list.size() == 0 ? "none" : ListNames(list)));
}

class GltfClip : public SceneReader {
 public:
  // `settings` are checked here. Throws GltfError.
  GltfClip(std::string name, std::span<const std::uint8_t> bytes, GltfDocument::Load load, const GltfSettings& settings)
      : name_(std::move(name)), document_(bytes, std::move(load), settings.limits) {
    std::optional<std::size_t> scene;
    const JsonValue scenes = document_.root()["scenes"];
    if (!settings.scene.empty()) {
      scene = Choose(scenes, settings.scene);
    } else if (scenes.size() > 0) {
      scene = document_.root()["scene"].OptionalIndex(scenes.size()).value_or(0);
      if (scenes.size() > 1) {
        warnings_.push_back("has the scenes " + ListNames(scenes) + "; " + std::to_string(*scene) +
                            " is taken, --scene names another");
      }
    }
    scene_.emplace(document_, scene, losses_);
    if (scene_->vertices() == 0) ThrowCorrupt("no vertices of triangles in the scene");
    ChooseAnimation(settings);
    for (const std::string& extension : UnknownExtensions()) losses_.List("extensions", extension);
  }

  FrameRate rate() const override { return rate_; }
  std::uint32_t frame_count() const override { return frames_; }

  Status ReadMesh(std::uint32_t frame, MeshFile& file) override {
    return Named(name_, [&] { return Guarded([&] { return TakeMesh(frame, file); }); });
  }

  Status ReadPositions(std::uint32_t frame, std::uint32_t /*first*/, MeshFile& file) override {
    return Named(name_, [&] {
      return Guarded([&] {
        scene_->Pose(animation(), Time(frame));
        scene_->Evaluate(file.exact, nullptr);
        TakePositions(file);
        return Status::Ok();
      });
    });
  }

  template <typename Step>
  static Status Guarded(Step step) {
    try {
      return step();
    } catch (const GltfError& error) {
      return error.status;
    }
  }

 private:
  const GltfAnimation* animation() const { return animation_ ? &*animation_ : nullptr; }
  double Time(std::uint32_t frame) const { return frame == 0 ? 0 : frame / rate_.per_second(); }
  void ChooseAnimation(const GltfSettings& settings);
  std::vector<std::string> UnknownExtensions() const;
  Status TakeMesh(std::uint32_t frame, MeshFile& file);
  void AddInstance(const GltfScene::Instance& instance, std::size_t first, PolygonMesh& parsed,
                   std::vector<std::array<float, 4>>& colors) const;
  static void TakePositions(MeshFile& file);

  std::string name_;
  GltfDocument document_;
  Losses losses_;
  Warnings warnings_;  // without the name
  std::optional<GltfScene> scene_;
  std::optional<GltfAnimation> animation_;
  FrameRate rate_;
  std::uint32_t frames_ = 1;
};

void GltfClip::ChooseAnimation(const GltfSettings& settings) {
  const JsonValue animations = document_.root()["animations"];
  std::size_t chosen = 0;
  if (!settings.animation.empty()) {
    chosen = Choose(animations, settings.animation);
  } else if (animations.size() > 1) {
    warnings_.push_back("has the animations " + ListNames(animations) +
                        "; the first is taken, --animation names another");
  }
  rate_ = settings.rate;
  if (animations.size() == 0) return;
  animation_.emplace(document_, chosen, scene_->weights(), losses_);
  if (rate_.numerator == 0) {
    const auto own = animation_->FrameRateOfKeys();
    rate_ = {own.value_or(kDefaultRate), 1};
    if (!own) {
      warnings_.push_back("its keys fit no usual frame rate; it is sampled at " + std::to_string(kDefaultRate) +
                          " frames a second, --fps sets another rate");
    }
  }
  // A last key that rounding has put before its frame still gets it.
  constexpr double kRounding = 1e-3;
  const double frames = std::floor(animation_->duration() * rate_.per_second() + kRounding) + 1;
  if (frames > static_cast<double>(document_.limits().frames)) {
    ThrowLimit("the animation lasts " + std::to_string(animation_->duration()) + " s, that is more frames than " +
               std::to_string(document_.limits().frames));
  }
  frames_ = static_cast<std::uint32_t>(frames);
}

std::vector<std::string> GltfClip::UnknownExtensions() const {
  std::vector<std::string> unknown;
  const JsonValue used = document_.root()["extensionsUsed"];
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::string name = used[i].String();
    if (!GltfDocument::IsHarmless(name)) unknown.push_back(name);
  }
  return unknown;
}

void GltfClip::AddInstance(const GltfScene::Instance& instance, std::size_t first, PolygonMesh& parsed,
                           std::vector<std::array<float, 4>>& colors) const {
  const bool mirrored = scene_->IsMirrored(instance);
  for (const GltfPrimitive& primitive : scene_->mesh(instance).primitives) {
    for (const Triangle& t : primitive.triangles) {
      for (const int k : {0, mirrored ? 2 : 1, mirrored ? 1 : 2}) {
        const auto vertex = static_cast<std::uint32_t>(first + t[k]);
        parsed.faces.vertices.push_back(vertex);
        // Normals and texture coordinates have the numbers of vertices; FinishMesh() drops what is not used.
        parsed.corner_uvs.push_back(primitive.uvs.empty() ? PolygonMesh::kNone : vertex);
        parsed.corner_normals.push_back(primitive.normals.empty() ? PolygonMesh::kNone : vertex);
      }
      const Status status = parsed.EndFace();
      if (!status.ok()) throw GltfError(status.code(), status.message());
    }
    for (std::size_t v = 0; v < primitive.vertices; ++v) {
      // glTF counts v from the top of an image, a Mesh from below.
      parsed.uvs.push_back(primitive.uvs.empty() ? std::array<float, 2>{}
                                                 : std::array{primitive.uvs[2 * v], 1 - primitive.uvs[2 * v + 1]});
      if (primitive.colors.empty()) {
        colors.push_back({1, 1, 1, 1});
      } else {
        const float* c = primitive.colors.data() + 4 * v;
        colors.push_back({c[0], c[1], c[2], c[3]});
      }
    }
    first += primitive.vertices;
  }
}

Status GltfClip::TakeMesh(std::uint32_t frame, MeshFile& file) {
  PolygonMesh parsed;
  std::vector<Vec3d> positions, normals;
  scene_->Pose(animation(), Time(frame));
  scene_->Evaluate(positions, &normals);
  bool any_uvs = false, any_colors = false;
  std::size_t with_normals = 0, first = 0;
  std::vector<std::array<float, 4>> colors;
  for (const GltfScene::Instance& instance : scene_->instances()) {
    AddInstance(instance, first, parsed, colors);
    parsed.objects += scene_->mesh(instance).primitives.empty() ? 0 : 1;
    losses_.List("names of objects", scene_->name(instance));
    for (const GltfPrimitive& primitive : scene_->mesh(instance).primitives) {
      any_uvs |= !primitive.uvs.empty();
      any_colors |= !primitive.colors.empty();
      with_normals += primitive.normals.empty() ? 0 : primitive.vertices;
      first += primitive.vertices;
    }
  }
  for (std::size_t v = 0; v < positions.size(); ++v) {
    parsed.AddPosition(positions[v], [v] { return "vertex " + std::to_string(v); });
  }
  parsed.wide = true;
  if (!any_uvs) {
    parsed.uvs.clear();
    parsed.corner_uvs.clear();
  }
  if (with_normals > 0) {
    for (const Vec3d& n : normals) {
      parsed.normals.push_back({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
    }
  }
  if (with_normals == 0 || with_normals == positions.size()) parsed.corner_normals.clear();
  if (any_colors) parsed.colors = RoundColors(colors, losses_);
  parsed.losses = losses_;
  parsed.warnings = warnings_;
  SAC_RETURN_IF_ERROR(FinishMesh(parsed, {}, file));
  for (std::string& warning : file.warnings) warning = name_ + ": " + warning;
  return Status::Ok();
}

void GltfClip::TakePositions(MeshFile& file) {
  file.mesh.positions.clear();
  file.not_finite.clear();
  for (std::size_t v = 0; v < file.exact.size(); ++v) {
    const Vec3d& p = file.exact[v];
    file.mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    for (const float x : file.mesh.positions.back()) {
      if (!std::isfinite(x) && file.not_finite.empty()) file.not_finite = "vertex " + std::to_string(v);
    }
  }
}

Status Open(const std::string& path, const GltfSettings& settings, std::unique_ptr<SceneReader>& reader,
            const std::function<std::vector<std::uint8_t>()>& bytes, const GltfDocument::Load& load) {
  return Named(path, [&] {
    return GltfClip::Guarded([&] {
      reader = std::make_unique<GltfClip>(path, bytes(), load, settings);
      return Status::Ok();
    });
  });
}

}  // namespace

bool IsGltfName(const std::string& path) {
  const std::string extension = Extension(path);
  return extension == ".gltf" || extension == ".glb";
}

Status OpenGltfClip(const std::string& path, const GltfSettings& settings, std::unique_ptr<SceneReader>& reader) {
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  const std::uint64_t most = settings.limits.file_bytes;
  const auto load = [directory, most](const std::string& uri) {
    try {
      return ReadBytes((directory / uri).string(), most);
    } catch (const GltfError& error) {
      throw GltfError(error.status.code(), "its buffer " + uri.substr(0, 200) + ": " + error.status.message());
    }
  };
  return Open(
      path, settings, reader, [&] { return ReadBytes(path, most); }, load);
}

Status ParseGltfClip(const std::string& name, std::span<const std::uint8_t> bytes, const GltfSettings& settings,
                     std::unique_ptr<SceneReader>& reader) {
  const auto copy = [bytes] { return std::vector<std::uint8_t>(bytes.begin(), bytes.end()); };
  const auto load = [](const std::string& uri) -> std::vector<std::uint8_t> {
    ThrowUnsupported("its buffer " + uri.substr(0, 200) + " is not within the file");
  };
  return Open(name, settings, reader, copy, load);
}

}  // namespace sac
