#include "codec/encode/quality.h"

#include <array>
#include <cmath>

namespace sac {
namespace {

// docs/quality.md has the figures these rows give. Detail sets in where the smooth planes buy nothing more.
constexpr std::array<QualitySettings, 9> kTable = {{
    {0, 0.15, 0.008, 0, 7.4},
    {10, 0.08, 0.004, 0, 8.4},
    {25, 0.05, 0.0022, 0, 9.3},
    {50, 0.03, 0.0012, 0, 10.3},
    {60, 0.02, 0.0006, 0, 11.3},
    {70, 0.02, 0.0005, 0.01, 11.6},
    {80, 0.02, 0.0005, 0.005, 12},
    {90, 0.02, 0.0005, 0.002, 12.6},
    {100, 0.015, 0.0004, 0.0004, 14.4},
}};

// Before this part of the way from none to some, detail steps are so coarse that nothing would be coded.
constexpr double kLeastDetail = 0.02;

}  // namespace

QualitySettings SettingsOfQuality(double quality) {
  std::size_t i = 1;
  while (i + 1 < kTable.size() && kTable[i].quality < quality) ++i;
  const QualitySettings &low = kTable[i - 1], &high = kTable[i];
  const double t = (quality - low.quality) / (high.quality - low.quality);
  // Steps matter by their ratio.
  const auto between = [t](double a, double b) {
    if (a == 0) return t < kLeastDetail ? 0.0 : b / t;  // detail fades in from an infinite step
    return a * std::pow(b / a, t);
  };
  return {quality, between(low.motion_step, high.motion_step), between(low.displacement_step, high.displacement_step),
          between(low.detail_step, high.detail_step), low.position_bits + t * (high.position_bits - low.position_bits)};
}

}  // namespace sac
