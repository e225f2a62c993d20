// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/encoded_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <utility>

#include "codec/decode/damage_policy.h"
#include "codec/decode/stream_start.h"
#include "codec/encode/contain.h"
#include "codec/encode/error_bound.h"
#include "codec/encode/i_frame_encoder.h"
#include "codec/encode/input_check.h"
#include "codec/encode/joined_mesh.h"
#include "codec/encode/part_scales.h"
#include "codec/encode/position_grid.h"
#include "codec/encode/quality.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/packet.h"
#include "geometry/coincident_vertices.h"

namespace sac {
namespace {

// The harmonics of a larger patch compress better but take a decoder longer to compute. Large meshes get small patches.
constexpr std::uint32_t kLargePatch = 200, kSmallPatch = 64, kLargePatchVertices = 50'000;

// Shares `wanted` harmonics among the components in proportion to their areas, which by Weyl's law bounds the
// eigenvalues equally. Each component gets at least one, for its translation. A component with a finer scale gets,
// beside those, what it would get if it were as much larger.
std::vector<std::uint32_t> ShareHarmonics(const DecodedMesh& mesh, std::uint32_t wanted) {
  PositionMatrix positions(static_cast<Eigen::Index>(mesh.grid.size()), 3);
  const auto factor = [&](std::size_t c) { return mesh.scales.empty() ? 1.0 : mesh.scales[c].factor(); };
  for (std::size_t c = 0; c < mesh.components.size(); ++c) {
    const Component& component = mesh.components[c];
    for (std::uint32_t v = component.first; v < component.first + component.count; ++v) {
      positions.row(v) << mesh.grid[v][0], mesh.grid[v][1], mesh.grid[v][2];
      positions.row(v) *= factor(c);
    }
  }
  const Eigen::VectorXd masses = VertexMasses(positions, mesh.triangles);
  const auto components = static_cast<double>(mesh.components.size());
  const double spare = std::max(0.0, static_cast<double>(wanted) - components);
  std::vector<std::uint32_t> counts;
  for (std::size_t i = 0; i < mesh.components.size(); ++i) {
    const Component& c = mesh.components[i];
    const double area = masses.segment(c.first, c.count).sum() / (factor(i) * factor(i));
    const double share = factor(i) < 1 ? area / (1 + area) : area;
    counts.push_back(std::min(c.count, 1 + static_cast<std::uint32_t>(std::floor(spare * share + 1e-9))));
  }
  return counts;
}

// How many handles each harmonic gets: `wanted`, but one at least, and no more than what keeps a component to
// kManyHandles of them. Few harmonics gain from several handles each, many do not, and the time of a frame grows with
// the handles.
std::uint32_t HandlesPerHarmonic(std::uint32_t wanted, std::span<const std::uint32_t> harmonics) {
  constexpr std::uint32_t kManyHandles = 800;
  const std::uint32_t most = *std::max_element(harmonics.begin(), harmonics.end());
  return std::min(wanted, std::max(1u, kManyHandles / most));
}

// Chooses the settings that the caller left open, by the quality or by the bound on the error. The steps of
// displacement and detail are fractions of the RMS radius `rms`, which is in model units.
Status ChooseDefaults(const Mesh& first, const EncoderSettings& settings, double rms, OperatingPoint& defaults) {
  if (!settings.max_error) {
    const double most = MostHarmonics(static_cast<std::uint32_t>(first.positions.size()));
    defaults = PointOfQuality(settings.quality, most, EdgeScaleOf(first, rms));
    return Status::Ok();
  }
  if (const double least = LeastMaxError(first.positions); *settings.max_error < least) {
    std::ostringstream message;
    message << "the largest error allowed, " << *settings.max_error
            << ", is below the precision of the coordinates; the smallest possible is " << least;
    return Status::InvalidArgument(message.str());
  }
  defaults = PointOfMaxError(*settings.max_error, first.positions, rms);
  return Status::Ok();
}

// The sequence header without the position grid and the number of harmonics, which are filled in later.
SequenceHeader HeaderOf(const Mesh& first, const EncoderSettings& settings, double rms,
                        const OperatingPoint& defaults) {
  SequenceHeader header;
  const double displacement_step = settings.displacement_step.value_or(defaults.displacement_step);
  if (settings.max_error) {
    header.correction_step = static_cast<float>(CorrectionStep(*settings.max_error, first.positions));
  }
  header.reference_shape = static_cast<std::uint8_t>(settings.reference_shape);
  header.level_growth = static_cast<std::uint8_t>(std::lround(64 * settings.level_growth));
  header.vertices = static_cast<std::uint32_t>(first.positions.size());
  header.triangles = static_cast<std::uint32_t>(first.triangles.size());
  header.frame_rate_numerator = settings.frame_rate_numerator;
  header.frame_rate_denominator = settings.frame_rate_denominator;
  header.motion_step = static_cast<float>(settings.motion_step.value_or(defaults.motion_step));
  header.displacement_step = static_cast<float>(displacement_step * rms);
  header.detail_step = static_cast<float>(settings.detail_step.value_or(defaults.detail_step) * rms);
  header.patch_size = header.vertices <= kLargePatchVertices ? kLargePatch : kSmallPatch;
  header.rotation_step = static_cast<float>(displacement_step);
  header.translation_step = header.displacement_step;
  header.offset_x = settings.offset[0];
  header.offset_y = settings.offset[1];
  header.offset_z = settings.offset[2];
  return header;
}

Status Progress(const EncoderSettings& settings) {
  return settings.progress && !settings.progress(0) ? Status::Cancelled() : Status::Ok();
}

// Finishes the I-frame of `mesh`, whose number of harmonics is in `syntax`: derives the shape, and writes the payload
// with the fingerprint of the harmonics. Returns kLimit when decoders with `limits` would refuse the I-frame.
Status FinishIFrame(DecodedMesh mesh, const Limits& limits, IFrameSyntax& syntax, EncodedStart& start) {
  // The fingerprint is not known yet, but the payload's size does not depend on it.
  const Limits of_i_frame = LimitsOfIFrame(limits, WriteIFrame(syntax, start.header).size());
  if (const Status status = BuildShape(start.header, std::move(mesh), syntax.harmonics, syntax.handles_per_harmonic,
                                       of_i_frame, start.shape);
      !status.ok()) {
    return status.code() == StatusCode::kLimit ? Status::Limit(status.message() + " of decoders") : status;
  }
  syntax.fingerprint = Fingerprint(start.shape.basis, start.shape.patch_basis);
  start.i_frame = WriteIFrame(syntax, start.header);
  return Status::Ok();
}

// The reach of each joined vertex, where it is known.
std::vector<float> ReachOf(const JoinedMesh& input, std::span<const float> reach, const EncoderSettings& settings) {
  std::vector<float> joined;
  if (reach.empty() && !settings.reach) return joined;
  joined.resize(input.mesh.positions.size(), reach.empty() ? static_cast<float>(*settings.reach) : 0);
  for (std::size_t i = 0; i < reach.size(); ++i) {
    float& of_vertex = joined[input.vertex_of_author[i]];
    of_vertex = std::max(of_vertex, reach[i]);
  }
  return joined;
}

bool HasAttributes(const JoinedMesh& input) {
  return !input.mesh.uvs.empty() || !input.mesh.normals.empty() || !input.colors.empty();
}

// EncodeStart() with the fraction `share` of the harmonics that the quality stands for. Becomes kUnsupported, and
// nothing is coded, when attributes would be lost because vertices are joined.
// `reach` is that of the joined vertices; empty where it is not known.
Status EncodeStart(const JoinedMesh& input, std::span<const float> reach, const EncoderSettings& settings, double share,
                   EncodedStart& start) {
  const Mesh& first = input.mesh;
  start = {};
  SAC_RETURN_IF_ERROR(Progress(settings));
  OperatingPoint defaults{};
  const double rms = RmsRadius(first.positions);
  SAC_RETURN_IF_ERROR(ChooseDefaults(first, settings, rms, defaults));
  start.header = HeaderOf(first, settings, rms, defaults);
  start.header.copies = static_cast<std::uint32_t>(input.authors() - first.positions.size());
  start.max_error = settings.max_error.value_or(0);
  start.groups = {settings.group, settings.pyramid, settings.base_levels};

  // A bound on the error is one for all parts.
  MeshParts parts;
  if (!reach.empty() && !settings.max_error) {
    parts = FindParts(first, rms, static_cast<double>(start.header.displacement_step), reach);
  }
  PositionTargets targets;
  SAC_RETURN_IF_ERROR(ChooseGrid(first, settings.position_bits.value_or(defaults.position_bits), !settings.max_error,
                                 start.header, parts, targets));
  IFrameSyntax syntax;
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(EncodeIFrameMesh(input, targets, start.header, syntax, decoded, start.order));
  if (input.is_joined() && syntax.mesh.empty() && HasAttributes(input)) {
    return Status::Unsupported("attributes of joined vertices");
  }
  syntax.scales = decoded.mesh.scales = ScalesOf(parts, input, decoded.mesh, start.order);
  syntax.harmonics = ShareHarmonics(
      decoded.mesh, settings.harmonics.value_or(static_cast<std::uint32_t>(std::lround(share * defaults.harmonics))));
  syntax.handles_per_harmonic = HandlesPerHarmonic(settings.handles_per_harmonic, syntax.harmonics);
  if (settings.keep_order) syntax.order = start.order;
  for (const std::uint32_t count : syntax.harmonics) start.header.harmonics += count;
  SequenceHeader parsed;
  if (const Status status = ParseSequenceHeader(WriteSequenceHeader(start.header), settings.limits, parsed);
      !status.ok()) {
    return Status::InvalidArgument(status.message());  // such as a step that no float can hold
  }
  SAC_RETURN_IF_ERROR(Progress(settings));
  return FinishIFrame(std::move(decoded.mesh), settings.limits, syntax, start);
}

// Takes the next packet from the front of `bytes`. Returns kCorrupt when it is not complete or not of
// the type `type`.
Status NextPacket(PacketReader& reader, PacketType type, std::span<const std::uint8_t>& bytes, Packet& packet) {
  std::optional<Packet> next;
  SAC_RETURN_IF_ERROR(reader.Read(bytes, next));
  if (!next || next->type != type) return Status::Corrupt("stream start: no header and I-frame");
  packet = std::move(*next);
  return Status::Ok();
}

// Reads the part of a start that follows the I-frame: bound, order and CRC-32.
Status ReadEncoderPart(std::span<const std::uint8_t> bytes, EncodedStart& start) {
  constexpr std::size_t kBound = 8, kIndex = 4, kGroups = 12, kCrc = 4;
  const auto vertices = static_cast<std::size_t>(start.header.given_out());
  if (bytes.size() != kBound + kIndex * vertices + kGroups + kCrc) return Status::Corrupt("stream start: length");
  ByteReader reader(bytes);
  start.max_error = reader.F64();
  start.order.resize(vertices);
  for (std::uint32_t& i : start.order) i = reader.U32();
  for (std::uint32_t* setting : {&start.groups.group, &start.groups.pyramid, &start.groups.base_levels}) {
    *setting = reader.U32();
  }
  if (reader.U32() != Crc32(bytes.first(bytes.size() - kCrc))) return Status::Corrupt("stream start: wrong CRC-32");
  if (!IsPermutation(start.order)) return Status::Corrupt("stream start: the vertex order is no permutation");
  const GroupStructureSettings& groups = start.groups;
  if (groups.group == 0 || groups.group > Limits{}.expert.frames_per_group || groups.pyramid == 0 ||
      (groups.base_levels > 0 && start.header.references_previous())) {
    return Status::Corrupt("stream start: settings of groups out of range");
  }
  const bool is_bounded = start.header.correction_step > 0;
  if (!std::isfinite(start.max_error) || (is_bounded ? start.max_error <= 0 : start.max_error != 0)) {
    return Status::Corrupt("stream start: a bound on the error that is not the header's");
  }
  return Status::Ok();
}

}  // namespace

Status EncodeStart(const Mesh& first, const EncoderSettings& settings, EncodedStart& start,
                   std::span<const std::uint32_t> lowest, std::span<const float> reach) {
  SAC_RETURN_IF_ERROR(CheckSettings(settings));
  SAC_RETURN_IF_ERROR(CheckMesh(first, settings.limits));
  SAC_RETURN_IF_ERROR(CheckFinite(first.positions));
  SAC_RETURN_IF_ERROR(CheckJoining(lowest, first.positions.size()));
  if (!reach.empty() && reach.size() != first.positions.size()) {
    return Status::InvalidArgument("the reach of some vertices only");
  }
  CoincidentVertices coincident;
  if (lowest.empty() && settings.join.value_or(false)) coincident.Add(first.positions);
  const std::vector<std::uint32_t> found = coincident.Lowest();
  JoinedMesh input = JoinVertices(first, lowest.empty() ? std::span(found) : lowest);
  // Decoders allow less work for a small I-frame, so a large mesh with a small I-frame may get fewer harmonics.
  constexpr double kFewer = 0.9, kFewest = 0.1;
  for (double share = 1;; share *= kFewer) {
    Status status =
        Contain([&] { return EncodeStart(input, ReachOf(input, reach, settings), settings, share, start); });
    if (status.code() == StatusCode::kUnsupported && input.is_joined()) {
      input = JoinVertices(first, {});
      status = Contain([&] { return EncodeStart(input, ReachOf(input, reach, settings), settings, share, start); });
    }
    if (status.code() != StatusCode::kLimit || settings.harmonics || share < kFewest) return status;
  }
}

std::vector<std::uint8_t> WriteStreamStart(const EncodedStart& start) {
  ByteWriter out;
  out.Bytes(kMagic);
  out.Bytes(WritePacket(PacketType::kHeader, WriteSequenceHeader(start.header)));
  out.Bytes(WritePacket(PacketType::kIFrame, start.i_frame));
  const std::size_t begin = out.size();
  out.F64(start.max_error);
  for (const std::uint32_t i : start.order) out.U32(i);
  for (const std::uint32_t i : {start.groups.group, start.groups.pyramid, start.groups.base_levels}) out.U32(i);
  out.U32(Crc32(std::span(out.bytes()).subspan(begin)));
  return std::move(out.bytes());
}

std::uint32_t FullGroup(const EncodedStart& start, const Limits& limits) {
  const std::uint64_t most =
      MaxGroupValues(limits, start.shape) / std::max<std::uint64_t>(1, FrameValues(start.shape.layouts));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most, 1, start.groups.group));
}

Status ReadStreamStart(std::span<const std::uint8_t> bytes, const Limits& limits, EncodedStart& start) {
  start = {};
  PacketReader packets(limits);
  Packet packet;
  const DamagePolicy strict(false);
  StreamStart decoded(limits, strict);
  SAC_RETURN_IF_ERROR(NextPacket(packets, PacketType::kHeader, bytes, packet));
  SAC_RETURN_IF_ERROR(decoded.TakeHeader(packet.payload));
  SAC_RETURN_IF_ERROR(NextPacket(packets, PacketType::kIFrame, bytes, packet));
  start.header = *decoded.header();
  SAC_RETURN_IF_ERROR(ReadEncoderPart(bytes, start));  // before the shape is built, which takes longer
  SAC_RETURN_IF_ERROR(decoded.TakeIFrame(packet.payload, true));
  SAC_RETURN_IF_ERROR(decoded.Prepare());
  if (!decoded.order().empty() && decoded.order() != start.order) {
    return Status::Corrupt("stream start: a vertex order that is not the I-frame's");
  }
  start.i_frame = std::move(packet.payload);
  start.shape = std::move(decoded.shape());
  return Status::Ok();
}

}  // namespace sac
