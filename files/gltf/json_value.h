// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// What ends the reading of a file, wherever a rule is found broken. It is thrown and caught within files/gltf/: values
// are looked up at hundreds of places, and none of them could go on without its value.
struct GltfError : std::runtime_error {
  GltfError(StatusCode code, const std::string& message) : std::runtime_error(message), status(code, message) {}
  Status status;
};

[[noreturn]] inline void ThrowCorrupt(const std::string& message) { throw GltfError(StatusCode::kCorrupt, message); }
[[noreturn]] inline void ThrowUnsupported(const std::string& message) {
  throw GltfError(StatusCode::kUnsupported, message);
}
[[noreturn]] inline void ThrowLimit(const std::string& message) { throw GltfError(StatusCode::kLimit, message); }

// A value of the document with its place in it, such as `meshes[2].primitives[0]`, for messages. A value that is not
// there is null; one of the wrong type throws a GltfError of kCorrupt.
class JsonValue {
 public:
  JsonValue() = default;
  JsonValue(const nlohmann::json* json, std::string place) : json_(json), place_(std::move(place)) {}

  bool exists() const { return json_ != nullptr && !json_->is_null(); }
  explicit operator bool() const { return exists(); }
  const std::string& place() const { return place_; }
  const nlohmann::json& json() const { return *json_; }

  // A member of an object; of what does not exist, one that does not exist.
  JsonValue operator[](const char* key) const;
  // An element of an array.
  JsonValue operator[](std::size_t index) const;
  // The number of elements of an array, 0 if it does not exist.
  std::size_t size() const;
  // The keys of an object.
  std::vector<std::string> keys() const;

  // An integer from 0 to `most`.
  std::uint64_t Unsigned(std::uint64_t most) const;
  std::uint64_t Unsigned(std::uint64_t most, std::uint64_t otherwise) const {
    return exists() ? Unsigned(most) : otherwise;
  }
  // An index of something that there are `count` of.
  std::size_t Index(std::size_t count) const;
  std::optional<std::size_t> OptionalIndex(std::size_t count) const;
  // A finite number.
  double Number() const;
  double Number(double otherwise) const { return exists() ? Number() : otherwise; }
  // An array of `count` finite numbers.
  std::vector<double> Numbers(std::size_t count) const;
  bool Bool(bool otherwise) const;
  // Empty if it does not exist.
  std::string String() const;

 private:
  const nlohmann::json* json_ = nullptr;
  std::string place_;
};

}  // namespace sac
