// Spectral animation compression as published: C. Wang, Y. Liu, X. Guo, Z. Zhong, B. Le, Z. Deng, JCST 30(3), 2015.
// Every frame's deformation gradients against the reconstructed frame before, as logarithm of rotation and stretch, by
// unweighted least squares on harmonics of the first frame; coefficients quantized between their least and greatest,
// then arithmetic coding of order 0 with the counts sent. The first frame is lossless.
//
// A setting is BASES/BITS, and after it /no-polar (the nine entries of the gradients themselves) or /no-arithmetic
// (all BITS of each coefficient). What the paper leaves open: least and greatest are each channel's over the clip,
// found by a pass without quantization; each component's mean vertex is sent per frame as float32.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>

#include "bench/peers/connectivity.h"
#include "bench/peers/count_coder.h"
#include "bench/peers/peer.h"
#include "bench/peers/spectral_frames.h"
#include "codec/deformation.h"
#include "codec/encode/triangle_fields.h"

namespace sac::bench {
namespace {

using Eigen::MatrixXd;

constexpr Eigen::Index kChannels = 9;

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

// Draco's connectivity with the vertices of each component in a run, and the first frame.
struct FirstFrame {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> order;  // of Draco's vertices
  PositionMatrix positions;
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

// Floats as they are, each by its difference to the vertex before as ordered integers: how many bits that has,
// adaptively, and the bits.
template <class Coder>
void CodeFloats(Coder& coder, std::vector<Vec3f>& values) {
  std::array<std::array<BitModel, 33>, 3> models;
  std::array<std::uint32_t, 3> last{};
  // Ascending integers for ascending floats, and back.
  const auto fold = [](std::uint32_t x) { return x >> 31 != 0 ? ~x : x | 0x80000000u; };
  const auto unfold = [](std::uint32_t x) { return x >> 31 != 0 ? x & 0x7fffffffu : ~x; };
  for (Vec3f& value : values) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t difference = fold(std::bit_cast<std::uint32_t>(value[a])) - last[a];
      std::uint32_t zigzag = difference << 1 ^ (difference >> 31 != 0 ? 0xffffffffu : 0);
      int width = Coder::kDecodes ? 0 : std::bit_width(zigzag);
      for (int i = 0; i < 32; ++i) {
        bool more = i < width;
        coder.Bit(models[a][static_cast<std::size_t>(i)], more);
        if (!more) break;
        if constexpr (Coder::kDecodes) width = i + 1;
      }
      std::uint32_t high = zigzag >> 16, low = zigzag & 0xffff;
      if (width > 16) coder.Raw(high, width - 16);
      coder.Raw(low, std::min(width, 16));
      if constexpr (Coder::kDecodes) {
        zigzag = (width > 16 ? high << 16 : 0) | low;
        last[a] += zigzag >> 1 ^ ((zigzag & 1) != 0 ? 0xffffffffu : 0);
        value[a] = std::bit_cast<float>(unfold(last[a]));
      } else {
        last[a] += difference;
      }
    }
  }
}

// Both directions: the frame that these coefficients make of the one before.
Status Reconstruct(const SpectralBasis& basis, const Settings& settings, const MatrixXd& coefficients,
                   const PositionMatrix& centres, PositionMatrix& positions) {
  const MatrixXd fields = basis.Fields(coefficients);
  std::vector<Eigen::Matrix3d> gradients(basis.triangles().size());
  for (std::size_t j = 0; j < gradients.size(); ++j) {
    double f[kChannels];
    for (Eigen::Index c = 0; c < kChannels; ++c) f[c] = fields(static_cast<Eigen::Index>(j), c);
    gradients[j] = settings.polar ? DeformationGradient(f) : Eigen::Map<Eigen::Matrix3d>(f);
  }
  PositionMatrix out;
  SAC_RETURN_IF_ERROR(SolveGradients(basis, positions, gradients, centres, out));
  if (!out.allFinite()) return Status::Unsupported("the reconstruction has diverged");
  positions = out;
  return Status::Ok();
}

// Coefficients between a least and a greatest value of their channel, on so many bits.
struct Quantizer {
  std::array<float, kChannels> low, high;
  std::uint32_t bits;

  double Step(Eigen::Index c) const {
    const auto i = static_cast<std::size_t>(c);
    return (static_cast<double>(high[i]) - static_cast<double>(low[i])) / ((1u << bits) - 1);
  }
  std::uint32_t Level(double value, Eigen::Index c) const {
    const double step = Step(c), at = static_cast<double>(low[static_cast<std::size_t>(c)]);
    const double most = (1u << bits) - 1;
    return step > 0 ? static_cast<std::uint32_t>(std::lround(std::clamp((value - at) / step, 0.0, most))) : 0;
  }
  double Value(std::uint32_t level, Eigen::Index c) const {
    return static_cast<double>(low[static_cast<std::size_t>(c)]) + Step(c) * level;
  }
};

// Goes through the frames as the decoder will; `code` may change the coefficients.
template <class Code>
Status EncodeFrames(const SpectralBasis& basis, const Settings& settings, const std::vector<PositionMatrix>& frames,
                    Code&& code) {
  PositionMatrix decoded = frames[0];
  for (std::size_t f = 1; f < frames.size(); ++f) {
    TriangleFields fields(basis.triangles());  // turns from frame to frame are below pi: no branches to follow
    MatrixXd measured = fields.Measure(decoded, frames[f]);
    for (Eigen::Index j = 0; !settings.polar && j < measured.rows(); ++j) {
      double channels[kChannels];
      for (Eigen::Index c = 0; c < kChannels; ++c) channels[c] = measured(j, c);
      const Eigen::Matrix3d gradient = DeformationGradient(channels);
      for (Eigen::Index c = 0; c < kChannels; ++c) measured(j, c) = gradient(c % 3, c / 3);
    }
    MatrixXd coefficients = basis.Project(measured);
    code(coefficients);
    const PositionMatrix centres = Centres(basis, frames[f]).cast<float>().cast<double>();
    SAC_RETURN_IF_ERROR(Reconstruct(basis, settings, coefficients, centres, decoded));
  }
  return Status::Ok();
}

template <class Coder>
void CodeLevels(Coder& coder, const Settings& settings, std::vector<std::uint32_t>& levels) {
  SymbolCounts table;
  if constexpr (!Coder::kDecodes) table = CountSymbols(levels);
  if (settings.arithmetic) CodeCounts(coder, table);
  for (std::uint32_t& level : levels) {
    if (settings.arithmetic) {
      CodeSymbol(coder, table, level);
    } else {
      coder.Raw(level, static_cast<int>(settings.bits));
    }
  }
}

Status Encode(const PeerClip& clip, const std::string& setting, PeerStream& stream) {
  Settings settings;
  if (!Parse(setting, settings))
    return Status::InvalidArgument(setting + ": not BASES/BITS[/no-polar][/no-arithmetic]");
  ByteWriter out;
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(WriteConnectivity(clip, out, connectivity));
  FirstFrame first = SortByComponent(connectivity);
  for (const std::uint32_t v : first.order) stream.order.push_back(connectivity.order[v]);
  std::vector<PositionMatrix> frames;
  for (const Positions& frame : clip.frames) frames.push_back(MatrixOf(frame, stream.order));
  SpectralBasis basis;
  SAC_RETURN_IF_ERROR(basis.Build(first.triangles, frames[0], settings.bases));

  Quantizer quantizer{{}, {}, settings.bits};
  bool any = false;
  SAC_RETURN_IF_ERROR(EncodeFrames(basis, settings, frames, [&](const MatrixXd& coefficients) {
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const auto low = static_cast<float>(coefficients.col(c).minCoeff());
      const auto high = static_cast<float>(coefficients.col(c).maxCoeff());
      quantizer.low[i] = any ? std::min(quantizer.low[i], low) : low;
      quantizer.high[i] = any ? std::max(quantizer.high[i], high) : high;
    }
    any = true;
  }));
  std::vector<std::uint32_t> levels;
  SAC_RETURN_IF_ERROR(EncodeFrames(basis, settings, frames, [&](MatrixXd& coefficients) {
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      for (Eigen::Index k = 0; k < basis.bases(); ++k) {
        levels.push_back(quantizer.Level(coefficients(k, c), c));
        coefficients(k, c) = quantizer.Value(levels.back(), c);
      }
    }
  }));

  out.Varint(settings.bases);
  out.U8(static_cast<std::uint8_t>(settings.bits));
  out.U8(static_cast<std::uint8_t>(settings.polar ? 1 : 0) | static_cast<std::uint8_t>(settings.arithmetic ? 2 : 0));
  out.Varint(static_cast<std::uint32_t>(frames.size()));
  for (const float x : quantizer.low) out.F32(x);
  for (const float x : quantizer.high) out.F32(x);
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const PositionMatrix centres = Centres(basis, frames[f]);
    for (const double x : centres.reshaped()) out.F32(static_cast<float>(x));
  }
  RangeEncoder coder;
  std::vector<Vec3f> lossless;
  for (const std::uint32_t v : stream.order) lossless.push_back(clip.frames[0][v]);
  CodeFloats(coder, lossless);
  CodeLevels(coder, settings, levels);
  out.Bytes(coder.Finish());
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

Status Decode(std::span<const std::uint8_t> bytes, PeerClip& clip) {
  ByteReader in(bytes);
  Connectivity connectivity;
  SAC_RETURN_IF_ERROR(ReadConnectivity(in, connectivity));
  FirstFrame first = SortByComponent(connectivity);
  std::uint32_t components = 0;
  (void)LabelComponents(static_cast<std::uint32_t>(connectivity.vertices), first.triangles, components);
  Settings settings;
  settings.bases = in.Varint();
  settings.bits = in.U8();
  const std::uint8_t flags = in.U8();
  settings.polar = (flags & 1) != 0;
  settings.arithmetic = (flags & 2) != 0;
  const std::uint32_t frames = in.Varint();
  Quantizer quantizer{{}, {}, settings.bits};
  for (float& x : quantizer.low) x = in.F32();
  for (float& x : quantizer.high) x = in.F32();
  std::vector<PositionMatrix> centres;
  for (std::uint32_t f = 1; f < frames && in.ok(); ++f) {
    centres.emplace_back(components, 3);
    for (double& x : centres.back().reshaped()) x = static_cast<double>(in.F32());
  }
  if (!in.ok()) return Status::Corrupt("truncated stream");
  RangeDecoder coder(in.Bytes(in.remaining()));
  clip.frames.emplace_back(connectivity.vertices);
  CodeFloats(coder, clip.frames[0]);
  std::vector<std::uint32_t> in_order(connectivity.vertices);
  for (std::uint32_t v = 0; v < in_order.size(); ++v) in_order[v] = v;
  PositionMatrix positions = MatrixOf(clip.frames[0], in_order);
  SpectralBasis basis;
  SAC_RETURN_IF_ERROR(basis.Build(first.triangles, positions, settings.bases));
  std::vector<std::uint32_t> levels(static_cast<std::size_t>(basis.bases() * kChannels) * centres.size());
  CodeLevels(coder, settings, levels);
  if (!coder.ok()) return Status::Corrupt("truncated stream");
  std::size_t next = 0;
  for (const PositionMatrix& centre : centres) {
    MatrixXd coefficients(basis.bases(), kChannels);
    for (Eigen::Index c = 0; c < kChannels; ++c) {
      for (Eigen::Index k = 0; k < basis.bases(); ++k) coefficients(k, c) = quantizer.Value(levels[next++], c);
    }
    SAC_RETURN_IF_ERROR(Reconstruct(basis, settings, coefficients, centre, positions));
    clip.frames.push_back(PositionsOf(positions));
  }
  clip.triangles = first.triangles;
  return Status::Ok();
}

}  // namespace
}  // namespace sac::bench

int main(int argc, char** argv) {
  return sac::bench::RunPeer(argc, argv,
                             {"SAC as published (Wang et al. 2015)",
                              "re-implemented",
                              "bases/bits",
                              {"25/18", "50/18", "100/18", "200/18", "400/18"},
                              sac::bench::Encode,
                              sac::bench::Decode});
}
