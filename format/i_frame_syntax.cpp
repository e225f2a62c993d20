// SPDX-License-Identifier: Apache-2.0
#include "format/i_frame_syntax.h"

#include <bit>
#include <cstddef>
#include <string>

#include "format/bytes.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"

namespace sac {
namespace {

template <class Coder>
void CodeFlag(Coder& coder, bool& flag) {
  std::uint32_t bit = flag;
  coder.Raw(bit, 1);
  flag = bit != 0;
}

template <class Coder>
void CodeFloat(Coder& coder, float& value) {
  auto bits = std::bit_cast<std::uint32_t>(value);
  coder.Raw(bits, 32);
  value = std::bit_cast<float>(bits);
}

// Calls `code` for each element of a list of at most `limit`; a decoder appends as it reads, so that a false length
// costs no memory. False when the length or the code is malformed.
template <class Coder, class T, class F>
bool CodeList(Coder& coder, std::vector<T>& list, std::uint64_t limit, F&& code) {
  UnsignedModels size_models;
  auto size = static_cast<std::uint32_t>(list.size());
  CodeUnsigned(coder, size_models, size);
  if (size > limit) return false;
  for (std::uint32_t i = 0; i < size; ++i) {
    if constexpr (Coder::kDecodes) list.emplace_back();
    if (!code(list[i]) || !coder.ok()) return false;
  }
  return true;
}

// A value below `end`, coded by its difference to `expected`.
template <class Coder>
bool CodeNear(Coder& coder, SignedModels& models, std::uint32_t expected, std::uint32_t end, std::uint32_t& value) {
  auto difference = static_cast<std::int32_t>(static_cast<std::int64_t>(value) - expected);
  CodeSigned(coder, models, difference);
  const std::int64_t sum = static_cast<std::int64_t>(expected) + difference;
  if (sum < 0 || sum >= end) return false;
  value = static_cast<std::uint32_t>(sum);
  return true;
}

// The functions below are one body for both directions (spec.md 5.2). They return false when an element is malformed.

template <class Coder>
bool CodeWelds(Coder& coder, const SequenceHeader& header, std::vector<Weld>& welds) {
  UnsignedModels gap, back;
  std::uint32_t next = 1;  // the smallest point that can be welded
  const std::uint64_t points = 3 * static_cast<std::uint64_t>(header.triangles);
  return CodeList(coder, welds, points, [&](Weld& w) {
    std::uint32_t skip = w.point - next, distance = w.point - w.onto - 1;
    CodeUnsigned(coder, gap, skip);
    CodeUnsigned(coder, back, distance);
    const std::uint64_t point = static_cast<std::uint64_t>(next) + skip;
    if (point >= points || distance >= point) return false;
    w = {static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(point) - distance - 1};
    next = w.point + 1;
    return true;
  });
}

template <class Coder>
bool CodeLooseVertices(Coder& coder, const SequenceHeader& header, IFrameSyntax& s) {
  const std::uint32_t grid = 1u << header.position_bits;
  SignedModels coordinate[3];
  GridPosition last = {};
  return CodeList(coder, s.loose_vertices, header.vertices, [&](LooseVertex& v) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (!CodeNear(coder, coordinate[a], last[a], grid, v.position[a])) return false;
    }
    last = v.position;
    if (s.has_normals) {
      for (float& f : v.normal) CodeFloat(coder, f);
    }
    if (s.has_colors) {
      for (std::uint8_t& c : v.color) {
        std::uint32_t wide = c;
        coder.Raw(wide, 8);
        c = static_cast<std::uint8_t>(wide);
      }
    }
    return true;
  });
}

template <class Coder>
bool CodeLooseTriangles(Coder& coder, const SequenceHeader& header, std::vector<Triangle>& triangles) {
  SignedModels corner;
  std::uint32_t near = 0;
  return CodeList(coder, triangles, header.triangles, [&](Triangle& t) {
    for (std::uint32_t& v : t) {
      if (!CodeNear(coder, corner, near, header.vertices, v)) return false;
      near = v;
    }
    return true;
  });
}

template <class Coder>
bool CodeHarmonics(Coder& coder, const SequenceHeader& header, std::vector<std::uint32_t>& harmonics) {
  SignedModels models;
  std::uint32_t count = header.harmonics;
  std::uint64_t total = 0;
  const bool good = CodeList(coder, harmonics, header.vertices, [&](std::uint32_t& h) {
    const std::uint32_t expected = count;
    if (!CodeNear(coder, models, expected, header.harmonics + 1, h) || h == 0) return false;
    count = h;
    total += h;
    return total <= header.harmonics;
  });
  return good && total == header.harmonics;
}

template <class Coder>
bool CodeScales(Coder& coder, const SequenceHeader& header, std::size_t components, std::vector<PartScale>& scales) {
  bool has_scales = !scales.empty();
  CodeFlag(coder, has_scales);
  if (!has_scales) return true;
  scales.resize(components);
  UnsignedModels models;
  for (PartScale& scale : scales) {
    CodeUnsigned(coder, models, scale.exponent);
    if (scale.exponent > kMaxPartExponent || !coder.ok()) return false;
    if (scale.exponent == 0) continue;
    for (std::uint32_t& x : scale.origin) coder.Raw(x, header.position_bits);
  }
  return true;
}

template <class Coder>
bool CodeOrder(Coder& coder, const SequenceHeader& header, std::vector<std::uint32_t>& order) {
  SignedModels step;
  std::uint32_t expected = 0;
  const auto count = static_cast<std::uint32_t>(header.given_out());
  for (std::uint32_t i = 0; i < count; ++i) {
    if constexpr (Coder::kDecodes) order.emplace_back();
    if (!CodeNear(coder, step, expected, count, order[i]) || !coder.ok()) return false;
    expected = order[i] + 1 < count ? order[i] + 1 : 0;
  }
  return true;
}

// Codes all side information. Returns the name of the malformed element or null.
template <class Coder>
const char* CodeSide(Coder& coder, const SequenceHeader& header, IFrameSyntax& s) {
  if (!s.mesh.empty()) {
    UnsignedModels step, slope;
    CodeUnsigned(coder, step, s.position_step);
    CodeUnsigned(coder, slope, s.position_slope);
  }
  if (!CodeWelds(coder, header, s.welds)) return "welds";
  CodeFlag(coder, s.has_normals);
  CodeFlag(coder, s.has_colors);
  if (!CodeLooseVertices(coder, header, s)) return "loose vertices";
  if (!CodeLooseTriangles(coder, header, s.loose_triangles)) return "loose triangles";
  if (!CodeHarmonics(coder, header, s.harmonics)) return "harmonics per component";
  if (!CodeScales(coder, header, s.harmonics.size(), s.scales)) return "scales of components";
  UnsignedModels samples;
  CodeUnsigned(coder, samples, s.handles_per_harmonic);
  for (float& f : s.fingerprint) CodeFloat(coder, f);
  bool keeps_order = !s.order.empty();
  CodeFlag(coder, keeps_order);
  if (!keeps_order) return coder.ok() ? nullptr : "length";
  return CodeOrder(coder, header, s.order) ? nullptr : "order";
}

}  // namespace

bool IsPermutation(const std::vector<std::uint32_t>& order) {
  std::vector<bool> seen(order.size());
  for (const std::uint32_t i : order) {
    if (i >= seen.size() || seen[i]) return false;
    seen[i] = true;
  }
  return true;
}

std::vector<std::uint8_t> WriteIFrame(const IFrameSyntax& syntax, const SequenceHeader& header) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(syntax.mesh.size()));
  out.Bytes(syntax.mesh);
  RangeEncoder coder;
  IFrameSyntax copy = syntax;  // the shared body takes its elements by reference
  CodeSide(coder, header, copy);
  syntax.positions.WriteTo(coder);
  out.Bytes(coder.Finish());
  return std::move(out.bytes());
}

Status ParseIFrame(std::span<const std::uint8_t> payload, const SequenceHeader& header, IFrameSyntax& syntax,
                   RangeDecoder& positions) {
  syntax = {};
  ByteReader reader(payload);
  const auto mesh = reader.Bytes(reader.Varint());
  if (!reader.ok()) return Status::Corrupt("I-frame: truncated mesh");
  syntax.mesh.assign(mesh.begin(), mesh.end());
  positions = RangeDecoder(payload.subspan(reader.position()));
  if (const char* element = CodeSide(positions, header, syntax)) {
    return Status::Corrupt(std::string("I-frame: malformed ") + element);
  }
  if (!IsPermutation(syntax.order)) return Status::Corrupt("I-frame: the vertex order is no permutation");
  return Status::Ok();
}

}  // namespace sac
