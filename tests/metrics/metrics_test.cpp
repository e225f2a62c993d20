// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include "metrics/error_meter.h"

namespace sac {
namespace {

double Distance(const Vec3f& p, const Vec3f& q) {
  return std::hypot(double{p[0]} - q[0], double{p[1]} - q[1], double{p[2]} - q[2]);
}

using Clip = std::vector<Positions>;

// STEDs by its definition, with the edges near each vertex listed one by one.
double SlowSpatial(const std::vector<Triangle>& triangles, const Clip& a, const Clip& b) {
  const std::size_t n = a[0].size(), frames = a.size();
  double sum = 0;
  std::set<std::pair<std::size_t, std::size_t>> edges;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  }
  std::erase_if(edges, [](const auto& e) { return e.first == e.second; });
  for (std::size_t v = 0; v < n; ++v) {
    std::set<std::size_t> ball{v};
    for (const auto& [p, q] : edges) {
      if (p == v) ball.insert(q);
      if (q == v) ball.insert(p);
    }
    for (std::size_t f = 0; f < frames; ++f) {
      double weight = 0, mean = 0, variance = 0;
      for (const bool second_pass : {false, true}) {
        for (const auto& [p, q] : edges) {
          const double l = Distance(a[f][p], a[f][q]), k = Distance(b[f][p], b[f][q]);
          if (l == 0 || (!ball.contains(p) && !ball.contains(q))) continue;
          if (second_pass) {
            variance += l * std::pow((l - k) / l - mean / weight, 2) / weight;
          } else {
            weight += l;
            mean += l - k;
          }
        }
      }
      sum += std::sqrt(variance) / static_cast<double>(n * frames);
    }
  }
  return sum;
}

double SlowTemporal(const Clip& a, const Clip& b) {
  const std::size_t n = a[0].size(), frames = a.size();
  double sum_t = 0;
  double diameter = 0;
  for (const Vec3f& p : a[0]) {
    for (const Vec3f& q : a[0]) diameter = std::max(diameter, Distance(p, q));
  }
  for (std::size_t v = 0; v < n && frames > 1; ++v) {
    const auto speed = [&](const Clip& clip, int i) {
      return std::hypot(Distance(clip[i][v], clip[i + 1][v]) / diameter, 3e-4);
    };
    const int steps = static_cast<int>(frames) - 1;
    for (int i = 0; i < steps; ++i) {
      double sum = 0;
      int count = 0;
      for (int j = std::max(0, i - 4); j <= std::min(steps - 1, i + 5); ++j, ++count) sum += speed(a, j);
      sum_t += std::abs(speed(b, i) - speed(a, i)) / (sum / count) / (static_cast<double>(n) * steps);
    }
  }
  return sum_t;
}

// The metrics by their definitions, with all frames in memory.
DistortionMetrics SlowMetrics(const std::vector<Triangle>& triangles, const Clip& a, const Clip& b) {
  DistortionMetrics m;
  const std::size_t n = a[0].size(), frames = a.size();
  double error = 0, spread = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    for (int c = 0; c < 3; ++c) {
      double mean = 0;
      for (const Vec3f& p : a[f]) mean += p[c] / static_cast<double>(n);
      for (const Vec3f& p : a[f]) spread += (p[c] - mean) * (p[c] - mean);
    }
    for (std::size_t v = 0; v < n; ++v) {
      error += std::pow(Distance(a[f][v], b[f][v]), 2);
      m.max_error = std::max(m.max_error, Distance(a[f][v], b[f][v]));
    }
  }
  m.kg = 100 * std::sqrt(error / spread);

  m.sted_s = SlowSpatial(triangles, a, b);
  m.sted_t = SlowTemporal(a, b);
  m.sted = std::hypot(m.sted_s, 9.144e-5 * m.sted_t);
  m.frames = frames;
  return m;
}

DistortionMetrics Measure(const std::vector<Triangle>& triangles, const Clip& a, const Clip& b) {
  ErrorMeter meter(triangles, a[0].size());
  for (std::size_t f = 0; f < a.size(); ++f) meter.Add(a[f], b[f]);
  return meter.Result();
}

void ExpectNear(const DistortionMetrics& got, const DistortionMetrics& want, double relative) {
  EXPECT_NEAR(got.kg, want.kg, relative * want.kg);
  EXPECT_NEAR(got.sted, want.sted, relative * want.sted);
  EXPECT_NEAR(got.sted_s, want.sted_s, relative * want.sted_s);
  EXPECT_NEAR(got.sted_t, want.sted_t, relative * want.sted_t);
  EXPECT_NEAR(got.max_error, want.max_error, relative * want.max_error);
  EXPECT_EQ(got.frames, want.frames);
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::uint32_t Below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  float Symmetric() { return static_cast<float>(engine_() / 2147483648.0 - 1); }
  Positions Cloud(std::size_t n) {
    Positions p(n);
    for (Vec3f& q : p) q = {Symmetric(), Symmetric(), Symmetric()};
    return p;
  }
  Positions Noisy(Positions p, float amount) {
    for (Vec3f& q : p) {
      for (float& x : q) x += amount * Symmetric();
    }
    return p;
  }

 private:
  std::mt19937 engine_;
};

const std::vector<Triangle> kOneTriangle{{0, 1, 2}};

TEST(Kg, OfATranslation) {
  // A square with corners (+-1, +-1, 0) has the squared spread 8; four vertices are off by 5 each.
  const Positions square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  Positions moved = square;
  for (Vec3f& p : moved) p = {p[0] + 3, p[1], p[2] + 4};
  const DistortionMetrics m = Measure({{0, 1, 2}, {0, 2, 3}}, {square}, {moved});
  EXPECT_DOUBLE_EQ(m.kg, 100 * std::sqrt(100.0 / 8));
  EXPECT_EQ(m.max_error, 5);
  EXPECT_EQ(m.sted, 0);
}

TEST(Kg, KeepsItsDigitsFarFromTheOrigin) {
  const Positions far{{1e6f - 1, 0, 0}, {1e6f + 1, 0, 0}};
  const Positions moved{{1e6f - 1, 1, 0}, {1e6f + 1, 0, 0}};
  EXPECT_DOUBLE_EQ(Measure({}, {far}, {moved}).kg, 100 * std::sqrt(1.0 / 2));
}

TEST(Kg, WithoutSpreadIsZeroOrInfinite) {
  const Positions point(5, {1.1f, 2.3f, -7.7f});
  Positions moved = point;
  EXPECT_EQ(Measure(kOneTriangle, {point}, {moved}).kg, 0);
  moved[3][1] += 1;
  EXPECT_EQ(Measure(kOneTriangle, {point}, {moved}).kg, std::numeric_limits<double>::infinity());
}

TEST(Sted, OfOneTriangle) {
  // The edges of lengths 3, 4, 5 become 3, 5, 4: r = 0, -1/4, 1/5 with the weighted mean 0 and variance 0.45 / 12.
  const Positions before{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, after{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}};
  const double deviation = std::sqrt(0.45 / 12);
  EXPECT_NEAR(Measure(kOneTriangle, {before}, {after}).sted_s, deviation, 1e-15);
  EXPECT_EQ(Measure(kOneTriangle, {before}, {after}).sted_t, 0);

  // With an undistorted triangle and an isolated vertex beside it only three of seven vertices see that.
  Positions before7 = before, after7 = after;
  for (Positions* p : {&before7, &after7}) p->insert(p->end(), {{9, 0, 0}, {8, 2, 0}, {9, 3, 1}, {5, 5, 5}});
  EXPECT_NEAR(Measure({{0, 1, 2}, {4, 3, 5}}, {before7}, {after7}).sted_s, deviation * 3 / 7, 1e-15);
}

TEST(Sted, ReachesTheEdgesOfNeighbours) {
  // A path 0-1-2-3-4 of degenerate triangles. Only edge 3-4 changes: vertices 2 (through 3), 3 and 4 see it, 0 and 1 do
  // not.
  const std::vector<Triangle> path{{0, 1, 1}, {1, 2, 1}, {2, 3, 2}, {3, 4, 4}};
  const Positions before{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  Positions after = before;
  after[4][0] = 5;  // r = -1
  // Near 2 are all four edges, near 3 edges 1-2, 2-3, 3-4, near 4 the last two. One of k equal weights: sqrt(1/k -
  // 1/k^2).
  const double sum = std::sqrt(3.0 / 16) + std::sqrt(2.0 / 9) + 0.5;
  EXPECT_NEAR(Measure(path, {before}, {after}).sted_s, sum / 5, 1e-15);
}

TEST(Sted, IgnoresUniformScaling) {
  Random random(3);
  Positions p = random.Cloud(20), q = p;
  for (Vec3f& x : q) x = {2 * x[0], 2 * x[1], 2 * x[2]};
  std::vector<Triangle> t;
  for (int i = 0; i < 40; ++i) t.push_back({random.Below(20), random.Below(20), random.Below(20)});
  EXPECT_EQ(Measure(t, {p}, {q}).sted_s, 0);
}

TEST(Sted, CountsAStepAgainstThePause) {
  // The original rests, so that its speed is dt; a step of sqrt(3) dt D makes the decoded speed 2 dt, in one of the two
  // steps of one of the two vertices.
  const Positions still{{0, 0, 0}, {0, 4096, 0}};
  Positions moved = still;
  moved[0][0] = static_cast<float>(std::sqrt(3.0) * 3e-4 * 4096);
  const DistortionMetrics m = Measure({{0, 1, 1}}, {still, still, still}, {still, moved, moved});
  EXPECT_NEAR(m.sted_t, 0.25, 1e-7);
  EXPECT_NEAR(m.sted, std::hypot(m.sted_s, 9.144e-5 * m.sted_t), 1e-15);
}

TEST(ErrorMeter, AgreesWithTheDefinitions) {
  Random random(1);
  for (const std::size_t frames : {1, 2, 3, 5, 6, 7, 10, 11, 12, 25}) {
    const std::uint32_t n = 3 + random.Below(30);
    std::vector<Triangle> t;
    for (std::uint32_t i = random.Below(3 * n); i > 0; --i) {
      const std::uint32_t hub = random.Below(4) == 0 ? 0 : random.Below(n);
      t.push_back({hub, random.Below(n), random.Below(n)});
      if (random.Below(5) == 0) t.push_back({t.back()[1], t.back()[0], t.back()[2]});
    }
    Clip a, b;
    Positions p = random.Cloud(n);
    for (std::size_t f = 0; f < frames; ++f) {
      p = random.Noisy(std::move(p), 0.1f);
      p[n - 1] = p[n - 2];  // an edge between them has no length
      a.push_back(p);
      b.push_back(random.Noisy(p, f % 3 == 0 ? 0 : 0.01f));
    }
    ExpectNear(Measure(t, a, b), SlowMetrics(t, a, b), 1e-12);
  }
}

TEST(ErrorMeter, FindsASmallSpreadUnderALargeChange) {
  Random random(2);
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < 60; ++i) t.push_back({i % 20, random.Below(20), random.Below(20)});
  const Positions p = random.Cloud(20);
  Positions q = p;
  for (Vec3f& x : q)
    x = {1.5f * x[0], 1.5f * x[1], 1.5f * x[2]};  // exact but for the last bit: r is -0.5 almost everywhere
  const DistortionMetrics want = SlowMetrics(t, {p}, {q});
  EXPECT_LT(want.sted_s, 1e-6);
  ExpectNear(Measure(t, {p}, {q}), want, 1e-6);
}

TEST(ErrorMeter, ResultsInBetweenAreThoseOfTheShorterClip) {
  Random random(4);
  const Positions p = random.Cloud(6);
  ErrorMeter meter({{0, 1, 2}, {2, 3, 4}}, 6);
  Clip a, b;
  for (int f = 0; f < 14; ++f) {
    a.push_back(random.Noisy(p, 0.2f));
    b.push_back(random.Noisy(a.back(), 0.1f));
    meter.Add(a.back(), b.back());
    ExpectNear(meter.Result(), SlowMetrics({{0, 1, 2}, {2, 3, 4}}, a, b), 1e-12);
  }
}

TEST(ErrorMeter, TakesEmptyInputs) {
  for (const std::size_t n : {0, 1}) {
    ErrorMeter meter({}, n);
    for (int frames = 0; frames < 3; ++frames) {
      const DistortionMetrics m = meter.Result();
      EXPECT_EQ(std::max({m.kg, m.sted, m.sted_s, m.sted_t, m.max_error}), 0);
      EXPECT_EQ(m.frames, frames);
      meter.Add(Positions(n), Positions(n));
    }
  }
}

TEST(ErrorMeter, PassesOnNaN) {
  const Positions good(3, {1, 2, 3});
  Positions bad = good;
  bad[1][1] = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [a, b] : {std::pair{good, bad}, std::pair{bad, good}}) {
    const DistortionMetrics m = Measure(kOneTriangle, {a, good}, {b, good});
    EXPECT_TRUE(std::isnan(m.max_error));
    EXPECT_TRUE(std::isnan(m.kg));
  }
}

TEST(ErrorMeter, SeamGapIsOfVerticesThatCoincideInEveryFrame) {
  const Positions original{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  Positions parts = original, decoded = original;
  ErrorMeter meter({}, 5);
  decoded[2] = {0, 3, 4};    // 5 from vertex 0
  decoded[3] = {1, 0, 100};  // parts from vertex 1 later
  meter.Add(original, decoded);
  EXPECT_DOUBLE_EQ(meter.Result().seam_gap, 100);
  parts[3] = {1, 0, 1};
  meter.Add(parts, parts);
  EXPECT_DOUBLE_EQ(meter.Result().seam_gap, 5);
}

TEST(ErrorMeter, PartsAreMeasuredAgainstTheirOwnSize) {
  // A triangle of size 1 beside one of size 1000, and a vertex without extent.
  const Positions original{{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}};
  Positions decoded = original;
  decoded[1][2] = 10;
  decoded[4][2] = 0.5;
  decoded[6][0] = 10;
  ErrorMeter meter({{0, 1, 2}, {3, 4, 5}}, 7);
  meter.Add(original, decoded);
  const PartDistortion worst = meter.Result().worst_part;
  EXPECT_EQ(worst.first_vertex, 3u);
  EXPECT_EQ(worst.vertices, 3u);
  EXPECT_DOUBLE_EQ(worst.max_error, 0.5);
  // About their mean (16/3, 1/3) the vertices have squared distances of 2/9, 5/9 and 5/9.
  EXPECT_NEAR(worst.kg, 100 * std::sqrt(0.25 / (12.0 / 9)), 1e-9);
}

TEST(ErrorMeter, GoesOnWithAnotherMesh) {
  std::mt19937 random(5);
  std::normal_distribution<float> number;
  const auto clip = [&](std::size_t vertices, std::size_t frames) {
    Clip c(frames, Positions(vertices));
    for (Positions& frame : c) {
      for (Vec3f& p : frame) p = {number(random), number(random), number(random)};
    }
    return c;
  };
  const std::vector<Triangle> one = {{0, 1, 2}, {1, 2, 3}}, other = {{0, 1, 2}, {2, 3, 4}, {0, 3, 4}};
  const Clip a = clip(4, 3), b = clip(4, 3), c = clip(5, 6), d = clip(5, 6);
  ErrorMeter both(one, 4), first(one, 4), second(other, 5);
  KgError kg;
  for (std::size_t f = 0; f < 3; ++f) {
    both.Add(a[f], b[f]);
    first.Add(a[f], b[f]);
    kg.Add(a[f], b[f]);
  }
  both.BeginMesh(other, 5);
  for (std::size_t f = 0; f < 6; ++f) {
    both.Add(c[f], d[f]);
    second.Add(c[f], d[f]);
    kg.Add(c[f], d[f]);
  }
  const DistortionMetrics m = both.Result(), m1 = first.Result(), m2 = second.Result();
  EXPECT_EQ(m.frames, 9u);
  EXPECT_DOUBLE_EQ(m.kg, kg.Value());
  EXPECT_DOUBLE_EQ(m.sted_s, std::sqrt((3 * m1.sted_s * m1.sted_s + 6 * m2.sted_s * m2.sted_s) / 9));
  EXPECT_DOUBLE_EQ(m.sted_t, std::sqrt((3 * m1.sted_t * m1.sted_t + 6 * m2.sted_t * m2.sted_t) / 9));
  EXPECT_DOUBLE_EQ(m.max_error, std::max(m1.max_error, m2.max_error));
  EXPECT_DOUBLE_EQ(m.worst_part.kg, std::max(m1.worst_part.kg, m2.worst_part.kg));
}

}  // namespace
}  // namespace sac
