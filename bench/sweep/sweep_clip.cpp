// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/sweep_clip.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "bench/sweep/content_key.h"
#include "files/cache_file.h"
#include "files/clip_input.h"
#include "files/frame_sequence.h"
#include "files/mesh_file.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// The name of a clip: "walk" for walk.obj and for walk_%04d.ply.
std::string NameOf(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  name = name.substr(0, name.find('%'));
  while (!name.empty() && std::string("_-. ").find(name.back()) != std::string::npos) name.pop_back();
  return name.empty() ? "clip" : name;
}

// The mesh without attributes. Only positions and triangles are compared, since not every codec codes attributes.
Mesh GeometryOf(const Mesh& mesh) {
  Mesh geometry;
  geometry.positions = mesh.positions;
  geometry.triangles = mesh.triangles;
  return geometry;
}

}  // namespace

std::vector<std::vector<std::string>> ClipsOf(const std::vector<std::string>& inputs) {
  std::vector<std::vector<std::string>> clips;
  bool open = false;  // the last clip is a run of meshes that may go on
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (i + 1 < inputs.size() && IsCacheName(inputs[i + 1])) {
      clips.push_back({inputs[i], inputs[i + 1]});
      open = false;
      ++i;
    } else if (open && !IsSequenceName(inputs[i])) {
      clips.back().push_back(inputs[i]);
    } else {
      clips.push_back({inputs[i]});
      open = !IsSequenceName(inputs[i]);
    }
  }
  return clips;
}

Status PrepareClip(const std::vector<std::string>& inputs, const std::string& directory, SweepClip& clip) {
  std::unique_ptr<ClipInput> input;
  SAC_RETURN_IF_ERROR(ClipInput::Open(inputs, input));
  const Mesh mesh = GeometryOf(input->mesh());
  clip.name = NameOf(inputs.front());
  clip.frames = *input->frame_count();
  clip.vertices = mesh.positions.size();
  clip.triangles = mesh.triangles.size();
  clip.diagonal = BoundingBox(mesh.positions).diagonal();
  clip.display = MakeDisplayMesh(mesh, clip.frames);

  ContentKey key;
  key.Add(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  const std::string unnamed = directory + "/unnamed.pc2";
  std::unique_ptr<CacheWriter> cache;
  SAC_RETURN_IF_ERROR(CacheWriter::Open(unnamed, clip.vertices, 30, clip.frames, cache));
  Positions positions;
  for (bool end = false;;) {
    SAC_RETURN_IF_ERROR(input->Next(positions, end));
    if (end) break;
    key.Add(positions.data(), positions.size() * sizeof(Vec3f));
    SAC_RETURN_IF_ERROR(cache->Write(positions));
  }
  SAC_RETURN_IF_ERROR(cache->Commit());
  clip.key = key.Text();
  clip.mesh_path = directory + "/" + clip.key + ".obj";
  clip.cache_path = directory + "/" + clip.key + ".pc2";
  std::error_code error;
  std::filesystem::rename(unnamed, clip.cache_path, error);
  if (error) return Status::IoError(clip.cache_path + ": " + error.message());
  return WriteMesh(clip.mesh_path, mesh);
}

}  // namespace sac
