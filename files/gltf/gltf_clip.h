// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "files/gltf/gltf_document.h"
#include "files/scene_reader.h"
#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

// True for .gltf and .glb in any case.
bool IsGltfName(const std::string& path);

struct GltfSettings {
  FrameRate rate = {};    // at which an animation is sampled; unknown: the lowest usual one that has its keys on frames
  std::string animation;  // name or number; empty: the first
  std::string scene;      // name or number; empty: the file's own
  GltfLimits limits = {};
};

// A glTF 2.0 file as a clip: the meshes of a scene, in the order of their nodes, become one, sampled from time 0 to the
// last key of an animation. Vertices, of each primitive but those that share all attributes, stay as they are.
Status OpenGltfClip(const std::string& path, const GltfSettings& settings, std::unique_ptr<SceneReader>& reader);

// The same for a file in memory; buffers beside it are refused.
Status ParseGltfClip(const std::string& name, std::span<const std::uint8_t> bytes, const GltfSettings& settings,
                     std::unique_ptr<SceneReader>& reader);

}  // namespace sac
