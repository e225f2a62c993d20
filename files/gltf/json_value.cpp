// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/json_value.h"

#include <cmath>

namespace sac {

JsonValue JsonValue::operator[](const char* key) const {
  if (!exists()) return {nullptr, place_ + "." + key};
  if (!json_->is_object()) ThrowCorrupt(place_ + ": not an object");
  const auto found = json_->find(key);
  return {found == json_->end() ? nullptr : &*found, place_.empty() ? key : place_ + "." + key};
}

JsonValue JsonValue::operator[](std::size_t index) const {
  if (index >= size()) ThrowCorrupt(place_ + "[" + std::to_string(index) + "]: not there");
  return {&(*json_)[index], place_ + "[" + std::to_string(index) + "]"};
}

std::size_t JsonValue::size() const {
  if (!exists()) return 0;
  if (!json_->is_array()) ThrowCorrupt(place_ + ": not an array");
  return json_->size();
}

std::vector<std::string> JsonValue::keys() const {
  std::vector<std::string> keys;
  if (!exists()) return keys;
  if (!json_->is_object()) ThrowCorrupt(place_ + ": not an object");
  for (const auto& item : json_->items()) keys.push_back(item.key());
  return keys;
}

std::uint64_t JsonValue::Unsigned(std::uint64_t most) const {
  if (!exists()) ThrowCorrupt(place_ + ": missing");
  // Exporters of dynamic languages write 3.0 for 3.
  const bool whole = json_->is_number_float() && json_->get<double>() == std::floor(json_->get<double>());
  if (!json_->is_number_integer() && !whole) ThrowCorrupt(place_ + ": not an integer");
  const double value = json_->get<double>();
  if (!(value >= 0) || value > static_cast<double>(most)) {
    ThrowCorrupt(place_ + ": " + json_->dump() + " is not in 0.." + std::to_string(most));
  }
  return json_->is_number_float() ? static_cast<std::uint64_t>(value) : json_->get<std::uint64_t>();
}

std::size_t JsonValue::Index(std::size_t count) const {
  if (exists() && count == 0) ThrowCorrupt(place_ + ": refers to nothing that is there");
  return static_cast<std::size_t>(Unsigned(count == 0 ? 0 : count - 1));
}

std::optional<std::size_t> JsonValue::OptionalIndex(std::size_t count) const {
  if (!exists()) return std::nullopt;
  return Index(count);
}

double JsonValue::Number() const {
  if (!exists()) ThrowCorrupt(place_ + ": missing");
  if (!json_->is_number()) ThrowCorrupt(place_ + ": not a number");
  const double value = json_->get<double>();
  if (!std::isfinite(value)) ThrowCorrupt(place_ + ": not a finite number");
  return value;
}

std::vector<double> JsonValue::Numbers(std::size_t count) const {
  if (size() != count) ThrowCorrupt(place_ + ": not " + std::to_string(count) + " numbers");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back((*this)[i].Number());
  return numbers;
}

bool JsonValue::Bool(bool otherwise) const {
  if (!exists()) return otherwise;
  if (!json_->is_boolean()) ThrowCorrupt(place_ + ": neither true nor false");
  return json_->get<bool>();
}

std::string JsonValue::String() const {
  if (!exists()) return {};
  if (!json_->is_string()) ThrowCorrupt(place_ + ": not a string");
  return json_->get<std::string>();
}

}  // namespace sac
