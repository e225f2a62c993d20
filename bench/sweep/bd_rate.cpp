// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/bd_rate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sac {
namespace {

// The monotone piecewise cubic of Fritsch and Carlson 1980 with Fritsch and Butland's slopes (1984): MATLAB's pchip.
class MonotoneCubic {
 public:
  // `x` must ascend and have at least two values.
  MonotoneCubic(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)), slope_(x_.size()) {
    const std::size_t last = x_.size() - 1;
    if (last == 1) {
      slope_[0] = slope_[1] = Secant(0);
      return;
    }
    for (std::size_t i = 1; i < last; ++i) slope_[i] = Inner(i);
    slope_[0] = Outer(Width(0), Width(1), Secant(0), Secant(1));
    slope_[last] = Outer(Width(last - 1), Width(last - 2), Secant(last - 1), Secant(last - 2));
  }

  double low() const { return x_.front(); }
  double high() const { return x_.back(); }

  double Integral(double from, double to) const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
      const double a = std::max(from, x_[i]), b = std::min(to, x_[i + 1]);
      // Simpson's rule is exact for cubics.
      if (a < b) sum += (b - a) / 6 * (At(i, a) + 4 * At(i, (a + b) / 2) + At(i, b));
    }
    return sum;
  }

 private:
  double Width(std::size_t i) const { return x_[i + 1] - x_[i]; }
  double Secant(std::size_t i) const { return (y_[i + 1] - y_[i]) / Width(i); }

  double Inner(std::size_t i) const {
    const double before = Secant(i - 1), after = Secant(i);
    if (before * after <= 0) return 0;
    const double w1 = 2 * Width(i) + Width(i - 1), w2 = Width(i) + 2 * Width(i - 1);
    return (w1 + w2) / (w1 / before + w2 / after);
  }

  static double Outer(double h0, double h1, double s0, double s1) {
    const double slope = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (slope * s0 <= 0) return 0;
    return s0 * s1 <= 0 && std::abs(slope) > 3 * std::abs(s0) ? 3 * s0 : slope;
  }

  double At(std::size_t i, double x) const {
    const double h = Width(i), t = (x - x_[i]) / h;
    return y_[i] * (1 + 2 * t) * (1 - t) * (1 - t) + slope_[i] * h * t * (1 - t) * (1 - t) +
           y_[i + 1] * t * t * (3 - 2 * t) + slope_[i + 1] * h * t * t * (t - 1);
  }

  std::vector<double> x_, y_, slope_;
};

// The curve of the logarithm of the rate over that of the distortion, empty with fewer than two points.
std::optional<MonotoneCubic> CurveOf(std::vector<RatePoint> points) {
  std::sort(points.begin(), points.end(), [](const RatePoint& a, const RatePoint& b) {
    return a.rate != b.rate ? a.rate < b.rate : a.distortion < b.distortion;
  });
  std::vector<double> x, y;
  for (const RatePoint& p : points) {
    if (!(p.rate > 0 && p.distortion > 0 && std::isfinite(p.distortion))) continue;
    const double at = std::log(p.distortion);
    if (!x.empty() && at >= x.back()) continue;
    x.push_back(at);
    y.push_back(std::log(p.rate));
  }
  if (x.size() < 2) return std::nullopt;
  std::reverse(x.begin(), x.end());
  std::reverse(y.begin(), y.end());
  return MonotoneCubic(x, y);
}

}  // namespace

std::optional<BdRate> BjontegaardRate(const std::vector<RatePoint>& reference, const std::vector<RatePoint>& other) {
  const std::optional<MonotoneCubic> a = CurveOf(reference), b = CurveOf(other);
  if (!a || !b) return std::nullopt;
  const double low = std::max(a->low(), b->low()), high = std::min(a->high(), b->high());
  if (!(low < high)) return std::nullopt;
  const double difference = (b->Integral(low, high) - a->Integral(low, high)) / (high - low);
  return BdRate{100 * std::expm1(difference), std::exp(low), std::exp(high)};
}

}  // namespace sac
