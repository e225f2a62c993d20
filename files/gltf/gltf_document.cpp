// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "files/gltf/meshopt_view.h"

namespace sac {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

std::uint32_t Read32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char small = static_cast<char>(c | 0x20);
  return small >= 'a' && small <= 'f' ? small - 'a' + 10 : -1;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> DecodeBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      digit = static_cast<std::uint32_t>(c - 'a' + 26);
    } else if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0' + 52);
    } else if (c == '+' || c == '/') {
      digit = c == '+' ? 62 : 63;
    } else {
      return std::nullopt;
    }
    bits = bits << 6 | digit;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return bytes;
}

std::string DecodePercent(std::string_view uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && HexDigit(uri[i + 1]) >= 0 && HexDigit(uri[i + 2]) >= 0) {
      decoded += static_cast<char>(HexDigit(uri[i + 1]) * 16 + HexDigit(uri[i + 2]));
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

GltfDocument::GltfDocument(std::span<const std::uint8_t> bytes, Load load, const GltfLimits& limits)
    : load_(std::move(load)), limits_(limits) {
  if (bytes.empty()) ThrowCorrupt("the file is empty");
  if (bytes.size() >= 4 && Read32(bytes, 0) == kGlbMagic) {
    ParseGlb(bytes);
  } else {
    ParseJson(bytes);
  }
  if (!json_.is_object()) ThrowCorrupt("no glTF: its JSON is no object");
  const std::string version = root()["asset"]["version"].String();
  if (version.empty()) ThrowCorrupt("no glTF: asset.version is missing");
  if (!version.starts_with("2."))
    ThrowUnsupported("glTF " + version + "; 2.0 is read. Convert it, as with gltf-pipeline");
  CheckExtensions();
  buffers_.resize(root()["buffers"].size());
  views_.resize(root()["bufferViews"].size());
}

void GltfDocument::ParseGlb(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20) ThrowCorrupt("GLB: header: the file ends here");
  if (const std::uint32_t version = Read32(bytes, 4); version != 2) {
    ThrowUnsupported("GLB of version " + std::to_string(version) + "; version 2 is read");
  }
  const std::uint32_t length = Read32(bytes, 8);
  if (length > bytes.size() || length < 20) {
    ThrowCorrupt("GLB: header says " + std::to_string(length) + " bytes, but the file has " +
                 std::to_string(bytes.size()));
  }
  bytes = bytes.first(length);
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= bytes.size(); ++chunk) {
    const std::uint32_t size = Read32(bytes, at), type = Read32(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at)
      ThrowCorrupt("GLB: a chunk of " + std::to_string(size) + " bytes ends after the file");
    const auto content = bytes.subspan(at, size);
    if (chunk == 0 && type != kJsonChunk) ThrowCorrupt("GLB: its first chunk is not JSON");
    if (chunk == 0) ParseJson(content);
    if (chunk == 1 && type == kBinaryChunk) {
      binary_.assign(content.begin(), content.end());
      has_binary_ = true;
    }
    at += size;
  }
}

void GltfDocument::ParseJson(std::span<const std::uint8_t> text) {
  try {
    json_ = nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::exception& e) {
    std::string reason = e.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    if (const std::size_t end = reason.find("] "); end != std::string::npos) reason.erase(0, end + 2);
    for (char& c : reason) c = static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? '?' : c;
    ThrowCorrupt("its JSON: " + reason.substr(0, 200));
  }
}

void GltfDocument::CheckExtensions() const {
  const JsonValue required = root()["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string name = required[i].String();
    if (!IsHarmless(name)) ThrowUnsupported("requires the extension " + name.substr(0, 60) + ", which is not read");
  }
}

bool GltfDocument::IsHarmless(std::string_view extension) {
  for (const char* prefix :
       {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_", "KHR_xmp"}) {
    if (extension.starts_with(prefix)) return true;
  }
  for (const char* name : {"KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_meshopt_compression",
                           "KHR_draco_mesh_compression", "MSFT_texture_dds"}) {
    if (extension == name) return true;
  }
  return false;
}

std::span<const std::uint8_t> GltfDocument::Buffer(std::size_t index) {
  auto& kept = buffers_[index];
  if (kept) return *kept;
  const JsonValue buffer = root()["buffers"][index];
  const std::uint64_t length = buffer["byteLength"].Unsigned(limits_.file_bytes);
  std::span<const std::uint8_t> bytes;
  if (!buffer["uri"]) {
    if (index != 0 || !has_binary_) ThrowCorrupt(buffer.place() + ": has no uri, and there is no binary chunk for it");
    bytes = binary_;
  } else {
    const std::string uri = buffer["uri"].String();
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      if (comma == std::string::npos || uri.find(";base64") > comma)
        ThrowCorrupt(buffer.place() + ": data without base64");
      auto data = DecodeBase64(std::string_view(uri).substr(comma + 1));
      if (!data) ThrowCorrupt(buffer.place() + ": its base64 is broken");
      kept = std::move(*data);
    } else {
      const std::size_t colon = uri.find(':');
      if (colon != std::string::npos && colon > 1 && colon < uri.find('/')) {
        ThrowUnsupported(buffer.place() + ": '" + uri.substr(0, 60) + "' is not beside the file; put it there");
      }
      kept = load_(DecodePercent(uri));
    }
    bytes = *kept;
  }
  if (bytes.size() < length) {
    ThrowCorrupt(buffer.place() + ": has " + std::to_string(bytes.size()) + " bytes, not " + std::to_string(length));
  }
  return bytes.first(static_cast<std::size_t>(length));
}

std::span<const std::uint8_t> GltfDocument::Part(const JsonValue& view) {
  const auto buffer = Buffer(view["buffer"].Index(buffers_.size()));
  const std::uint64_t offset = view["byteOffset"].Unsigned(limits_.file_bytes, 0);
  const std::uint64_t length = view["byteLength"].Unsigned(limits_.file_bytes);
  if (offset > buffer.size() || length > buffer.size() - offset) {
    ThrowCorrupt(view.place() + ": ends after its buffer of " + std::to_string(buffer.size()) + " bytes");
  }
  return buffer.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::span<const std::uint8_t> GltfDocument::View(std::size_t index) {
  const JsonValue view = root()["bufferViews"][index];
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const JsonValue compression = view["extensions"][name];
    if (!compression) continue;
    if (!views_[index]) views_[index] = DecodeMeshoptView(compression, Part(compression), limits_.values);
    return *views_[index];
  }
  return Part(view);
}

}  // namespace sac
