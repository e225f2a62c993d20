// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/gltf/json_value.h"

namespace sac {

// What reading a file may cost.
struct GltfLimits {
  std::uint64_t file_bytes = std::uint64_t{1} << 32;  // of the file and of each buffer beside it
  std::uint64_t values = std::uint64_t{1} << 28;      // numbers of an accessor; bytes of a view that is decompressed
  std::uint64_t vertices = std::uint64_t{1} << 26;    // of the scene
  std::uint64_t frames = 1000000;                     // sampled of an animation
  std::size_t nodes = 1 << 20;
};

// A glTF 2.0 asset (Khronos, glTF 2.0 specification): its JSON and its buffers, of a .gltf with buffers beside it or
// within, or of a .glb (4.4). Everything throws GltfError; messages do not name the file.
class GltfDocument {
 public:
  // Gives the bytes of a file that a relative URI names, decoded from its percent signs.
  using Load = std::function<std::vector<std::uint8_t>(const std::string& uri)>;

  // Reads `bytes` of a .gltf or a .glb. Buffers are loaded when they are used.
  GltfDocument(std::span<const std::uint8_t> bytes, Load load, const GltfLimits& limits = {});
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  // Whether an extension is read, or changes nothing of the geometry as far as a mesh keeps it.
  static bool IsHarmless(std::string_view extension);

  JsonValue root() const { return {&json_, ""}; }
  const GltfLimits& limits() const { return limits_; }

  // Bytes of a buffer view, decompressed (EXT_meshopt_compression, KHR_meshopt_compression). Kept after the first time.
  std::span<const std::uint8_t> View(std::size_t index);

 private:
  std::span<const std::uint8_t> Buffer(std::size_t index);
  // The bytes from byteOffset on, byteLength of them, of the buffer that `view` names.
  std::span<const std::uint8_t> Part(const JsonValue& view);
  void ParseGlb(std::span<const std::uint8_t> bytes);
  void ParseJson(std::span<const std::uint8_t> text);
  void CheckExtensions() const;

  nlohmann::json json_;
  Load load_;
  GltfLimits limits_;
  std::vector<std::uint8_t> binary_;  // of a .glb
  bool has_binary_ = false;
  std::vector<std::optional<std::vector<std::uint8_t>>> buffers_, views_;
};

// The bytes of base64 (RFC 4648); nothing if it is none.
std::optional<std::vector<std::uint8_t>> DecodeBase64(std::string_view text);

// What `%20` and the like of a URI stand for.
std::string DecodePercent(std::string_view uri);

}  // namespace sac
