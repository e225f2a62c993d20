#pragma once

// Section 5.5 of spec.md read literally and slowly: the positions of a mesh, of which it searches all triangles for
// everything it wants to know. Of the codec it uses nothing.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "conformance/text_decoder.h"

namespace sac {

class TextPositions {
 public:
  using Point = std::array<std::int64_t, 3>;

  TextPositions(std::uint32_t vertices, const std::vector<Triangle>& triangles, std::int64_t position_step,
                std::int64_t position_slope, std::int64_t position_bits)
      : position_step_(position_step), position_slope_(position_slope), bits_(position_bits) {
    FindNeighbours(vertices, triangles);
    before_.fill(16 * (std::int64_t{1} << (bits_ - 1)));
  }

  // Grid positions of all vertices, or an empty list when one is off the grid.
  std::vector<Point> Read(TextDecoder& in) {
    for (const std::uint32_t v : Order()) {
      if (!ReadVertex(in, v)) return {};
    }
    std::vector<Point> grid;
    for (std::uint32_t v = 0; v < neighbours_.size(); ++v) {
      grid.push_back({x_.at(v)[0] / 16, x_.at(v)[1] / 16, x_.at(v)[2] / 16});
    }
    return grid;
  }

 private:
  static std::int64_t Floor(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
  static std::int64_t Bounded(std::int64_t x) { return std::clamp<std::int64_t>(x, -(1 << 20), 1 << 20); }
  static std::int64_t Root(std::int64_t x) {
    std::int64_t low = 0, high = std::int64_t{1} << 31;
    while (high - low > 1) {
      const std::int64_t middle = (low + high) / 2;
      (middle * middle <= x ? low : high) = middle;
    }
    return low;
  }
  static std::int64_t Square(const Point& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

  // 5.5.1
  void FindNeighbours(std::uint32_t vertices, const std::vector<Triangle>& triangles) {
    std::vector<std::set<std::uint32_t>> edges(vertices);
    for (const Triangle& t : triangles) {
      for (const std::uint32_t a : t) {
        for (const std::uint32_t b : t) {
          if (a != b) edges[a].insert(b);
        }
      }
    }
    const auto hub = [&](std::uint32_t v) { return edges[v].size() > 32; };
    neighbours_.resize(vertices);
    for (std::uint32_t a = 0; a < vertices; ++a) {
      for (const std::uint32_t b : edges[a]) {
        if (!hub(a) && !hub(b)) neighbours_[a].insert(b);
      }
    }
    for (const Triangle& t : triangles) {
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || hub(t[0]) || hub(t[1]) || hub(t[2])) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        across_[{std::min(a, b), std::max(a, b)}].insert(t[(k + 2) % 3]);
      }
    }
  }

  // 5.5.2
  std::vector<std::uint32_t> Order() const {
    std::vector<std::uint32_t> order;
    std::vector<std::size_t> count(neighbours_.size(), 0);
    std::set<std::uint32_t> coded;
    std::array<std::deque<std::uint32_t>, 9> queues;
    while (order.size() < neighbours_.size()) {
      std::int64_t next = -1;
      for (std::size_t k = 8; k > 0 && next < 0; --k) {
        while (!queues[k].empty() && next < 0) {
          const std::uint32_t v = queues[k].front();
          queues[k].pop_front();
          if (!coded.contains(v) && count[v] == k) next = v;
        }
      }
      for (std::uint32_t v = 0; next < 0; ++v) {
        if (!coded.contains(v)) next = v;
      }
      const auto v = static_cast<std::uint32_t>(next);
      order.push_back(v);
      coded.insert(v);
      for (const std::uint32_t w : neighbours_[v]) {
        if (coded.contains(w) || count[w] >= 8) continue;
        queues[++count[w]].push_back(w);
      }
    }
    return order;
  }

  bool Known(std::uint32_t v) const { return x_.contains(v); }

  bool ReadVertex(TextDecoder& in, std::uint32_t v) {
    // 5.5.3
    std::vector<std::uint32_t> k;
    for (const std::uint32_t b : neighbours_[v]) {
      if (Known(b)) k.push_back(b);
    }
    const auto number = static_cast<std::int64_t>(k.size());
    Point mean = before_, wide_mean = before_, parallelogram = before_, relaxed = before_, centre = before_, normal{};
    std::int64_t activity = 0, surrounding = 0, spread = 0, p = 0;
    if (number > 0) {
      Point sum{}, wide_sum{};
      std::int64_t wide = 0, lengths = 0;
      for (const std::uint32_t b : k) {
        activity += miss_[b];
        for (std::size_t a = 0; a < 3; ++a) sum[a] += x_[b][a];
        for (const std::uint32_t w : neighbours_[b]) {
          if (!Known(w)) continue;
          Point edge;
          for (std::size_t a = 0; a < 3; ++a) {
            wide_sum[a] += x_[w][a];
            edge[a] = x_[b][a] - x_[w][a];
          }
          lengths += Root(Square(edge));
          surrounding += miss_[w];
          ++wide;
        }
      }
      activity /= number;
      if (wide > 0) surrounding /= wide;
      if (wide > 0) length_ = lengths / wide;
      for (std::size_t a = 0; a < 3; ++a) {
        mean[a] = Floor(sum[a], number);
        wide_mean[a] = wide > 0 ? Floor(wide_sum[a], wide) : mean[a];
      }
      std::vector<Point> corners;
      for (const std::uint32_t a : k) {
        for (const std::uint32_t b : k) {
          if (a >= b || !across_.contains({a, b}) || !across_.at({a, b}).contains(v)) continue;
          for (const std::uint32_t c : across_.at({a, b})) {
            if (!Known(c) || corners.size() == 16) continue;
            Point corner, f, g;
            for (std::size_t i = 0; i < 3; ++i) {
              corner[i] = x_[a][i] + x_[b][i] - x_[c][i];
              f[i] = (x_[a][i] - x_[c][i]) / 16;
              g[i] = (x_[b][i] - x_[c][i]) / 16;
            }
            corners.push_back(corner);
            Point n = {f[1] * g[2] - f[2] * g[1], f[2] * g[0] - f[0] * g[2], f[0] * g[1] - f[1] * g[0]};
            while (std::abs(n[0]) >= 1 << 15 || std::abs(n[1]) >= 1 << 15 || std::abs(n[2]) >= 1 << 15) {
              for (std::int64_t& e : n) e /= 2;
            }
            const bool turned = n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2] < 0;
            for (std::size_t i = 0; i < 3; ++i) normal[i] += turned ? -n[i] : n[i];
          }
        }
      }
      p = static_cast<std::int64_t>(corners.size());
      parallelogram = mean;
      if (p > 0) {
        for (std::size_t a = 0; a < 3; ++a) {
          std::int64_t total = 0;
          for (const Point& corner : corners) total += corner[a];
          parallelogram[a] = Floor(total, p);
        }
        for (const Point& corner : corners) {
          for (std::size_t a = 0; a < 3; ++a) spread += std::abs(corner[a] - parallelogram[a]);
        }
        spread /= 3 * p;
        const std::int64_t s = Root(Square(normal));
        for (std::int64_t& e : normal) e = s != 0 ? e * 1024 / s : e;
      }
      relaxed = Relaxed(v, parallelogram);
    }
    // 5.5.5
    auto& weights = weights_
                        .try_emplace(8 * std::min<std::int64_t>(p, 4) + std::min<std::int64_t>(number, 7),
                                     std::array<std::int64_t, 3>{32768, 0, 0})
                        .first->second;
    const auto f = [&](std::size_t a) {
      return std::array{Bounded(relaxed[a] - parallelogram[a]), Bounded(mean[a] - parallelogram[a]),
                        Bounded(wide_mean[a] - parallelogram[a])};
    };
    const auto mixed = [&](std::size_t a) {
      return (weights[0] * f(a)[0] + weights[1] * f(a)[1] + weights[2] * f(a)[2]) >> 16;
    };
    for (std::size_t a = 0; a < 3 && number > 0; ++a) centre[a] = parallelogram[a] + mixed(a);
    const std::int64_t step = std::clamp<std::int64_t>((position_step_ + ((position_slope_ * length_) >> 12)) >> 4, 1,
                                                       std::int64_t{1} << (bits_ - 1));
    // 5.5.6
    std::array<std::size_t, 3> axes = {0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(normal[a]) < std::abs(normal[b]); });
    const std::int64_t t = normal[axes[2]], last = (std::int64_t{1} << bits_) - 1;
    std::array<std::int64_t, 3> o{};
    Point x{};
    std::int64_t along = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t axis = axes[j];
      std::int64_t towards = centre[axis];
      if (j == 2) {
        if (std::abs(t) > 307) {
          along = Bounded(Floor(-(t > 0 ? 1 : -1) * (normal[axes[0]] * o[0] + normal[axes[1]] * o[1]), std::abs(t)));
        }
        towards += (tangent_ * along) >> 16;
      }
      const std::int64_t expected = std::clamp<std::int64_t>((towards + 8) >> 4, 0, last);
      const std::int64_t before = j == 0 ? activity : j == 1 ? std::abs(o[0]) : (std::abs(o[0]) + std::abs(o[1])) / 2;
      const auto c = [&](std::int64_t length) {
        return std::min<std::int64_t>(Q(std::min<std::int64_t>(length / step, 1 << 20)), 23);
      };
      const auto axis_number = static_cast<std::int64_t>(j);
      const std::vector<std::vector<std::int64_t>> contexts = {
          {number == 0 ? 23 : c((activity + surrounding + before) / 3), axis_number},
          {c(before), axis_number},
          {c(spread), std::min<std::int64_t>(p, 4)},
          {std::min<std::int64_t>(number, 7), std::min<std::int64_t>(p, 4)}};
      const std::int64_t lean = relaxed[axis] - 16 * expected;
      const std::int64_t r = ReadResidual(in, contexts, axis_number, 2 * c(std::abs(lean)) + (lean < 0 ? 1 : 0));
      const std::int64_t at = expected + r * step;
      if (at < 0 || at > last) return false;
      x[axis] = 16 * at;
      o[j] = x[axis] - centre[axis];
    }
    // 5.5.7
    x_[v] = before_ = x;
    miss_[v] = (std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2])) / 3;
    if (number == 0) return true;
    const std::int64_t unit = Bounded(16 * step);
    if (std::abs(t) > 307) {
      const std::int64_t error = Bounded(o[2] - ((tangent_ * along) >> 16));
      tangent_ =
          std::clamp<std::int64_t>(tangent_ + error * along * 655 / (unit * unit + along * along), -(1 << 17), 1 << 17);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t error = Bounded(x[a] - parallelogram[a] - mixed(a));
      const auto fa = f(a);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t change = error * fa[i] * 655 / (unit * unit + fa[0] * fa[0] + fa[1] * fa[1] + fa[2] * fa[2]);
        weights[i] = std::clamp<std::int64_t>(weights[i] + change, -(1 << 18), 1 << 18);
      }
    }
    return true;
  }

  // 5.5.4
  Point Relaxed(std::uint32_t v, const Point& parallelogram) const {
    std::vector<std::uint32_t> u = {v};
    const auto given = [&](std::uint32_t w) { return Known(w) || std::count(u.begin(), u.end(), w) > 0; };
    std::size_t looked_at = 0;
    for (int round = 0; round < 2; ++round) {
      const std::size_t end = u.size();
      for (; looked_at < end; ++looked_at) {
        const std::uint32_t from = u[looked_at];
        for (const std::uint32_t w : neighbours_[from]) {
          if (!given(w) && u.size() < 24) u.push_back(w);
        }
      }
    }
    std::map<std::uint32_t, Point> y = x_;
    for (const std::uint32_t w : u) {
      Point sum{};
      std::int64_t count = 0;
      for (const std::uint32_t b : neighbours_[w]) {
        if (!Known(b)) continue;
        for (std::size_t a = 0; a < 3; ++a) sum[a] += x_.at(b)[a];
        ++count;
      }
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t m = count > 0 ? Floor(sum[a], count) : parallelogram[a];
        y[w][a] = w == v ? parallelogram[a] : Floor(parallelogram[a] + m, 2);
      }
    }
    const auto d = [&](std::uint32_t w) { return static_cast<std::int64_t>(neighbours_[w].size()); };
    for (int time = 0; time < 8; ++time) {
      for (const std::uint32_t w : u) {
        std::vector<std::uint32_t> middles = {w};
        for (const std::uint32_t c : neighbours_[w]) {
          if (given(c)) middles.push_back(c);
        }
        for (std::size_t a = 0; a < 3; ++a) {  // axes do not meet
          std::int64_t numerator = 0, denominator = 0;
          for (const std::uint32_t c : middles) {
            if (std::all_of(neighbours_[c].begin(), neighbours_[c].end(), given)) {
              const std::int64_t weight = 65536 / (d(c) * d(c));
              std::int64_t sum = 0;
              for (const std::uint32_t b : neighbours_[c]) sum += b == w ? 0 : y.at(b)[a];
              numerator += c == w ? weight * d(w) * sum : weight * (d(c) * y.at(c)[a] - sum);
              denominator += c == w ? weight * d(w) * d(w) : weight;
            }
            if (c != w) {
              const std::int64_t weight = 39322 / (d(w) + d(c));
              numerator += weight * y.at(c)[a];
              denominator += weight;
            }
          }
          y[w][a] = std::clamp<std::int64_t>(Floor(numerator, denominator), -(1 << 30), 1 << 30);
        }
      }
    }
    return y[v];
  }

  // 5.5.6
  std::int64_t ReadResidual(TextDecoder& in, const std::vector<std::vector<std::int64_t>>& contexts, std::int64_t j,
                            std::int64_t k) {
    const auto bin = [&](std::int64_t n) {
      std::vector<TextState*> states;
      for (std::size_t i = 0; i < contexts.size(); ++i) {
        std::vector<std::int64_t> key = contexts[i];
        key.insert(key.end(), {static_cast<std::int64_t>(i), n});
        states.push_back(&states_[key]);
      }
      const std::int64_t kind = std::min<std::int64_t>(n, 5);
      const TextMixer fresh = {16384, 16384, 16384, 16384, 0};
      return ReadMixed(
          in, {&first_.try_emplace(kind, fresh).first->second, &second_.try_emplace({kind, j}, fresh).first->second},
          states, {256});
    };
    if (!bin(0)) return 0;
    const bool negative = in.Bin(signs_[k]);
    std::int64_t magnitude = 1;
    while (magnitude < 15 && bin(magnitude)) ++magnitude;
    if (magnitude == 15) magnitude = 15 + static_cast<std::int64_t>(ReadUe(in, rest_));
    return negative ? -magnitude : magnitude;
  }

  std::int64_t position_step_, position_slope_, bits_;
  std::vector<std::set<std::uint32_t>> neighbours_;
  std::map<std::array<std::uint32_t, 2>, std::set<std::uint32_t>> across_;
  std::map<std::uint32_t, Point> x_;
  std::map<std::uint32_t, std::int64_t> miss_;
  std::map<std::int64_t, std::array<std::int64_t, 3>> weights_;  // by class
  std::int64_t tangent_ = 32768, length_ = 0;
  Point before_;  // the vertex coded before
  std::map<std::vector<std::int64_t>, TextState> states_;
  std::map<std::int64_t, TextMixer> first_;
  std::map<std::array<std::int64_t, 2>, TextMixer> second_;
  std::map<std::int64_t, TextModel> signs_;
  TextUe rest_;
};

}  // namespace sac
