// SPDX-License-Identifier: Apache-2.0
#include "format/metadata.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "format/bytes.h"

namespace sac {
namespace {

enum Key : std::uint32_t { kName = 1, kUnit, kUpAxis, kFirstFrame, kLoops, kJson, kBounds, kGroupBounds };

void Put(ByteWriter& out, Key key, std::span<const std::uint8_t> value) {
  out.Varint(key);
  out.Varint(static_cast<std::uint32_t>(value.size()));
  out.Bytes(value);
}

void Put(ByteWriter& out, Key key, const std::string& text) {
  if (!text.empty()) Put(out, key, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string Text(std::span<const std::uint8_t> value) { return {value.begin(), value.end()}; }

Status TakeBounds(std::span<const std::uint8_t> value, Metadata& metadata) {
  ByteReader in(value);
  Box box;
  for (auto* corner : {&box.low, &box.high}) {
    for (double& coordinate : *corner) coordinate = static_cast<double>(in.F32());
  }
  bool good = in.ok() && in.remaining() == 0;
  for (std::size_t a = 0; a < 3; ++a) {
    good = good && std::isfinite(box.low[a]) && std::isfinite(box.high[a]) && box.low[a] <= box.high[a];
  }
  if (!good) return Status::Corrupt("metadata: bounds");
  metadata.bounds = box;
  return Status::Ok();
}

Status TakeEntry(std::uint32_t key, std::span<const std::uint8_t> value, Metadata& metadata) {
  ByteReader in(value);
  const auto is_small = [&](std::uint8_t most) { return value.size() == 1 && value[0] <= most; };
  switch (key) {
    case kName:
      metadata.name = Text(value);
      return Status::Ok();
    case kUnit: {
      const double metres = in.F64();
      if (value.size() != 8 || !std::isfinite(metres) || metres <= 0) return Status::Corrupt("metadata: unit");
      metadata.metres_per_unit = metres;
      return Status::Ok();
    }
    case kUpAxis:
      if (!is_small(2)) return Status::Corrupt("metadata: up axis");
      metadata.up_axis = value[0];
      return Status::Ok();
    case kFirstFrame:
      if (value.size() != 4) return Status::Corrupt("metadata: first frame");
      metadata.first_frame = static_cast<std::int32_t>(in.U32());
      return Status::Ok();
    case kLoops:
      if (!is_small(1)) return Status::Corrupt("metadata: loop");
      metadata.loops = value[0] == 1;
      return Status::Ok();
    case kJson:
      metadata.json = Text(value);
      return Status::Ok();
    case kBounds:
      return TakeBounds(value, metadata);
    case kGroupBounds:
      if (value.size() % 6 != 0) return Status::Corrupt("metadata: bounds of groups");
      metadata.group_bounds.resize(value.size() / 6);
      for (std::size_t i = 0; i < value.size(); ++i) metadata.group_bounds[i / 6][i % 6] = value[i];
      return Status::Ok();
    default:
      return Status::Ok();
  }
}

}  // namespace

std::vector<std::uint8_t> WriteMetadata(const Metadata& metadata) {
  ByteWriter out;
  Put(out, kName, metadata.name);
  ByteWriter value;
  const auto put = [&](Key key) {
    Put(out, key, value.bytes());
    value = {};
  };
  if (metadata.metres_per_unit) {
    value.F64(*metadata.metres_per_unit);
    put(kUnit);
  }
  if (metadata.up_axis) {
    value.U8(*metadata.up_axis);
    put(kUpAxis);
  }
  if (metadata.first_frame) {
    value.U32(static_cast<std::uint32_t>(*metadata.first_frame));
    put(kFirstFrame);
  }
  if (metadata.loops) {
    value.U8(*metadata.loops ? 1 : 0);
    put(kLoops);
  }
  Put(out, kJson, metadata.json);
  if (metadata.bounds) {
    for (const auto& corner : {metadata.bounds->low, metadata.bounds->high}) {
      for (const double coordinate : corner) value.F32(static_cast<float>(coordinate));
    }
    put(kBounds);
  }
  if (!metadata.group_bounds.empty()) {
    for (const auto& box : metadata.group_bounds) value.Bytes(box);
    put(kGroupBounds);
  }
  return std::move(out.bytes());
}

Status ParseMetadata(std::span<const std::uint8_t> payload, Metadata& metadata) {
  Metadata parsed = metadata;
  ByteReader in(payload);
  std::uint32_t before = 0;
  while (in.remaining() > 0) {
    const std::uint32_t key = in.Varint(), size = in.Varint();
    const std::span<const std::uint8_t> value = in.Bytes(size);
    if (!in.ok() || key <= before) return Status::Corrupt("metadata: malformed");
    SAC_RETURN_IF_ERROR(TakeEntry(key, value, parsed));
    before = key;
  }
  metadata = std::move(parsed);
  return Status::Ok();
}

std::array<std::uint8_t, 6> InBounds(const Box& box, const Box& bounds) {
  std::array<std::uint8_t, 6> out = {};
  for (std::size_t a = 0; a < 3; ++a) {
    const double size = bounds.size()[a], scale = size > 0 ? 255 / size : 0;
    out[a] = static_cast<std::uint8_t>(std::clamp(std::floor((box.low[a] - bounds.low[a]) * scale), 0.0, 255.0));
    out[a + 3] = static_cast<std::uint8_t>(std::clamp(std::ceil((box.high[a] - bounds.low[a]) * scale), 0.0, 255.0));
  }
  return out;
}

}  // namespace sac
