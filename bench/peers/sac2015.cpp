// SPDX-License-Identifier: Apache-2.0
// Spectral animation compression as published: C. Wang, Y. Liu, X. Guo, Z. Zhong, B. Le, Z. Deng, JCST 30(3), 2015.
// The deformation gradients of every frame against the reconstructed frame before are split into the logarithm of a
// rotation and a stretch, and projected by unweighted least squares onto harmonics of the first frame. The coefficients
// are quantized between their least and greatest values and coded by arithmetic coding of order 0, whose counts are
// sent. The first frame is lossless.
//
// A setting is BASES/BITS. After it may follow /no-polar, which codes the nine entries of the gradients instead, and
// /no-arithmetic, which sends all BITS of each coefficient. The paper leaves two things open: here, the least and
// greatest values are those of each channel over the clip, found by a pass without quantization, and the mean vertex of
// each component is sent per frame as float32.
//
// --report writes the CPU seconds of each step, where "range" is the whole pass without quantization. An encoder also
// reports the bytes of each part of the stream, the number of harmonics of each component, and for each channel how
// often each level appears.
#include <Eigen/Core>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/peers/connectivity.h"
#include "bench/peers/float_coder.h"
#include "bench/peers/peer.h"
#include "bench/peers/quantized_levels.h"
#include "bench/peers/spectral_frames.h"
#include "bench/peers/step_clock.h"
#include "geometry/deformation.h"
#include "geometry/triangle_fields.h"

namespace sac::bench {
namespace {

using Eigen::MatrixXd;

constexpr Eigen::Index kChannels = Quantizer::kChannels;

// The measurements for --report.
struct Report {
  StepClock clock;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  // Counts the bytes written since the last call as the part `name` of the stream.
  void Part(const char* name, const ByteWriter& out) {
    json["bytes"][name] = out.size() - written_;
    written_ = out.size();
  }
  void Levels(const std::vector<std::uint32_t>& levels, std::size_t bases) {
    std::vector<std::vector<std::uint32_t>> channels(kChannels);
    for (std::size_t i = 0; i < levels.size(); ++i) channels[i / bases % channels.size()].push_back(levels[i]);
    for (const std::vector<std::uint32_t>& channel : channels) {
      const SymbolCounts table = CountSymbols(channel);
      std::vector<std::uint64_t> counts;
      for (std::size_t i = 0; i < table.symbols.size(); ++i) counts.push_back(table.before[i + 1] - table.before[i]);
      json["levels"].push_back({{"level", table.symbols}, {"count", counts}});
    }
  }
  std::string Text() {
    for (const auto& [step, seconds] : clock.seconds()) json["seconds"][step] = seconds;
    return json.dump();
  }

 private:
  std::size_t written_ = 0;
};

struct Settings {
  std::uint32_t bases = 0, bits = 0;
  bool polar = true, arithmetic = true;
};

bool Parse(const std::string& text, Settings& settings) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '/');) words.push_back(word);
  double bases = 0, bits = 0;
  if (words.size() < 2 || !ParseNumber(words[0], bases) || !ParseNumber(words[1], bits)) return false;
  if (!(bases >= 1 && bases <= 8192 && bits >= 2 && bits <= 24)) return false;
  settings.bases = static_cast<std::uint32_t>(bases);
  settings.bits = static_cast<std::uint32_t>(bits);
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (words[i] != "no-polar" && words[i] != "no-arithmetic") return false;
    (words[i] == "no-polar" ? settings.polar : settings.arithmetic) = false;
  }
  return true;
}

PositionMatrix MatrixOf(const Positions& positions, const std::vector<std::uint32_t>& order) {
  PositionMatrix out(static_cast<Eigen::Index>(order.size()), 3);
  for (std::size_t v = 0; v < order.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      out(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)) = static_cast<double>(positions[order[v]][a]);
    }
  }
  return out;
}

// Draco's connectivity with the vertices ordered such that each component is a run.
struct FirstFrame {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> order;  // Draco's number of each vertex
};

FirstFrame SortByComponent(const Connectivity& connectivity) {
  FirstFrame first;
  first.order = SpectralBasis::ComponentOrder(connectivity.triangles, connectivity.vertices);
  std::vector<std::uint32_t> place(first.order.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[first.order[i]] = i;
  first.triangles = connectivity.triangles;
  for (Triangle& t : first.triangles) {
    for (std::uint32_t& v : t) v = place[v];
  }
  return first;
}

// Reconstructs a frame from its coefficients and the frame before. `positions` has the frame before and becomes the new
// one. Encoder and decoder both call it.
Status Reconstruct(const SpectralBasis& basis, const Settings& settings, const MatrixXd& coefficients,
                   const PositionMatrix& centres, StepClock& clock, PositionMatrix& positions) {
  const MatrixXd fields = basis.Fields(coefficients);
  std::vector<Eigen::Matrix3d> gradients(basis.triangles().size());
  for (std::size_t j = 0; j < gradients.size(); ++j) {
    double f[kChannels];
    for (Eigen::Index c = 0; c < kChannels; ++c) f[c] = fields(static_cast<Eigen::Index>(j), c);
    gradients[j] = settings.polar ? DeformationGradient(f) : Eigen::Map<Eigen::Matrix3d>(f);
  }
  clock.Lap("gradients_from_coefficients");
  PositionMatrix out;
  SAC_RETURN_IF_ERROR(SolveGradients(basis, positions, gradients, centres, out));
  if (!out.allFinite()) return Status::Unsupported("the reconstruction has diverged");
  positions = out;
  clock.Lap("poisson");
  return Status::Ok();
}

// Projects all frames, reconstructing each one as the decoder will. `code` is called with the coefficients of each
// frame and may change them.
template <class Code>
Status EncodeFrames(const SpectralBasis& basis, const Settings& settings, const std::vector<PositionMatrix>& frames,
                    StepClock& clock, Code&& code) {
  PositionMatrix decoded = frames[0];
  for (std::size_t f = 1; f < frames.size(); ++f) {
    // New for each frame, since rotations from frame to frame are below pi and need no unwrapping.
    TriangleFields fields(basis.triangles());
    MatrixXd measured = fields.Measure(decoded, frames[f]);
    for (Eigen::Index j = 0; !settings.polar && j < measured.rows(); ++j) {
      double channels[kChannels];
      for (Eigen::Index c = 0; c < kChannels; ++c) channels[c] = measured(j, c);
      const Eigen::Matrix3d gradient = DeformationGradient(channels);
      for (Eigen::Index c = 0; c < kChannels; ++c) measured(j, c) = gradient(c % 3, c / 3);
    }
    clock.Lap("polar");
    MatrixXd coefficients = basis.Project(measured);
    clock.Lap("projection");
    code(coefficients);
    clock.Lap("quantization");
    const PositionMatrix centres = Centres(basis, frames[f]).cast<float>().cast<double>();
    SAC_RETURN_IF_ERROR(Reconstruct(basis, settings, coefficients, centres, clock, decoded));
  }
  return Status::Ok();
}

void WriteCode(RangeEncoder& coder, ByteWriter& out) {
  const std::vector<std::uint8_t> bytes = coder.Finish();
  out.Varint(static_cast<std::uint32_t>(bytes.size()));
  out.Bytes(bytes);
}

RangeDecoder ReadCode(ByteReader& in) {
  const std::uint32_t size = in.Varint();
  return RangeDecoder(in.Bytes(size));
}

// Finds the least and the greatest coefficient of each channel over the whole clip.
Status MeasureRange(const SpectralBasis& basis, const Settings& settings, const std::vector<PositionMatrix>& frames,
                    Quantizer& quantizer) {
  bool any = false;
  StepClock unused;
  return EncodeFrames(basis, settings, frames, unused, [&](const MatrixXd& coefficients) {
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const auto low = static_cast<float>(coefficients.col(c).minCoeff());
      const auto high = static_cast<float>(coefficients.col(c).maxCoeff());
      quantizer.low[i] = any ? std::min(quantizer.low[i], low) : low;
      quantizer.high[i] = any ? std::max(quantizer.high[i], high) : high;
    }
    any = true;
  });
}

// Writes everything that the decoder needs before the coefficients, with the centres of each frame.
void WriteHeader(const Settings& settings, const Quantizer& quantizer, const SpectralBasis& basis,
                 const std::vector<PositionMatrix>& frames, ByteWriter& out, Report& report) {
  out.Varint(settings.bases);
  out.U8(static_cast<std::uint8_t>(settings.bits));
  out.U8(static_cast<std::uint8_t>(settings.polar ? 1 : 0) | static_cast<std::uint8_t>(settings.arithmetic ? 2 : 0));
  out.Varint(static_cast<std::uint32_t>(frames.size()));
  for (const float x : quantizer.low) out.F32(x);
  for (const float x : quantizer.high) out.F32(x);
  report.Part("header", out);
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const PositionMatrix centres = Centres(basis, frames[f]);
    for (const double x : centres.reshaped()) out.F32(static_cast<float>(x));
  }
  report.Part("centres", out);
}

Status Encode(const Clip& clip, const std::string& setting, PeerStream& stream, Report& report) {
  Settings settings;
  if (!Parse(setting, settings))
    return Status::InvalidArgument(setting + ": not BASES/BITS[/no-polar][/no-arithmetic]");
  ByteWriter out;
  StepClock& clock = report.clock;
  clock.Lap("reading");
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
  report.Part("connectivity", out);
  FirstFrame first = SortByComponent(connectivity);
  for (const std::uint32_t v : first.order) stream.order.push_back(connectivity.order[v]);
  std::vector<PositionMatrix> frames;
  for (const Positions& frame : clip.frames) frames.push_back(MatrixOf(frame, stream.order));
  clock.Lap("connectivity");
  SpectralBasis basis;
  SAC_RETURN_IF_ERROR(basis.Build(first.triangles, frames[0], settings.bases));
  clock.Lap("eigenvectors");

  Quantizer quantizer{{}, {}, settings.bits};
  SAC_RETURN_IF_ERROR(MeasureRange(basis, settings, frames, quantizer));
  clock.Lap("range");
  std::vector<std::uint32_t> levels;
  SAC_RETURN_IF_ERROR(EncodeFrames(basis, settings, frames, clock, [&](MatrixXd& coefficients) {
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      for (Eigen::Index k = 0; k < basis.bases(); ++k) {
        levels.push_back(quantizer.Level(coefficients(k, c), static_cast<std::size_t>(c)));
        coefficients(k, c) = quantizer.Value(levels.back(), static_cast<std::size_t>(c));
      }
    }
  }));

  WriteHeader(settings, quantizer, basis, frames, out, report);
  clock.Lap("writing");
  RangeEncoder positions, counts, coefficients;
  std::vector<Vec3f> lossless;
  for (const std::uint32_t v : stream.order) lossless.push_back(clip.frames[0][v]);
  CodeFloats(positions, lossless);
  WriteCode(positions, out);
  report.Part("first_frame", out);
  clock.Lap("first_frame");
  SymbolCounts table;
  if (settings.arithmetic) {
    table = CountSymbols(levels);
    CodeCounts(counts, table);
    WriteCode(counts, out);
  }
  report.Part("counts", out);
  CodeLevels(coefficients, settings.arithmetic ? &table : nullptr, settings.bits, levels);
  WriteCode(coefficients, out);
  report.Part("coefficients", out);
  clock.Lap("arithmetic_coding");
  report.json["bases"] = basis.bases();
  report.Levels(levels, static_cast<std::size_t>(basis.bases()));
  stream.bytes = out.bytes();
  return Status::Ok();
}

Positions PositionsOf(const PositionMatrix& matrix) {
  Positions out(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index v = 0; v < matrix.rows(); ++v) {
    for (Eigen::Index a = 0; a < 3; ++a) {
      out[static_cast<std::size_t>(v)][static_cast<std::size_t>(a)] = static_cast<float>(matrix(v, a));
    }
  }
  return out;
}

// The inverse of WriteHeader(). `centres` gets one matrix of `components` rows for each frame but the first.
bool ReadHeader(ByteReader& in, std::uint32_t components, Settings& settings, Quantizer& quantizer,
                std::vector<PositionMatrix>& centres) {
  settings.bases = in.Varint();
  settings.bits = in.U8();
  const std::uint8_t flags = in.U8();
  settings.polar = (flags & 1) != 0;
  settings.arithmetic = (flags & 2) != 0;
  const std::uint32_t frames = in.Varint();
  quantizer = {{}, {}, settings.bits};
  for (float& x : quantizer.low) x = in.F32();
  for (float& x : quantizer.high) x = in.F32();
  for (std::uint32_t f = 1; f < frames && in.ok(); ++f) {
    centres.emplace_back(components, 3);
    for (double& x : centres.back().reshaped()) x = static_cast<double>(in.F32());
  }
  return in.ok();
}

Status Decode(std::span<const std::uint8_t> bytes, Clip& clip, Report& report) {
  StepClock& clock = report.clock;
  clock.Lap("reading");
  ByteReader in(bytes);
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
  FirstFrame first = SortByComponent(connectivity);
  std::uint32_t components = 0;
  (void)LabelComponents(static_cast<std::uint32_t>(connectivity.vertices), first.triangles, components);
  clock.Lap("connectivity");
  Settings settings;
  Quantizer quantizer{{}, {}, 0};
  std::vector<PositionMatrix> centres;
  if (!ReadHeader(in, components, settings, quantizer, centres)) return Status::Corrupt("truncated stream");
  RangeDecoder first_frame = ReadCode(in);
  clip.frames.emplace_back(connectivity.vertices);
  CodeFloats(first_frame, clip.frames[0]);
  std::vector<std::uint32_t> in_order(connectivity.vertices);
  for (std::uint32_t v = 0; v < in_order.size(); ++v) in_order[v] = v;
  PositionMatrix positions = MatrixOf(clip.frames[0], in_order);
  clock.Lap("first_frame");
  SpectralBasis basis;
  SAC_RETURN_IF_ERROR(basis.Build(first.triangles, positions, settings.bases));
  clock.Lap("eigenvectors");
  SymbolCounts table;
  if (settings.arithmetic) {
    RangeDecoder counts = ReadCode(in);
    CodeCounts(counts, table);
    if (!counts.ok()) return Status::Corrupt("truncated counts");
  }
  RangeDecoder coefficient_code = ReadCode(in);
  std::vector<std::uint32_t> levels(static_cast<std::size_t>(basis.bases() * kChannels) * centres.size());
  CodeLevels(coefficient_code, settings.arithmetic ? &table : nullptr, settings.bits, levels);
  if (!in.ok() || !first_frame.ok() || !coefficient_code.ok()) return Status::Corrupt("truncated stream");
  clock.Lap("arithmetic_decoding");
  std::size_t next = 0;
  for (const PositionMatrix& centre : centres) {
    MatrixXd coefficients(basis.bases(), kChannels);
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      for (Eigen::Index k = 0; k < basis.bases(); ++k) {
        coefficients(k, c) = quantizer.Value(levels[next++], static_cast<std::size_t>(c));
      }
    }
    clock.Lap("dequantization");
    SAC_RETURN_IF_ERROR(Reconstruct(basis, settings, coefficients, centre, clock, positions));
    clip.frames.push_back(PositionsOf(positions));
    clock.Lap("writing");
  }
  clip.mesh.triangles = first.triangles;
  return Status::Ok();
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  using namespace sac::bench;
  Report report;
  return RunPeer(argc, argv,
                 {"SAC as published (Wang et al. 2015)",
                  "re-implemented",
                  "bases/bits",
                  {"25/18", "50/18", "100/18", "200/18", "400/18"},
                  [&](const sac::Clip& clip, const std::string& setting, PeerStream& stream) {
                    return Encode(clip, setting, stream, report);
                  },
                  [&](std::span<const std::uint8_t> bytes, sac::Clip& clip) { return Decode(bytes, clip, report); },
                  "",
                  [&] { return report.Text(); }});
}
