#pragma once

// Sections 5.3 to 7 of spec.md once more, written from its text and not from the code: slow, dense, without limits and
// without Draco. Tests compare it with the code, so that the text says what the code does. It is long because it is
// most of a decoder.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codec/components.h"
#include "codec/mesh.h"
#include "conformance/spec_examples.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/group_structure.h"
#include "format/harmonic_order.h"

namespace sac {

// --- Section 7 once more, from its text. -----------------------------------------------------------------------------

struct TextModel {
  std::uint32_t fast = 32768, slow = 32768, count = 0;
};

class TextDecoder {
 public:
  explicit TextDecoder(const Bytes& bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ * 256 + Next();
  }
  int Bin(TextModel& m) {
    const std::uint32_t p = std::clamp((m.fast + m.slow) >> 2, 8u, 32760u);
    const int bin = Decide((range_ >> 15) * p);
    const std::uint32_t young = 131072 / (2 * m.count + 3);
    const std::uint32_t fast_rate = std::max(young, 4096u), slow_rate = std::max(young, 512u);
    if (bin) {
      m.fast += ((65535 - m.fast) * fast_rate) >> 16;
      m.slow += ((65535 - m.slow) * slow_rate) >> 16;
    } else {
      m.fast -= (m.fast * fast_rate) >> 16;
      m.slow -= (m.slow * slow_rate) >> 16;
    }
    m.count = std::min(m.count + 1, 127u);
    return bin;
  }
  int Mixed(std::uint32_t p) { return Decide((range_ >> 16) * p); }
  std::uint32_t Raw(std::uint32_t n) {
    std::uint32_t value = 0;
    for (; n > 0; --n) value = value * 2 + static_cast<std::uint32_t>(Decide(range_ >> 1));
    return value;
  }
  bool AtEnd() const {
    if (position_ < bytes_.size() || position_ > bytes_.size() + 4) return false;
    if (position_ < bytes_.size() + 4 && bytes_.back() == 0) return false;
    std::uint64_t last = 0;
    for (std::size_t i = position_ - 4; i < position_; ++i) last = last * 256 + (i < bytes_.size() ? bytes_[i] : 0);
    const std::uint64_t low = (last - code_) & 0xffffffffu, value = low + code_;
    std::uint64_t power = 1;
    while (power < std::uint64_t{1} << 32 && value % (2 * power) == 0) power *= 2;
    // No multiple of the next power in the range.
    return code_ < range_ && (power >> 32 == 1 || (low + 2 * power - 1) / (2 * power) * (2 * power) - low >= range_);
  }

 private:
  std::uint32_t Next() { return position_++ < bytes_.size() ? bytes_[position_ - 1] : 0; }
  int Decide(std::uint32_t bound) {
    const int bin = code_ < bound;
    if (bin) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < 1u << 24) {
      code_ = code_ * 256 + Next();
      range_ *= 256;
    }
    return bin;
  }

  const Bytes& bytes_;
  std::size_t position_ = 0;
  std::uint32_t code_ = 0, range_ = 0xffffffffu;
};

using TextUe = std::array<TextModel, 31>;
inline std::uint32_t ReadUe(TextDecoder& in, TextUe& prefix) {
  std::uint32_t width = 0;
  while (width < 31 && in.Bin(prefix[width])) ++width;
  return (1u << width) + in.Raw(width) - 1;
}

struct TextSe {
  TextModel nonzero;
  TextUe magnitude;
};
inline std::int64_t ReadSe(TextDecoder& in, TextSe& models) {
  if (!in.Bin(models.nonzero)) return 0;
  const bool negative = in.Raw(1);
  const std::int64_t magnitude = 1 + static_cast<std::int64_t>(ReadUe(in, models.magnitude));
  return negative ? -magnitude : magnitude;
}

// Section 7.4.
inline std::int64_t TextSquash(std::int64_t x) {
  if (x < 0) return 65536 - TextSquash(-x);
  std::vector<std::int64_t> t;
  for (const std::string& line : Example("logistic")) {
    for (const std::string& word : Words(line)) t.push_back(std::stol(word));
  }
  const std::size_t k = static_cast<std::size_t>(x / 128);
  return x == 2816 ? 65535 : t.at(k) + ((t.at(k + 1) - t.at(k)) * (x % 128) + 64) / 128;
}
inline std::int64_t TextStretch(std::int64_t p) {
  static const std::vector<std::int64_t> table = [] {
    std::vector<std::int64_t> squashed, found;
    for (std::int64_t x = -2816; x <= 2816; ++x) squashed.push_back(TextSquash(x));
    for (std::int64_t i = 0; i < 4096; ++i) {
      std::int64_t x = -2816;
      while (x < 2816 && squashed[static_cast<std::size_t>(x + 2816)] < 16 * i + 8) ++x;
      found.push_back(x);
    }
    return found;
  }();
  return table.at(static_cast<std::size_t>(p >> 4));
}
inline std::int64_t Q(std::int64_t x) {
  if (x < 4) return x;
  const int octave = std::ilogb(static_cast<double>(x));
  return 2 * octave + ((x >> (octave - 1)) & 1);
}

struct TextState {
  std::int64_t p = 32768, n = 0;
  std::int64_t Input() const { return (TextStretch(p) * (512 * n / (2 * n + 3))) >> 8; }
  void Update(int bin) {
    const std::int64_t rate = 655360 / (10 * n + 16);
    p = bin ? p + (((65535 - p) * rate) >> 16) : p - ((p * rate) >> 16);
    n = std::min<std::int64_t>(n + 1, 60);
  }
};

using TextMixer = std::vector<std::int32_t>;  // weights
inline int ReadMixed(TextDecoder& in, std::array<TextMixer*, 2> mixers, std::vector<TextState*> states,
                     const std::vector<std::int64_t>& features) {
  static const std::vector<std::int64_t> squash = [] {
    std::vector<std::int64_t> values;
    for (std::int64_t x = -2816; x <= 2816; ++x) values.push_back(TextSquash(x));
    return values;
  }();
  std::vector<std::int64_t> inputs;
  for (const TextState* state : states) inputs.push_back(state->Input());
  inputs.insert(inputs.end(), features.begin(), features.end());
  std::array<std::int64_t, 2> x{};
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t i = 0; i < inputs.size(); ++i) x[m] += inputs[i] * mixers[m]->at(i);
    x[m] = std::clamp<std::int64_t>(x[m] >> 16, -2816, 2816);
  }
  const std::int64_t p = squash[static_cast<std::size_t>(((x[0] + x[1]) >> 1) + 2816)];
  const int bin = in.Mixed(static_cast<std::uint32_t>(std::clamp<std::int64_t>(p, 24, 65512)));
  for (std::size_t m = 0; m < 2; ++m) {
    const std::int64_t e = (14 * ((bin ? 65535 : 0) - squash[static_cast<std::size_t>(x[m] + 2816)]) + 32) >> 6;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const std::int64_t weight = mixers[m]->at(i) + ((inputs[i] * e + 2048) >> 12);
      mixers[m]->at(i) = static_cast<std::int32_t>(static_cast<std::uint32_t>(weight));
    }
  }
  for (TextState* state : states) state->Update(bin);
  return bin;
}

// Section 6.2. A plane is [row][channel].
struct TextFrame {
  std::vector<std::uint32_t> references;
  std::array<std::int64_t, 6> rigid{};
  std::array<std::vector<std::vector<std::int32_t>>, 4> planes;
};

// One plane's memory through a group.
struct TextPlane {
  std::vector<std::int64_t> row_classes;
  std::vector<std::vector<std::int64_t>> recent;                 // h of [row][channel]
  std::map<std::vector<std::int64_t>, TextState> states;         // by input, bin and context
  std::map<std::vector<std::int64_t>, TextMixer> first, second;  // by kind and level, by kind and activity
  std::map<std::vector<std::int64_t>, TextState> sign_states;    // by input and context
  std::map<std::int64_t, TextMixer> sign_first;                  // by level
  TextMixer sign_second = {40 * 1024, 40 * 1024};
  std::array<TextModel, 20> escape;
};

class TextFrameReader {
 public:
  // Harmonics of components, and vertices of patches; empty without a detail plane.
  TextFrameReader(const std::vector<std::uint32_t>& harmonics, const std::vector<std::uint32_t>& patches,
                  std::size_t corrected_vertices, std::int64_t growth, bool predicts_planes)
      : growth_(growth), predicts_planes_(predicts_planes) {
    for (const HarmonicIndex& i : HarmonicOrder(harmonics)) {
      planes_[0].row_classes.push_back(std::min<std::int64_t>(Q(i.k + 1), 23));
    }
    planes_[1].row_classes = planes_[0].row_classes;
    for (const HarmonicIndex& i : HarmonicOrder(patches)) {
      planes_[2].row_classes.push_back(std::min<std::int64_t>(Q(i.k + 1), 23));
    }
    planes_[3].row_classes.assign(corrected_vertices, 1);
    for (std::size_t p = 0; p < 4; ++p) {
      planes_[p].recent.assign(planes_[p].row_classes.size(), std::vector<std::int64_t>(p == 0 ? 9 : 3));
    }
  }

  // The residuals of the frame at a slot of the structure; afterwards coefficients().back() are what they add up to.
  const TextFrame& Read(TextDecoder& in, const FrameSlot& slot) {
    TextFrame frame;
    frame.references = slot.references;
    const auto index = static_cast<std::uint32_t>(frames_.size());
    if (index > 0 && in.Bin(explicit_)) {
      const int any = in.Bin(count_[0]);
      const int two = any ? in.Bin(count_[1]) : 0;
      frame.references.resize(static_cast<std::size_t>(any + two));
      for (std::uint32_t& r : frame.references) r = index - 1 - ReadUe(in, reference_);
    }
    slots_.push_back(slot);
    const std::size_t level = std::min(slot.level, 2u);
    if (in.Bin(moves_[level])) {
      for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] = ReadSe(in, rigid_[i / 3][level]);
    }
    for (std::size_t p = 0; p < 4; ++p) {
      auto& plane = frame.planes[p];
      plane.assign(planes_[p].row_classes.size(), std::vector<std::int32_t>(p == 0 ? 9 : 3));
      if (plane.empty()) continue;
      if (!in.Bin(empty_[p][level])) {
        for (std::size_t i = 0; i < plane.size(); ++i) {
          for (std::size_t j = 0; j < plane[i].size(); ++j) plane[i][j] = ReadResidual(in, frame, p, i, j);
        }
      }
      for (std::size_t i = 0; i < plane.size(); ++i) {
        for (std::size_t j = 0; j < plane[i].size(); ++j) {
          std::int64_t& h = planes_[p].recent[i][j];
          const std::int64_t size = std::abs(std::int64_t{plane[i][j]}) * Step(p);
          h += (4 * std::min<std::int64_t>(size, 1 << 20) - h) >> 3;
        }
      }
    }
    frames_.push_back(frame);
    AddUp();
    return frames_.back();
  }
  const std::vector<TextFrame>& coefficients() const { return coefficients_; }

 private:
  // Section 6.3, of the frame being read.
  std::int64_t Step(std::size_t p) const {
    std::int64_t step = 16;
    if (p == 3) return step;
    for (std::uint32_t i = 0; i < slots_.back().level && step < 4096; ++i) step = (step * growth_ + 32) / 64;
    return std::min<std::int64_t>(step, 4096);
  }
  template <class Value>
  std::int64_t Bend(const std::vector<std::uint32_t>& references, Value&& value) const {
    if (references.empty()) return 0;
    const bool one = references.size() == 1;
    const std::int64_t x_a = value(coefficients_[references[0]]), x_b = value(coefficients_[references.back()]);
    const std::int64_t d_a = slots_[references[0]].display, d_b = slots_[references.back()].display;
    std::int64_t sum = 0;
    for (std::size_t o = 0; o < coefficients_.size(); ++o) {
      const std::int64_t at = slots_[o].display, x = value(coefficients_[o]);
      if (one && at == 2 * d_a - slots_.back().display) sum += 8 * (x_a - x);
      if (!one && at == 2 * d_a - d_b) sum += 2 * x_a - x_b - x;
      if (!one && at == 2 * d_b - d_a) sum += 2 * x_b - x_a - x;
    }
    return sum;
  }
  void AddUp() {
    TextFrame frame = frames_.back();
    const auto predict = [&](auto&& value) -> std::int64_t {
      if (frame.references.empty()) return 0;
      const std::int64_t a = value(coefficients_.at(frame.references[0]));
      if (frame.references.size() == 1) return a;
      return (a + value(coefficients_.at(frame.references[1])) + 1) >> 1;
    };
    for (std::size_t i = 0; i < 6; ++i) frame.rigid[i] += predict([&](const TextFrame& f) { return f.rigid[i]; });
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t i = 0; i < frame.planes[p].size(); ++i) {
        for (std::size_t j = 0; j < frame.planes[p][i].size(); ++j) {
          const auto at = [&](const TextFrame& f) { return std::int64_t{f.planes[p][i][j]}; };
          std::int64_t prediction = p == 3 || !predicts_planes_ ? 0 : predict(at);
          if (p < 2 && predicts_planes_ && slots_.back().level >= 3 && frame.references.size() == 2) {
            const std::int64_t sum = at(coefficients_[frame.references[0]]) + at(coefficients_[frame.references[1]]);
            prediction = (8 * sum + Bend(frame.references, at) + 8) >> 4;
          }
          std::int32_t& value = frame.planes[p][i][j];
          value = static_cast<std::int32_t>(prediction + value * Step(p));
        }
      }
    }
    coefficients_.push_back(frame);
  }

  // Section 7.4, of the frame being read.
  static std::int64_t At(const TextFrame& frame, std::size_t p, std::ptrdiff_t i, std::size_t j) {
    const auto& plane = frame.planes[p];
    return i < 0 || i >= static_cast<std::ptrdiff_t>(plane.size()) ? 0 : plane[static_cast<std::size_t>(i)][j];
  }
  static std::int64_t Magnitude(const TextFrame& frame, std::size_t p, std::ptrdiff_t i, std::size_t j) {
    return std::min<std::int64_t>(std::abs(At(frame, p, i, j)), 1 << 15);
  }
  static std::int64_t Sign(std::int64_t x) { return (x > 0) - (x < 0); }
  static TextMixer Weights(std::size_t p, std::int64_t kind, std::int64_t level) {
    for (const std::string& line : Example("weights")) {
      const auto words = Words(line);
      if (words[0] != std::to_string(std::min<std::size_t>(p, 2))) continue;
      if (words[1] != std::to_string(std::min<std::int64_t>(kind, 2))) continue;
      if (words[2] != "*" && words[2] != std::to_string(level)) continue;
      TextMixer weights = Numbers<std::int32_t>(words, 3);
      for (std::int32_t& w : weights) w *= 1024;
      return weights;
    }
    ADD_FAILURE() << "no weights of plane " << p << ", kind " << kind << ", level " << level;
    return {};
  }
  template <class Key>
  static TextMixer* Find(std::map<Key, TextMixer>& mixers, const Key& key, const TextMixer& fresh) {
    return &mixers.try_emplace(key, fresh).first->second;
  }

  std::int32_t ReadResidual(TextDecoder& in, const TextFrame& frame, std::size_t p, std::size_t row, std::size_t j) {
    const auto i = static_cast<std::ptrdiff_t>(row);
    const auto column = static_cast<std::int64_t>(j);
    TextPlane& plane = planes_[p];
    const std::int64_t step = Step(p), v = std::min(slots_.back().level, 4u), l = std::min(slots_.back().level, 2u);
    const auto m = [&](std::ptrdiff_t at) { return Magnitude(frame, p, at, j); };
    const std::int64_t near = 12 * m(i - 1) + 6 * m(i - 2) + 3 * m(i - 3) + 3 * m(i - 4);
    std::int64_t before = 0;
    for (std::size_t c = 0; c < j; ++c) before += 24 * Magnitude(frame, p, i, c);
    if (j > 0) before /= column;
    std::int64_t around = 0, touched = 0, reference_sign = 0, spread = 0, bend = 0;
    if (!frame.references.empty()) {
      const std::uint32_t first = frame.references[0], second = frame.references.back();
      for (const std::uint32_t r : {first, second}) {
        touched += Magnitude(frames_[r], p, i, j);
        around += 4 * Magnitude(frames_[r], p, i, j) + 2 * Magnitude(frames_[r], p, i - 1, j) +
                  2 * Magnitude(frames_[r], p, i + 1, j);
        reference_sign += Sign(At(frames_[r], p, i, j));
      }
      spread = std::abs(At(coefficients_[first], p, i, j) - At(coefficients_[second], p, i, j));
      bend = Bend(frame.references, [&](const TextFrame& f) { return At(f, p, i, j); });
    }
    const auto h = [&](std::ptrdiff_t at) {
      return at < 0 || at >= static_cast<std::ptrdiff_t>(plane.recent.size())
                 ? 0
                 : plane.recent[static_cast<std::size_t>(at)][j];
    };
    const std::int64_t recent = std::min<std::int64_t>(Q(16 * h(i) / step / 4), 19);
    const std::int64_t wide = Q((16 * h(i) + 4 * (h(i - 1) + h(i + 1))) / step);
    const std::int64_t spread_class = Q(16 * std::min<std::int64_t>(spread, 1 << 26) / step);
    const std::int64_t bend_class =
        std::min<std::int64_t>(Q(std::min<std::int64_t>(std::abs(bend), 1 << 30) / (2 * step)), 11);
    const std::int64_t activity = std::min<std::int64_t>(Q((near + around + before) / 2), 23);
    const std::int64_t low_row = std::min<std::int64_t>(i, 1023);
    const std::vector<std::vector<std::int64_t>> contexts = {
        {0, recent, v, touched == 0},
        {1, std::min<std::int64_t>(Q(near / 3), 15), std::min<std::int64_t>(Q(before / 6), 13)},
        {2, plane.row_classes[row], column, v},
        {3, low_row, l},
        {4, column, v},
        {5, low_row, column}};
    const std::vector<std::int64_t> features = {
        256, 64 * wide - 512, 64 * spread_class - 512, 64 * Q(near) - 256, 64 * bend_class - 256, 128 * v - 256};
    const auto bin = [&](std::int64_t number) {
      std::vector<TextState*> states;
      for (std::vector<std::int64_t> key : contexts) {
        key.push_back(number);
        states.push_back(&plane.states[key]);
      }
      const std::int64_t kind = std::min<std::int64_t>(number, 5);
      return ReadMixed(in,
                       {Find(plane.first, {kind, l}, Weights(p, kind, l)),
                        Find(plane.second, {kind, activity}, Weights(p, kind, 1))},
                       states, features);
    };
    if (!bin(0)) return 0;
    const std::int64_t bend_context = bend_class > 0 ? Sign(bend) * std::min<std::int64_t>(bend_class, 8) : 0;
    const bool negative = ReadMixed(in, {Find(plane.sign_first, v, {40 * 1024, 40 * 1024}), &plane.sign_second},
                                    {&plane.sign_states[{0, bend_context, v}],
                                     &plane.sign_states[{1, Sign(reference_sign), Sign(At(frame, p, i - 1, j)), l}]},
                                    {});
    std::uint32_t magnitude = 1;
    while (magnitude < 15 && bin(magnitude)) ++magnitude;
    if (magnitude == 15) {
      std::uint32_t width = 0;
      while (width < 20 && in.Bin(plane.escape[width])) ++width;
      magnitude = 14 + (1u << width) + in.Raw(width);
    }
    const auto value = static_cast<std::int32_t>(magnitude);
    return negative ? -value : value;
  }

  std::int64_t growth_;
  bool predicts_planes_;
  std::vector<FrameSlot> slots_;
  std::vector<TextFrame> frames_, coefficients_;
  TextModel explicit_;
  std::array<TextModel, 2> count_;
  TextUe reference_;
  std::array<TextModel, 3> moves_;
  std::array<std::array<TextModel, 3>, 4> empty_;
  std::array<std::array<TextSe, 3>, 2> rigid_;
  std::array<TextPlane, 4> planes_;
};

// --- Section 6.4 once more, from its text. ---------------------------------------------------------------------------

inline double G(std::uint64_t i) {
  return static_cast<double>((i + 1) * 2654435761u % (std::uint64_t{1} << 32)) / 2147483648.0 - 1;
}

inline double Polynomial(const Eigen::Vector3d& at) {
  double sum = 0;
  for (const std::string& line : Example("inhomogeneity")) {
    const auto words = Words(line);
    double term = std::stod(words[0]);
    for (std::size_t i = 1; i < words.size(); ++i) term *= at[words[i][0] - 'x'];
    sum += term;
  }
  return sum;
}

struct TextMesh {
  std::vector<std::array<std::uint32_t, 3>> grid;
  std::vector<Triangle> triangles;
};

inline Eigen::Vector3d Point(const std::array<std::uint32_t, 3>& g) { return {1.0 * g[0], 1.0 * g[1], 1.0 * g[2]}; }

inline std::map<std::array<std::uint32_t, 2>, double> TextWeights(const TextMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, double> weights;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      if (a == b) continue;
      const Eigen::Vector3d p = Point(mesh.grid[t[k]]), pa = Point(mesh.grid[a]), pb = Point(mesh.grid[b]);
      double& w = weights[{std::min(a, b), std::max(a, b)}];
      const double longest = std::max({(pa - p).squaredNorm(), (pb - p).squaredNorm(), (pa - pb).squaredNorm()});
      if (longest == 0) continue;
      const double area2 = (pa - p).cross(pb - p).norm();
      w += std::clamp((pa - p).dot(pb - p) / std::max(area2, 1e-6 * longest), -5.0, 5.0) / 2;
    }
  }
  for (auto& [edge, w] : weights) w = std::max(w, 0.001);
  return weights;
}

inline Eigen::VectorXd TextMasses(const TextMesh& mesh) {
  Eigen::VectorXd m = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.grid.size()));
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d p = Point(mesh.grid[t[0]]);
    for (const std::uint32_t v : t) {
      m[v] += (Point(mesh.grid[t[1]]) - p).cross(Point(mesh.grid[t[2]]) - p).norm() / 2 / 3;
    }
  }
  m = m.cwiseMax(0.001 * m.mean()).eval();
  return m / m.sum();
}

// Samples, covering and functions of 6.4.4.
inline Eigen::MatrixXd TextFunctions(const std::vector<std::array<std::uint32_t, 3>>& grid, std::size_t s,
                                     std::vector<std::size_t>& samples, std::int64_t& covering) {
  const auto distance = [&](std::size_t a, std::size_t b) {
    return static_cast<std::int64_t>((Point(grid[a]) - Point(grid[b])).squaredNorm());
  };
  const auto farthest = [&](std::int64_t& greatest) {
    std::size_t which = 0;
    greatest = -1;
    for (std::size_t v = 0; v < grid.size(); ++v) {
      std::int64_t nearest = distance(v, samples[0]);
      for (const std::size_t i : samples) nearest = std::min(nearest, distance(v, i));
      if (nearest > greatest) greatest = nearest, which = v;
    }
    return which;
  };
  samples = {0};
  while (samples.size() < s) samples.push_back(farthest(covering));
  farthest(covering);
  const double r = 3 * std::sqrt(static_cast<double>(std::max<std::int64_t>(covering, 1)));
  Eigen::MatrixXd functions(grid.size(), s);
  for (std::size_t v = 0; v < grid.size(); ++v) {
    for (std::size_t i = 0; i < s; ++i) {
      const double t = std::sqrt(static_cast<double>(distance(v, samples[i]))) / r;
      functions(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(i)) =
          t < 1 ? std::pow(1 - t, 4) * (4 * t + 1) : 0;
    }
  }
  for (Eigen::Index v = 0; v < functions.rows(); ++v) functions.row(v) /= functions.row(v).sum();
  return functions;
}

// Eigenvalues and harmonics of the component [first, first + n), as 6.4 says.
inline void TextBasis(const TextMesh& mesh, const Eigen::VectorXd& masses, std::uint32_t first, std::uint32_t n,
                      std::uint32_t l, std::uint32_t samples_per_harmonic, Eigen::VectorXd& values,
                      Eigen::MatrixXd& h) {
  const Eigen::VectorXd mass = masses.segment(first, n);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (std::uint32_t v = first; v < first + n; ++v) {
    low = low.cwiseMin(Point(mesh.grid[v]));
    high = high.cwiseMax(Point(mesh.grid[v]));
  }
  const double e = std::max(1.0, (high - low).maxCoeff());
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(n, n), d = mass.asDiagonal();
  for (const auto& [edge, weight] : TextWeights(mesh)) {
    if (edge[0] < first || edge[1] >= first + n) continue;
    const Eigen::Vector3d middle = (Point(mesh.grid[edge[0]]) + Point(mesh.grid[edge[1]])) / 2;
    const double w = weight * (1 + 0.1 * Polynomial((middle - low) / e));
    const Eigen::Index a = edge[0] - first, b = edge[1] - first;
    laplacian(a, b) -= w;
    laplacian(b, a) -= w;
    laplacian(a, a) += w;
    laplacian(b, b) += w;
  }
  using Solver = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;
  const std::uint32_t s = samples_per_harmonic * l;
  if (s > 0 && s < n) {
    std::vector<std::size_t> samples;
    std::int64_t covering = 0;
    const Eigen::MatrixXd functions =
        TextFunctions({mesh.grid.begin() + first, mesh.grid.begin() + first + n}, s, samples, covering);
    const Solver ritz(functions.transpose() * laplacian * functions, functions.transpose() * d * functions);
    const Eigen::MatrixXd z = (laplacian + d).ldlt().solve(d * functions * ritz.eigenvectors().leftCols(l));
    const Solver again(z.transpose() * laplacian * z, z.transpose() * d * z);
    values = again.eigenvalues();
    h = z * again.eigenvectors();
  } else {
    const Solver solver(laplacian, d);
    values = solver.eigenvalues().head(l);
    h = solver.eigenvectors().leftCols(l);
  }
  h.col(0).setOnes();
  values[0] = 0;
  for (Eigen::Index k = 0; k < h.cols(); ++k) {
    double mean_square = 0, sign = 0;
    for (Eigen::Index v = 0; v < n; ++v) {
      mean_square += mass[v] * h(v, k) * h(v, k) / mass.sum();
      sign += G(static_cast<std::uint64_t>(v)) * h(v, k);
    }
    h.col(k) *= (k > 0 && sign < 0 ? -1 : 1) / std::sqrt(mean_square);
  }
}

// Decodes a stream without a Draco mesh, whose reference shape is M'0, all by the text.
class TextStream {
 public:
  explicit TextStream(const Bytes& bytes) : bytes_(bytes) {}

  // Vertices x 3 of each frame.
  std::vector<Eigen::MatrixXd> Decode() {
    ByteReader in(bytes_);
    EXPECT_EQ(in.U32(), 0x1A434153u);
    while (in.remaining() > 0) {
      const std::size_t start = in.position();
      const std::uint32_t tag = in.Varint();
      const auto payload = in.Bytes(tag / 4);
      const std::uint32_t crc = Crc32(std::span(bytes_).subspan(start, in.position() - start));
      EXPECT_EQ(crc, in.U32());
      const Bytes copy(payload.begin(), payload.end());
      ByteReader reader(copy);
      if (tag % 4 < 2) {
        Bytes& first = starts_[tag % 4];
        if (!first.empty()) {  // it comes again
          EXPECT_EQ(copy, first);
          continue;
        }
        first = copy;
      }
      if (tag % 4 == 0) ReadHeader(reader);
      if (tag % 4 == 1) ReadIFrame(reader);
      if (tag % 4 == 2) {
        begins_.push_back(start);
        first_frames_.push_back(static_cast<std::uint32_t>(frames_.size()));
        const std::uint32_t frames = reader.Varint();
        EXPECT_EQ(reader.Varint(), frames_.size());
        if (frames == 0) ReadOpenGroup(in);
        if (frames != 0) ReadGroup(frames, reader);
      }
      if (tag % 4 == 3) ReadEnd(reader, start, in.position() - start);
    }
    return frames_;
  }
  const std::vector<Triangle>& triangles() const { return mesh_.triangles; }

 private:
  void ReadHeader(ByteReader& in) {
    EXPECT_EQ(in.U8(), 0);
    EXPECT_EQ(in.U8(), 6);
    EXPECT_EQ(in.U8(), 0);  // reference_shape
    in.U8();                // position_bits
    growth_ = in.U8();
    vertices_ = in.Varint();
    in.Varint();  // triangles
    harmonics_ = in.Varint();
    patch_size_ = in.Varint();
    in.Varint();  // frame rate
    in.Varint();
    for (int a = 0; a < 3; ++a) origin_[a] = static_cast<double>(in.F32());
    for (double* step : {&cell_, &motion_step_, &displacement_step_, &detail_step_, &correction_step_, &rotation_step_,
                         &translation_step_}) {
      *step = static_cast<double>(in.F32());
    }
    EXPECT_TRUE(in.ok() && in.remaining() == 0);
  }

  void ReadIFrame(ByteReader& reader) {
    EXPECT_EQ(reader.Varint(), 0u);  // mesh_size
    const auto rest = reader.Bytes(reader.remaining());
    const Bytes bytes(rest.begin(), rest.end());
    TextDecoder in(bytes);
    TextUe welds, loose_vertices, loose_triangles, components, samples;
    EXPECT_EQ(ReadUe(in, welds), 0u);
    EXPECT_EQ(in.Raw(2), 0u);  // no normals, no colours
    std::array<TextSe, 3> difference;
    std::array<std::int64_t, 3> at{};
    TextMesh first;  // in the numbering of 5.3 step 1
    for (std::uint32_t n = ReadUe(in, loose_vertices); n > 0; --n) {
      for (std::size_t a = 0; a < 3; ++a) at[a] += ReadSe(in, difference[a]);
      first.grid.push_back(
          {static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]), static_cast<std::uint32_t>(at[2])});
    }
    TextSe corner, count;
    std::int64_t v = 0;
    for (std::uint32_t n = ReadUe(in, loose_triangles); n > 0; --n) {
      Triangle& t = first.triangles.emplace_back();
      for (std::uint32_t& c : t) c = static_cast<std::uint32_t>(v += ReadSe(in, corner));
    }
    std::int64_t h = harmonics_;
    for (std::uint32_t n = ReadUe(in, components); n > 0; --n) {
      counts_.push_back(static_cast<std::uint32_t>(h += ReadSe(in, count)));
    }
    const std::uint32_t samples_per_harmonic = ReadUe(in, samples);
    const std::uint32_t e0 = in.Raw(32), e1 = in.Raw(32);
    EXPECT_EQ(in.Raw(1), 0u);  // keeps_order
    EXPECT_TRUE(in.AtEnd());
    Renumber(first);

    masses_ = TextMasses(mesh_);
    double f0 = 0, f1 = 0;
    for (std::size_t c = 0; c < components_.size(); ++c) {
      Eigen::VectorXd values;
      TextBasis(mesh_, masses_, components_[c].first, components_[c].count, counts_.at(c), samples_per_harmonic, values,
                basis_.emplace_back());
      f0 += values.sum();
      for (Eigen::Index k = 0; k < basis_[c].cols(); ++k) {
        for (Eigen::Index i = 0; i < basis_[c].rows(); ++i) {
          f1 += G(3 * static_cast<std::uint64_t>(k)) * G(7 * static_cast<std::uint64_t>(i)) * basis_[c](i, k) /
                static_cast<double>(basis_[c].rows());
        }
      }
    }
    EXPECT_NEAR(f0, std::bit_cast<float>(e0), 1e-5 * f0 + 1e-6);
    EXPECT_NEAR(f1, std::bit_cast<float>(e1), 1e-5);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(vertices_);
    for (const Component& p : patches_) {
      Eigen::VectorXd values;
      TextBasis(mesh_, ones, p.first, p.count, p.count, 0, values, patch_basis_.emplace_back());
    }
  }

  static bool Touch(const TextMesh& mesh, std::uint32_t a, std::uint32_t b) {
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      return std::count(t.begin(), t.end(), a) > 0 && std::count(t.begin(), t.end(), b) > 0;
    });
  }
  // The connected pieces of a set, by their smallest vertex.
  static std::vector<std::vector<std::uint32_t>> Pieces(const TextMesh& mesh, std::set<std::uint32_t> part) {
    std::vector<std::vector<std::uint32_t>> pieces;
    while (!part.empty()) {
      std::vector<std::uint32_t>& piece = pieces.emplace_back(1, *part.begin());
      part.erase(part.begin());
      for (std::size_t i = 0; i < piece.size(); ++i) {
        for (auto at = part.begin(); at != part.end();) {
          if (Touch(mesh, piece[i], *at)) {
            piece.push_back(*at);
            at = part.erase(at);
          } else {
            ++at;
          }
        }
      }
      std::sort(piece.begin(), piece.end());
    }
    return pieces;
  }
  void Cut(const TextMesh& mesh, std::vector<std::uint32_t> part, std::vector<std::vector<std::uint32_t>>& patches) {
    if (part.size() <= patch_size_) {
      for (const auto& piece : Pieces(mesh, {part.begin(), part.end()})) patches.push_back(piece);
      return;
    }
    const auto extent = [&](std::size_t a) {
      std::uint32_t low = 0xffffffffu, high = 0;
      for (const std::uint32_t v : part) {
        low = std::min(low, mesh.grid[v][a]);
        high = std::max(high, mesh.grid[v][a]);
      }
      return high - low;
    };
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (extent(a) > extent(axis)) axis = a;
    }
    std::sort(part.begin(), part.end());
    std::stable_sort(part.begin(), part.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return mesh.grid[a][axis] < mesh.grid[b][axis]; });
    const auto half = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    Cut(mesh, {part.begin(), half}, patches);
    Cut(mesh, {half, part.end()}, patches);
  }
  void Renumber(const TextMesh& first) {
    EXPECT_EQ(first.grid.size(), vertices_);
    std::set<std::uint32_t> all;
    for (std::uint32_t v = 0; v < vertices_; ++v) all.insert(v);
    std::vector<std::uint32_t> renumbered(vertices_);
    for (const auto& component : Pieces(first, all)) {
      components_.push_back(
          {static_cast<std::uint32_t>(mesh_.grid.size()), static_cast<std::uint32_t>(component.size())});
      std::vector<std::vector<std::uint32_t>> patches;
      Cut(first, component, patches);
      for (const auto& patch : patches) {
        patches_.push_back({static_cast<std::uint32_t>(mesh_.grid.size()), static_cast<std::uint32_t>(patch.size())});
        for (const std::uint32_t v : patch) {
          renumbered[v] = static_cast<std::uint32_t>(mesh_.grid.size());
          mesh_.grid.push_back(first.grid[v]);
        }
      }
    }
    for (Triangle t : first.triangles) {
      for (std::uint32_t& v : t) v = renumbered[v];
      mesh_.triangles.push_back(t);
    }
  }

  // Section 3.2.
  void ReadEnd(ByteReader& in, std::size_t start, std::size_t size) {
    EXPECT_EQ(in.Varint(), frames_.size());
    if (in.remaining() == 0) return;
    std::uint64_t byte = in.Varint(), frame = 0;
    for (std::size_t i = 0; in.remaining() > 4; ++i) {
      EXPECT_EQ(byte, begins_.at(i));
      EXPECT_EQ(frame, first_frames_.at(i));
      byte += in.Varint();
      frame += in.Varint();
    }
    EXPECT_EQ(byte, start);
    EXPECT_EQ(in.U32(), size);
  }

  void ReadGroup(std::uint32_t frames, ByteReader& reader) {
    const std::uint32_t pyramid = reader.Varint();
    const auto rest = reader.Bytes(reader.remaining());
    const Bytes bytes(rest.begin(), rest.end());
    TextDecoder in(bytes);
    TextFrameReader reader_of_frames = NewFrameReader();
    std::vector<Eigen::MatrixXd> shown(frames);
    for (const FrameSlot& slot : GroupStructure(frames, pyramid)) {
      reader_of_frames.Read(in, slot);
      shown[slot.display] = Reconstruct(reader_of_frames.coefficients().back());
    }
    EXPECT_TRUE(in.AtEnd());
    frames_.insert(frames_.end(), shown.begin(), shown.end());
  }

  // Section 3.1: the records after the packet.
  void ReadOpenGroup(ByteReader& in) {
    TextFrameReader reader_of_frames = NewFrameReader();
    Bytes all;  // that the CRC is of
    for (std::uint32_t i = 0;; ++i) {
      const std::size_t start = in.position();
      const std::uint32_t record = in.Varint();
      const auto code = in.Bytes(record > 0 ? record - 1 : 0);
      const auto bytes = std::span(bytes_).subspan(start, in.position() - start);
      all.insert(all.end(), bytes.begin(), bytes.end());
      if (record == 0) {
        EXPECT_EQ(in.U32(), Crc32(all));
        return;
      }
      EXPECT_EQ(in.U8(), Crc32(all) % 256);
      const Bytes copy(code.begin(), code.end());
      TextDecoder frame(copy);
      FrameSlot slot{i, 0, {}};
      if (i > 0) slot.references = {i - 1};
      reader_of_frames.Read(frame, slot);
      frames_.push_back(Reconstruct(reader_of_frames.coefficients().back()));
      EXPECT_TRUE(frame.AtEnd());
    }
  }

  TextFrameReader NewFrameReader() const {
    std::vector<std::uint32_t> patch_sizes;
    for (const Component& p : patches_) patch_sizes.push_back(p.count);
    return {counts_, detail_step_ > 0 ? patch_sizes : std::vector<std::uint32_t>(),
            correction_step_ > 0 ? vertices_ : 0, growth_, true};
  }

  // Vertices x channels of a plane of harmonics.
  Eigen::MatrixXd Field(const std::vector<std::vector<std::int32_t>>& plane, const std::vector<Component>& parts,
                        const std::vector<std::uint32_t>& counts, const std::vector<Eigen::MatrixXd>& basis,
                        const std::function<double(double)>& unit) const {
    Eigen::MatrixXd field = Eigen::MatrixXd::Zero(vertices_, plane.empty() ? 3 : static_cast<int>(plane[0].size()));
    std::size_t row = 0;
    if (plane.empty()) return field;
    for (const HarmonicIndex& i : HarmonicOrder(counts)) {
      const Component& part = parts[i.component];
      for (std::size_t j = 0; j < plane[row].size(); ++j) {
        field.col(static_cast<Eigen::Index>(j)).segment(part.first, part.count) +=
            plane[row][j] * unit(part.count) * basis[i.component].col(i.k);
      }
      ++row;
    }
    return field;
  }

  static Eigen::Matrix3d R(const Eigen::Vector3d& u) {
    if (u.norm() == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(u.norm(), u.normalized()).toRotationMatrix();
  }

  Eigen::MatrixXd Reconstruct(const TextFrame& frame) const {
    const double n = vertices_;
    std::vector<std::uint32_t> patch_sizes;
    for (const Component& p : patches_) patch_sizes.push_back(p.count);
    const Eigen::MatrixXd motion = Field(frame.planes[0], components_, counts_, basis_,
                                         [&](double c) { return motion_step_ / 16 * std::pow(n / c, 0.25); });
    const Eigen::MatrixXd displacement = Field(frame.planes[1], components_, counts_, basis_,
                                               [&](double c) { return displacement_step_ / 16 * std::sqrt(n / c); });
    const Eigen::MatrixXd detail = Field(frame.planes[2], patches_, patch_sizes, patch_basis_,
                                         [&](double c) { return detail_step_ / 16 / std::sqrt(c); });
    Eigen::MatrixXd y(vertices_, 3);
    for (std::uint32_t v = 0; v < vertices_; ++v) y.row(v) = origin_ + cell_ * Point(mesh_.grid[v]);
    // Normal equations of 6.5.3, by a solver that takes singular ones.
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(vertices_, vertices_), right = Eigen::MatrixXd::Zero(vertices_, 3);
    const auto j = [&](std::uint32_t v) {
      Eigen::Matrix3d p;
      p << motion(v, 3), motion(v, 6), motion(v, 7), motion(v, 6), motion(v, 4), motion(v, 8), motion(v, 7),
          motion(v, 8), motion(v, 5);
      const Eigen::Vector3d u = motion.row(v).head(3);
      return Eigen::Matrix3d(R(u) * (Eigen::Matrix3d::Identity() + p));
    };
    for (const auto& [edge, w] : TextWeights(mesh_)) {
      const auto [a, b] = edge;
      const Eigen::Vector3d pull = w * (j(a) + j(b)) / 2 * (y.row(a) - y.row(b)).transpose();
      matrix(a, a) += w;
      matrix(b, b) += w;
      matrix(a, b) -= w;
      matrix(b, a) -= w;
      right.row(a) += pull;
      right.row(b) -= pull;
    }
    Eigen::MatrixXd x = matrix.completeOrthogonalDecomposition().solve(right);
    for (const Component& c : components_) {
      const auto m = masses_.segment(c.first, c.count);
      const Eigen::RowVector3d shift =
          m.transpose() * (y.middleRows(c.first, c.count) - x.middleRows(c.first, c.count)) / m.sum();
      x.middleRows(c.first, c.count).rowwise() += shift;
    }
    x += displacement + detail;
    for (std::size_t v = 0; v < frame.planes[3].size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        x(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)) += frame.planes[3][v][a] * correction_step_ / 16;
      }
    }
    const Eigen::Vector3d centre = y.transpose() * masses_;
    const auto r = [&](std::size_t i) { return static_cast<double>(frame.rigid[i]); };
    const Eigen::Matrix3d rotation = R(rotation_step_ * Eigen::Vector3d(r(0), r(1), r(2)));
    const Eigen::Vector3d shift = translation_step_ * Eigen::Vector3d(r(3), r(4), r(5));
    for (std::uint32_t v = 0; v < vertices_; ++v) {
      const Eigen::Vector3d local = x.row(v).transpose() - centre;
      x.row(v) = rotation * local + centre + shift;
    }
    return x;
  }

  const Bytes& bytes_;
  std::array<Bytes, 2> starts_;              // payloads of the sequence header and of the I-frame
  std::vector<std::size_t> begins_;          // of groups
  std::vector<std::uint32_t> first_frames_;  // of groups
  std::int64_t growth_ = 0;
  std::uint32_t vertices_ = 0, harmonics_ = 0, patch_size_ = 0;
  Eigen::Vector3d origin_;
  double cell_ = 0, motion_step_ = 0, displacement_step_ = 0, detail_step_ = 0, correction_step_ = 0,
         rotation_step_ = 0, translation_step_ = 0;
  TextMesh mesh_;
  std::vector<std::uint32_t> counts_;
  std::vector<Component> components_, patches_;
  Eigen::VectorXd masses_;
  std::vector<Eigen::MatrixXd> basis_, patch_basis_;
  std::vector<Eigen::MatrixXd> frames_;
};

}  // namespace sac
