// SPDX-License-Identifier: Apache-2.0
#include "sac/encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "codec/encode/error_bound.h"
#include "codec/encode/group_encoder.h"
#include "codec/encode/i_frame_encoder.h"
#include "codec/encode/position_grid.h"
#include "codec/encode/quality.h"
#include "codec/shape.h"
#include "format/frame_coder.h"
#include "format/group_structure.h"
#include "format/stream_writer.h"

namespace sac {
namespace {

// A patch's harmonics compress the better the larger it is, and start the slower.
constexpr std::uint32_t kLargePatch = 200, kSmallPatch = 64, kLargePatchVertices = 50'000;

Status CheckSettings(const EncoderSettings& s) {
  const auto positive = [](const std::optional<double>& v) { return !v || (std::isfinite(*v) && *v > 0); };
  if (!(s.quality >= 0 && s.quality <= 100)) return Status::InvalidArgument("quality must be from 0 to 100");
  if (s.harmonics && *s.harmonics == 0) return Status::InvalidArgument("at least one harmonic is needed");
  if (s.samples_per_harmonic > 64) return Status::InvalidArgument("a reduced basis has at most 64 samples a harmonic");
  if (s.group == 0 || s.group > s.limits.expert.frames_per_group) {
    return Status::InvalidArgument("a group holds from 1 to " + std::to_string(s.limits.expert.frames_per_group) +
                                   " frames");
  }
  if (s.pyramid == 0) return Status::InvalidArgument("a pyramid holds at least one frame");
  if (!(s.level_growth >= 1 && s.level_growth <= 2)) {
    return Status::InvalidArgument("the growth of steps from level to level must be from 1 to 2");
  }
  if (!positive(s.motion_step)) return Status::InvalidArgument("the motion step must be positive");
  if (!positive(s.displacement_step)) return Status::InvalidArgument("the displacement step must be positive");
  if (s.detail_step && !(std::isfinite(*s.detail_step) && *s.detail_step >= 0)) {
    return Status::InvalidArgument("the detail step must not be negative");
  }
  if (!positive(s.max_error)) return Status::InvalidArgument("the largest error must be positive");
  if (s.position_bits && !(*s.position_bits >= 1 && *s.position_bits <= 24)) {
    return Status::InvalidArgument("position bits must be from 1 to 24");
  }
  if (s.frame_rate_denominator == 0) return Status::InvalidArgument("the frame rate's denominator is zero");
  return Status::Ok();
}

Status CheckMesh(const Mesh& mesh, const Limits& limits) {
  const std::size_t n = mesh.positions.size();
  if (n == 0) return Status::InvalidArgument("the mesh has no vertices");
  if (n > limits.vertices || mesh.triangles.size() > limits.expert.triangles) {
    return Status::Limit("the mesh has more than " + std::to_string(limits.vertices) + " vertices or " +
                         std::to_string(limits.expert.triangles) + " triangles");
  }
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= n) return Status::InvalidArgument("a triangle of a missing vertex");
  }
  if (!mesh.uv_triangles.empty() && mesh.uv_triangles.size() != mesh.triangles.size()) {
    return Status::InvalidArgument("texture coordinates for some triangles only");
  }
  for (const Triangle& t : mesh.uv_triangles) {
    if (std::max({t[0], t[1], t[2]}) >= mesh.uvs.size()) {
      return Status::InvalidArgument("a corner of a missing texture coordinate");
    }
  }
  if ((!mesh.normals.empty() && mesh.normals.size() != n) || (!mesh.colors.empty() && mesh.colors.size() != n)) {
    return Status::InvalidArgument("normals or colours for some vertices only");
  }
  // Draco ends the program when what it quantizes has no finite extent.
  const auto moderate = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](const auto& value) {
      return std::all_of(value.begin(), value.end(), [](float x) { return std::abs(x) <= 1e37f; });
    });
  };
  if (!moderate(mesh.uvs)) return Status::InvalidArgument("texture coordinates beyond 1e37, or not numbers");
  if (!moderate(mesh.normals)) return Status::InvalidArgument("normals beyond 1e37, or not numbers");
  return Status::Ok();
}

Status CheckFinite(std::span<const Vec3f> positions) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (const float x : positions[v]) {
      if (!std::isfinite(x)) return Status::InvalidArgument("vertex " + std::to_string(v) + ": not a finite number");
    }
  }
  return Status::Ok();
}

double RmsRadius(const Positions& positions) {
  std::array<double, 3> sum{};
  double squares = 0;
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<double>(p[a]);
  }
  const auto n = static_cast<double>(positions.size());
  for (const Vec3f& p : positions) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = static_cast<double>(p[a]) - sum[a] / n;
      squares += d * d;
    }
  }
  // A single point has no size of its own; how far it is from the origin tells most about how far it may go.
  const double radius = std::sqrt(squares / n), largest = LargestCoordinate(positions);
  if (radius > 1e-7 * largest) return radius;
  return largest > 0 ? largest : 1;
}

// Harmonics for each component in proportion to its area, which by Weyl's law is an equal bound on eigenvalues; one at
// least, for its own rigid motion.
std::vector<std::uint32_t> ShareHarmonics(const DecodedMesh& mesh, std::uint32_t wanted) {
  PositionMatrix positions(static_cast<Eigen::Index>(mesh.grid.size()), 3);
  for (std::size_t v = 0; v < mesh.grid.size(); ++v) {
    positions.row(static_cast<Eigen::Index>(v)) << mesh.grid[v][0], mesh.grid[v][1], mesh.grid[v][2];
  }
  const Eigen::VectorXd masses = VertexMasses(positions, mesh.triangles);
  const auto components = static_cast<double>(mesh.components.size());
  const double spare = std::max(0.0, static_cast<double>(wanted) - components);
  std::vector<std::uint32_t> counts;
  for (const Component& c : mesh.components) {
    const double share = masses.segment(c.first, c.count).sum();
    counts.push_back(std::min(c.count, 1 + static_cast<std::uint32_t>(std::floor(spare * share + 1e-9))));
  }
  return counts;
}

// Keeps exceptions in, all of which mean that memory is short: the limits of the settings allow more than there is.
template <class Call>
Status Contain(Call&& call) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return Status::Limit("out of memory");
  } catch (const std::length_error&) {
    return Status::Limit("out of memory");
  }
}

// Chooses what the settings leave open, by the quality or by the bound on the error. Steps of displacement and detail
// are fractions of the RMS radius.
Status ChooseDefaults(const Mesh& first, const EncoderSettings& settings, QualitySettings& defaults) {
  if (!settings.max_error) {
    defaults = SettingsOfQuality(
        settings.quality,
        settings.harmonics ? *settings.harmonics : MostHarmonics(static_cast<std::uint32_t>(first.positions.size())));
    return Status::Ok();
  }
  if (const double least = LeastMaxError(first.positions); *settings.max_error < least) {
    std::ostringstream message;
    message << "the largest error allowed, " << *settings.max_error
            << ", is below the precision of the coordinates; the smallest possible is " << least;
    return Status::InvalidArgument(message.str());
  }
  const double rms = RmsRadius(first.positions);
  const BoundedSettings bounded = SettingsOfMaxError(*settings.max_error, first.positions);
  defaults = {settings.quality,          bounded.motion_step,   bounded.displacement_step / rms,
              bounded.detail_step / rms, bounded.position_bits, bounded.harmonics};
  return Status::Ok();
}

// The sequence header but for the grid of positions and the number of harmonics.
SequenceHeader HeaderOf(const Mesh& first, const EncoderSettings& settings, const QualitySettings& defaults) {
  SequenceHeader header;
  const double rms = RmsRadius(first.positions);
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
  return header;
}

}  // namespace

class Encoder::Impl {
 public:
  // kLimit when decoders refuse what is derived from the I-frame. `share`: of the harmonics that quality stands for.
  Status Start(const Mesh& first, const EncoderSettings& settings, double share);
  Status Send(std::span<const Vec3f> positions);
  Status Finish();

  // Keeps a failure after which nothing can be coded.
  Status Latch(Status status) {
    if (!status.ok()) failure_ = status;
    return status;
  }

  // An exception leaves half a frame or half a group behind.
  template <class Step>
  Status Call(Step&& step) {
    bool done = false;
    const Status status = Contain([&] {
      const Status of_step = step();
      done = true;
      return of_step;
    });
    return done ? status : Latch(status);
  }

  std::optional<StreamWriter> writer;
  std::vector<std::uint32_t> order;
  SequenceHeader header;
  StreamInfo info;  // of the header

 private:
  bool IsFull(std::uint32_t frames) const;
  // Tells the caller how many frames are coded; kCancelled when it wants no more.
  Status Progress(std::uint32_t frames) const {
    return settings_.progress && !settings_.progress(frames) ? Status::Cancelled() : Status::Ok();
  }
  Status FlushGroup();
  // Low delay.
  Status SendNow(PositionMatrix positions);
  void EndOpenGroup();

  EncoderSettings settings_;
  Shape shape_;
  std::unique_ptr<GroupEncoder> encoder_;
  std::vector<PositionMatrix> group_;  // frames that wait for the group to be full
  bool finished_ = false;

  // The open group, with low delay.
  std::optional<FrameCoder<RangeEncoder>> coder_;
  std::uint32_t open_frames_ = 0;
  Status failure_;  // half a frame or half a group has been coded
};

Status Encoder::Impl::Start(const Mesh& first, const EncoderSettings& settings, double share) {
  SAC_RETURN_IF_ERROR(CheckSettings(settings));
  SAC_RETURN_IF_ERROR(CheckMesh(first, settings.limits));
  SAC_RETURN_IF_ERROR(CheckFinite(first.positions));
  settings_ = settings;
  SAC_RETURN_IF_ERROR(Progress(0));
  QualitySettings defaults;
  SAC_RETURN_IF_ERROR(ChooseDefaults(first, settings, defaults));
  header = HeaderOf(first, settings, defaults);

  PositionTargets targets;
  SAC_RETURN_IF_ERROR(
      ChooseGrid(first, settings.position_bits.value_or(defaults.position_bits), !settings.max_error, header, targets));
  IFrameSyntax syntax;
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(EncodeIFrameMesh(first, targets, header, syntax, decoded, order));
  const std::vector<std::uint32_t> counts = ShareHarmonics(
      decoded.mesh, settings.harmonics.value_or(static_cast<std::uint32_t>(std::lround(share * defaults.harmonics))));
  for (const std::uint32_t c : counts) header.harmonics += c;
  syntax.harmonics = counts;
  SequenceHeader parsed;
  if (const Status status = ParseSequenceHeader(WriteSequenceHeader(header), settings.limits, parsed); !status.ok()) {
    return Status::InvalidArgument(status.message());  // such as a step that no float can hold
  }
  SAC_RETURN_IF_ERROR(Progress(0));
  syntax.samples_per_harmonic = settings.samples_per_harmonic;
  if (settings.keep_order) syntax.order = order;
  const Limits limits = LimitsOfIFrame(settings.limits, WriteIFrame(syntax, header).size());
  if (Status status =
          BuildShape(header, std::move(decoded.mesh), counts, settings.samples_per_harmonic, limits, shape_);
      !status.ok()) {
    return status.code() == StatusCode::kLimit ? Status::Limit(status.message() + " of decoders") : status;
  }
  syntax.fingerprint = Fingerprint(shape_.basis, shape_.patch_basis);
  const std::vector<std::uint8_t> i_frame = WriteIFrame(syntax, header);
  encoder_ = std::make_unique<GroupEncoder>(shape_, header, settings.max_error.value_or(0));

  info = InfoOf(header);
  writer.emplace(settings.index, settings.repeat_start);
  writer->Start(WriteSequenceHeader(header), i_frame);
  return Status::Ok();
}

Status Encoder::Impl::Send(std::span<const Vec3f> positions) {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  if (positions.size() != order.size()) {
    return Status::InvalidArgument(std::to_string(positions.size()) + " vertices, expected " +
                                   std::to_string(order.size()));
  }
  SAC_RETURN_IF_ERROR(CheckFinite(positions));
  PositionMatrix ordered(static_cast<Eigen::Index>(order.size()), 3);
  for (std::size_t v = 0; v < order.size(); ++v) {
    const Vec3f& p = positions[order[v]];
    ordered.row(static_cast<Eigen::Index>(v)) << static_cast<double>(p[0]), static_cast<double>(p[1]),
        static_cast<double>(p[2]);
  }
  if (settings_.low_delay) return Latch(SendNow(std::move(ordered)));
  group_.push_back(std::move(ordered));
  return IsFull(static_cast<std::uint32_t>(group_.size())) ? Latch(FlushGroup()) : Status::Ok();
}

// A group is no longer than any decoder takes by default.
bool Encoder::Impl::IsFull(std::uint32_t frames) const {
  return frames == settings_.group ||
         (std::uint64_t{frames} + 1) * FrameValues(shape_.layouts) > MaxGroupValues(settings_.limits, shape_);
}

Status Encoder::Impl::SendNow(PositionMatrix positions) {
  if (open_frames_ == 0) {
    writer->OpenGroup();
    coder_.emplace(header, shape_.layouts);
  }
  FrameSyntax frame;
  SAC_RETURN_IF_ERROR(encoder_->EncodeNext(std::move(positions), open_frames_, frame));
  RangeEncoder range;  // each frame ends with a whole byte; the models go on
  FrameBits bits;
  if (!coder_->Code(range, ChainSlot(open_frames_), frame, &bits)) {
    return Status::InvalidArgument("the motion is too far from the first frame for these steps");
  }
  writer->Frame(range.Finish(), bits);
  if (IsFull(++open_frames_)) EndOpenGroup();
  return Progress(writer->frames());
}

void Encoder::Impl::EndOpenGroup() {
  if (open_frames_ > 0) writer->CloseGroup();
  open_frames_ = 0;
}

Status Encoder::Impl::FlushGroup() {
  const auto frames = static_cast<std::uint32_t>(group_.size());
  const std::uint32_t pyramid = settings_.reference_shape == ReferenceShape::kPrevious ? 1 : settings_.pyramid;
  const std::vector<FrameSlot> structure = GroupStructure(frames, pyramid);
  std::vector<FrameSyntax> coded;
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(header, shape_.layouts);
  FrameBits bits;
  const std::uint32_t before = writer->frames();
  const auto frame_done = [&](std::uint32_t count) { return Progress(before + count); };
  SAC_RETURN_IF_ERROR(encoder_->Encode(group_, structure, frame_done, coded));
  for (std::size_t i = 0; i < coded.size(); ++i) {
    if (!coder.Code(range, structure[i], coded[i], &bits)) {
      return Status::InvalidArgument("the motion is too far from the first frame for these steps");
    }
  }

  writer->Group({frames, writer->frames(), pyramid}, range.Finish(), bits);
  group_.clear();
  return Status::Ok();
}

Status Encoder::Impl::Finish() {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  EndOpenGroup();
  if (!group_.empty()) SAC_RETURN_IF_ERROR(Latch(FlushGroup()));
  writer->End();
  finished_ = true;
  return Status::Ok();
}

Encoder::Encoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Encoder::~Encoder() = default;

Status Encoder::Create(const Mesh& first_frame, const EncoderSettings& settings, std::unique_ptr<Encoder>& encoder) {
  // A small I-frame of a large mesh may not ask for as many harmonics as its quality would.
  constexpr double kFewer = 0.9, kFewest = 0.1;
  for (double share = 1;; share *= kFewer) {
    const Status status = Contain([&] {
      auto impl = std::make_unique<Impl>();
      SAC_RETURN_IF_ERROR(impl->Start(first_frame, settings, share));
      encoder.reset(new Encoder(std::move(impl)));
      return Status::Ok();
    });
    if (status.code() != StatusCode::kLimit || settings.harmonics || share < kFewest) return status;
  }
}

Status Encoder::Send(std::span<const Vec3f> positions) {
  return impl_->Call([&] { return impl_->Send(positions); });
}
Status Encoder::Finish() {
  return impl_->Call([&] { return impl_->Finish(); });
}
std::vector<std::uint8_t> Encoder::TakeBytes() { return impl_->writer->TakeBytes(); }
const std::vector<std::uint32_t>& Encoder::order() const { return impl_->order; }
const StreamInfo& Encoder::info() const { return impl_->info; }
const StreamBytes& Encoder::stream_bytes() const { return impl_->writer->sizes(); }

}  // namespace sac
