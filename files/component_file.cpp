// SPDX-License-Identifier: Apache-2.0
#include "files/component_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "files/npy_archive.h"

namespace sac {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 34;  // in all arrays

// The bytes of numbers of this machine, which is taken for little endian as elsewhere arrays are copied.
template <class T>
std::string BytesOf(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

template <class T>
std::vector<T> ValuesOf(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

template <class T, std::size_t N>
std::vector<T> Flat(const std::vector<std::array<T, N>>& rows) {
  std::vector<T> flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return flat;
}

template <class T, std::size_t N>
std::vector<std::array<T, N>> Rows(const std::vector<T>& flat) {
  std::vector<std::array<T, N>> rows(flat.size() / N);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(N * i), N, rows[i].begin());
  }
  return rows;
}

// The values of an archive's arrays, with what was wrong with the first that cannot be used.
class ArrayReader {
 public:
  ArrayReader(const std::string& path, const NpyArchive& archive) : path_(path), archive_(archive) {}

  bool has(const std::string& name) const { return archive_.contains(name); }
  // The shape of an array; empty where it is missing.
  std::vector<std::uint64_t> shape(const std::string& name) const {
    const auto found = archive_.find(name);
    return found == archive_.end() ? std::vector<std::uint64_t>{} : found->second.shape;
  }

  template <class T>
  std::vector<T> Read(const std::string& name, const std::string& type, const std::vector<std::uint64_t>& wanted) {
    const auto found = archive_.find(name);
    if (found == archive_.end()) return Fail<T>("has no array " + name);
    const NpyArray& array = found->second;
    if (array.type != type) return Fail<T>("the array " + name + " is of the type " + array.type + ", not " + type);
    if (array.shape != wanted) return Fail<T>("the array " + name + " has another shape than the others ask for");
    return ValuesOf<T>(array.bytes);
  }

  Status status() const { return fault_.empty() ? Status::Ok() : Status::Corrupt(path_ + ": " + fault_); }

 private:
  template <class T>
  std::vector<T> Fail(const std::string& fault) {
    if (fault_.empty()) fault_ = fault;
    return {};
  }

  const std::string& path_;
  const NpyArchive& archive_;
  std::string fault_;
};

// Components that are dense in the file.
std::vector<SparseComponent> SparseOf(const std::vector<float>& dense, std::size_t count, std::size_t nodes,
                                      std::size_t channels) {
  std::vector<SparseComponent> components(count);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto begin = dense.begin() + static_cast<std::ptrdiff_t>((k * nodes + i) * channels);
      const auto end = begin + static_cast<std::ptrdiff_t>(channels);
      if (std::all_of(begin, end, [](float x) { return x == 0; })) continue;
      components[k].nodes.push_back(static_cast<std::uint32_t>(i));
      components[k].values.insert(components[k].values.end(), begin, end);
    }
    components[k].name = "component " + std::to_string(k);
  }
  return components;
}

std::vector<float> DenseOf(const SparseComponents& c) {
  const std::size_t channels = c.channels();
  std::vector<float> dense(c.components.size() * c.nodes() * channels, 0);
  for (std::size_t k = 0; k < c.components.size(); ++k) {
    const SparseComponent& component = c.components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      std::copy_n(component.values.begin() + static_cast<std::ptrdiff_t>(i * channels), channels,
                  dense.begin() + static_cast<std::ptrdiff_t>((k * c.nodes() + component.nodes[i]) * channels));
    }
  }
  return dense;
}

void ReadNames(const std::vector<std::uint8_t>& bytes, std::vector<SparseComponent>& components) {
  std::size_t k = 0;
  std::string name;
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) {
      name += static_cast<char>(byte);
    } else if (k < components.size()) {
      components[k++].name = std::move(name);
      name.clear();
    }
  }
}

void ReadOptional(ArrayReader& reader, SparseComponents& c) {
  const std::uint64_t frames = c.track.size(), count = c.components.size();
  if (reader.has("rotations")) {
    const auto rotations = Rows<double, 9>(reader.Read<double>("rotations", "<f8", {frames, 3, 3}));
    const auto moves = Rows<double, 3>(reader.Read<double>("moves", "<f8", {frames, 3}));
    for (std::size_t f = 0; f < std::min(rotations.size(), moves.size()); ++f) c.track[f] = {rotations[f], moves[f]};
  }
  if (reader.has("positive")) {
    const auto positive = reader.Read<std::uint8_t>("positive", "|u1", {});
    c.positive = !positive.empty() && positive[0] != 0;
  }
  if (reader.has("centres")) {
    const auto centres = reader.Read<std::uint32_t>("centres", "<u4", {count});
    for (std::size_t k = 0; k < centres.size(); ++k) c.components[k].centre = centres[k];
  }
  if (reader.has("still")) c.still = reader.Read<std::uint32_t>("still", "<u4", reader.shape("still"));
  if (reader.has("names")) ReadNames(reader.Read<std::uint8_t>("names", "|u1", reader.shape("names")), c.components);
  if (reader.has("rate")) {
    const auto rate = reader.Read<std::uint32_t>("rate", "<u4", {2});
    if (rate.size() == 2 && rate[1] > 0) c.rate = {rate[0], rate[1]};
  }
}

}  // namespace

Status FormatComponents(const SparseComponents& c, std::string& bytes) {
  const std::uint64_t frames = c.frames(), count = c.components.size(), nodes = c.nodes(), channels = c.channels();
  std::vector<std::array<double, 9>> rotations;
  std::vector<std::array<double, 3>> moves;
  for (const RigidPose& pose : c.track) {
    rotations.push_back(pose.rotation);
    moves.push_back(pose.translation);
  }
  std::vector<std::uint32_t> centres;
  std::string names;
  for (const SparseComponent& component : c.components) {
    centres.push_back(component.centre);
    names += component.name + '\0';
  }
  const char domain = c.domain == ComponentDomain::kGradient ? 1 : 0, positive = c.positive ? 1 : 0;
  NpyArchive archive;
  archive["domain"] = {"|u1", {}, std::string(1, domain)};
  archive["positive"] = {"|u1", {}, std::string(1, positive)};
  archive["rest"] = {"<f4", {c.rest.size(), 3}, BytesOf(Flat(c.rest))};
  archive["triangles"] = {"<u4", {c.triangles.size(), 3}, BytesOf(Flat(c.triangles))};
  archive["components"] = {"<f4", {count, nodes, channels}, BytesOf(DenseOf(c))};
  archive["weights"] = {"<f4", {frames, count}, BytesOf(c.weights)};
  archive["rotations"] = {"<f8", {frames, 3, 3}, BytesOf(Flat(rotations))};
  archive["moves"] = {"<f8", {frames, 3}, BytesOf(Flat(moves))};
  archive["centres"] = {"<u4", {count}, BytesOf(centres)};
  archive["names"] = {"|u1", {names.size()}, names};
  archive["still"] = {"<u4", {c.still.size()}, BytesOf(c.still)};
  archive["rate"] = {"<u4", {2}, BytesOf(std::vector<std::uint32_t>{c.rate.numerator, c.rate.denominator})};
  return FormatNpz(archive, bytes);
}

Status ReadComponents(const std::string& path, SparseComponents& c) {
  NpyArchive archive;
  SAC_RETURN_IF_ERROR(ReadNpz(path, kMostBytes, archive));
  c = {};
  ArrayReader reader(path, archive);
  const auto size = [&reader](const std::string& name, std::size_t axis) {
    const std::vector<std::uint64_t> shape = reader.shape(name);
    return axis < shape.size() ? shape[axis] : 0;
  };
  const auto domain = reader.Read<std::uint8_t>("domain", "|u1", {});
  if (!domain.empty() && domain[0] > 1) return Status::Unsupported(path + ": components of an unknown domain");
  c.domain = !domain.empty() && domain[0] == 1 ? ComponentDomain::kGradient : ComponentDomain::kDisplacement;
  c.rest = Rows<float, 3>(reader.Read<float>("rest", "<f4", {size("rest", 0), 3}));
  c.triangles = Rows<std::uint32_t, 3>(reader.Read<std::uint32_t>("triangles", "<u4", {size("triangles", 0), 3}));
  const std::uint64_t count = size("components", 0), frames = size("weights", 0);
  if (reader.status().ok() && (c.nodes() == 0 || count == 0)) return Status::Corrupt(path + ": holds no components");
  const std::vector<float> dense = reader.Read<float>("components", "<f4", {count, c.nodes(), c.channels()});
  c.weights = reader.Read<float>("weights", "<f4", {frames, count});
  SAC_RETURN_IF_ERROR(reader.status());
  c.components = SparseOf(dense, count, c.nodes(), c.channels());
  c.track.resize(frames);
  ReadOptional(reader, c);
  return reader.status();
}

}  // namespace sac
