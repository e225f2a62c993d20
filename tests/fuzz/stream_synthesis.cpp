// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/stream_synthesis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/i_frame.h"
#include "codec/shape.h"
#include "format/bytes.h"
#include "format/frame_coder.h"
#include "format/group.h"
#include "format/i_frame_syntax.h"
#include "format/range_coder.h"
#include "geometry/components.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/join_packets.h"

namespace sac {
namespace {

constexpr std::uint32_t kMaxPyramid = (1u << 30) - 1;

// Of any magnitude, small ones more often.
std::uint32_t AnySize(std::mt19937& random) { return static_cast<std::uint32_t>(random() >> random() % 32); }

float AnyStep(std::mt19937& random) { return std::ldexp(1.0f, static_cast<int>(random() % 200) - 100); }

void MutateHeader(SequenceHeader& h, std::mt19937& random) {
  switch (random() % 9) {
    case 0:
      h.reference_shape ^= 1;
      break;
    case 1:
      h.level_growth = static_cast<std::uint8_t>(64 + random() % 65);
      break;
    case 2:
      h.patch_size = 1 + random() % 64;
      break;
    case 3:
      h.detail_step = random() % 2 ? 0 : AnyStep(random);
      break;
    case 4:
      h.correction_step = random() % 2 ? 0 : AnyStep(random);
      break;
    case 5:
      h.cell = AnyStep(random);
      break;
    case 6:
      h.position_bits = static_cast<std::uint8_t>(1 + random() % 24);
      break;
    case 7:
      h.offset_x = random() % 2 ? 0 : static_cast<double>(AnyStep(random));
      break;
    default:
      (random() % 2 ? h.motion_step : h.displacement_step) = AnyStep(random);
  }
}

void MutateIFrameSyntax(IFrameSyntax& s, const SequenceHeader& h, std::mt19937& random) {
  const std::uint32_t grid = 1u << h.position_bits;
  const auto corner = [&] { return static_cast<std::uint32_t>(random() % h.vertices); };
  switch (random() % 7) {
    case 5:
      s.scales.assign(s.harmonics.size(), {});
      for (PartScale& scale : s.scales) {
        scale.exponent = random() % (kMaxPartExponent + 1);
        for (std::uint32_t& x : scale.origin) x = scale.exponent > 0 ? random() % grid : 0;
      }
      break;
    case 0:  // a vertex more, or another place
      if (s.loose_vertices.empty() || random() % 2) s.loose_vertices.emplace_back();
      for (std::uint32_t& x : s.loose_vertices[random() % s.loose_vertices.size()].position) x = random() % grid;
      break;
    case 1:
      if (!s.loose_vertices.empty()) s.loose_vertices.pop_back();
      break;
    case 2:
      for (std::size_t i = random() % 20; i > 0; --i) s.loose_triangles.push_back({corner(), corner(), corner()});
      break;
    case 3:
      if (!s.loose_triangles.empty()) s.loose_triangles[random() % s.loose_triangles.size()][random() % 3] = corner();
      break;
    case 4:
      s.handles_per_harmonic = random() % 2 ? random() % 4 : AnySize(random);
      break;
    default:
      (random() % 2 ? s.position_step : s.position_slope) = AnySize(random);
  }
}

// Harmonics for each component of the mesh, whatever there were.
void ShareHarmonics(const DecodedMesh& mesh, SequenceHeader& h, IFrameSyntax& s, std::mt19937& random) {
  s.harmonics.clear();
  h.harmonics = 0;
  for (const Component& c : mesh.components) {
    s.harmonics.push_back(1 + random() % std::min(c.count, 20u));
    h.harmonics += s.harmonics.back();
  }
}

std::int32_t AnyResidual(std::mt19937& random, std::int32_t most) {
  const auto magnitude = static_cast<std::int32_t>(AnySize(random) >> 1);
  return random() % 2 ? std::min(magnitude, most) : -std::min(magnitude, most);
}

void FillFrame(FrameSyntax& frame, std::uint32_t index, bool previous, std::mt19937& random) {
  if (index > 0 && random() % 3 == 0) {
    frame.slot.references.resize(previous ? 0 : random() % 3);
    for (std::uint32_t& r : frame.slot.references) r = random() % index;
  }
  if (random() % 2) {
    for (std::int32_t& r : frame.rigid) r = AnyResidual(random, kMaxCoefficient);
  }
  for (PlaneValues& plane : frame.planes) {
    if (plane.empty() || random() % 3 == 0) continue;
    for (std::size_t i = 1 + random() % 8; i > 0; --i) {
      plane[random() % plane.size()] = AnyResidual(random, kMaxResidual);
    }
  }
}

Bytes AnyGroup(const SequenceHeader& h, const PlaneLayouts& layouts, std::uint32_t first, std::uint32_t frames,
               std::uint32_t segment, std::mt19937& random) {
  const bool previous = h.references_previous();
  const std::uint32_t pyramid = previous ? 1 : 1 + AnySize(random) / 2;
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(h, layouts);
  std::uint32_t index = 0;
  for (const FrameSlot& slot : GroupStructure(frames, pyramid)) {
    FrameSyntax frame;
    frame.slot = slot;
    frame.planes = EmptyPlanes(layouts);
    FillFrame(frame, index++, previous, random);
    if (!coder.Code(range, slot, frame)) break;
  }
  return WriteGroup({frames, first, std::min(pyramid, kMaxPyramid), segment}, range.Finish());
}

// A layered group as packets, of which some may be missing at the end.
std::vector<Packet> AnyLayeredGroup(const SequenceHeader& h, const PlaneLayouts& layouts, GroupSyntax group,
                                    std::mt19937& random) {
  group.pyramid = 1 + random() % 16;
  group.base_levels = 1 + random() % 4;
  const std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(group.frames, group.pyramid), group.base_levels);
  std::vector<FrameSyntax> frames;
  for (const FrameSlot& slot : slots) {
    frames.push_back({slot, {}, EmptyPlanes(layouts)});
    FillFrame(frames.back(), static_cast<std::uint32_t>(frames.size() - 1), false, random);
  }
  FrameCoder<RangeEncoder> coder(h, layouts);
  std::vector<Packet> packets;
  for (const GroupLayer& layer : LayersOf(slots, group.base_levels, layouts)) {
    RangeEncoder range;
    bool good = true;
    for (std::size_t i = layer.first; i < layer.end && good; ++i) {
      good = layer.has_frames() ? coder.CodeBase(range, slots[i], frames[i])
                                : coder.CodeLater(range, i, layer.plane, frames[i]);
    }
    const auto number = static_cast<std::uint32_t>(packets.size());
    const Bytes code = range.Finish();
    packets.push_back(number == 0 ? Packet{PacketType::kGroup, WriteGroup(group, code)}
                                  : Packet{PacketType::kLayer, WriteLayer({group.first_frame, number}, code)});
    if (!good || random() % 8 == 0) break;
  }
  return packets;
}

// Appends groups of any kind, in one segment or several, to the start `made`. Returns the number of their frames.
std::uint32_t AppendGroups(SequenceHeader h, const PlaneLayouts& layouts, std::vector<Packet>& made,
                           std::mt19937& random) {
  std::uint32_t total = 0;
  std::uint32_t segment = 0;
  for (std::size_t i = random() % 4; i > 0; --i) {
    const std::uint32_t frames = 1 + random() % 9;
    if (random() % 4 == 0) {  // the same mesh moves otherwise
      h.level_growth = static_cast<std::uint8_t>(64 + random() % 65);
      made.push_back({PacketType::kHeader, WriteSequenceHeader(h)});
      made.push_back(made[1]);
      ++segment;
    }
    if (!h.references_previous() && random() % 3 == 0) {
      GroupSyntax group;
      group.frames = frames;
      group.first_frame = total;
      group.segment = segment;
      for (Packet& packet : AnyLayeredGroup(h, layouts, group, random)) made.push_back(std::move(packet));
    } else {
      made.push_back({PacketType::kGroup, AnyGroup(h, layouts, total, frames, segment, random)});
    }
    total += frames;
  }
  return total;
}

}  // namespace

bool Resynthesize(std::vector<Packet>& packets, std::mt19937& random) {
  if (packets.size() < 2 || packets[0].type != PacketType::kHeader || packets[1].type != PacketType::kIFrame) {
    return false;
  }
  const Limits limits = FuzzLimits();
  SequenceHeader h;
  IFrameSyntax s;
  if (!ParseSequenceHeader(packets[0].payload, limits, h).ok() || !ReadIFrame(packets[1].payload, h, s).ok()) {
    return false;
  }
  for (std::size_t i = random() % 4; i > 0; --i) MutateHeader(h, random);
  for (std::size_t i = random() % 4; i > 0; --i) MutateIFrameSyntax(s, h, random);
  s.order.clear();

  DracoMesh draco;
  if (!DecodeDraco(s.mesh, h, draco).ok()) return false;
  h.vertices = static_cast<std::uint32_t>(draco.entries - std::min<std::size_t>(s.welds.size(), draco.entries) +
                                          s.loose_vertices.size());
  h.triangles = static_cast<std::uint32_t>(draco.triangles.size() + s.loose_triangles.size());
  if (h.vertices == 0 || h.vertices > limits.vertices || h.triangles > limits.expert.triangles) return false;
  for (auto& t : s.loose_triangles) {
    for (std::uint32_t& v : t) v %= h.vertices;
  }
  for (LooseVertex& v : s.loose_vertices) {
    for (std::uint32_t& x : v.position) x &= (1u << h.position_bits) - 1;
  }
  DecodedIFrame decoded;
  if (!AssembleIFrame(s, h, std::move(draco), decoded).ok()) return false;
  ShareHarmonics(decoded.mesh, h, s, random);
  Shape shape;
  if (!BuildShape(h, std::move(decoded.mesh), s.harmonics, s.handles_per_harmonic, limits, shape).ok()) return false;
  s.fingerprint = Fingerprint(shape.basis, shape.patch_basis);

  std::vector<Packet> made = {{PacketType::kHeader, WriteSequenceHeader(h)}, {PacketType::kIFrame, WriteIFrame(s, h)}};
  const std::uint32_t total = AppendGroups(h, shape.layouts, made, random);
  ByteWriter end;
  end.Varint(total);
  made.push_back({PacketType::kEnd, end.bytes()});
  packets = std::move(made);
  return true;
}

}  // namespace sac
