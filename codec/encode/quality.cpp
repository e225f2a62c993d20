#include "codec/encode/quality.h"

#include <cmath>

namespace sac {

QualitySettings SettingsOfQuality(double quality) {
  const double t = quality / 100;
  return {0.03 * std::pow(0.05, 2 * (t - 0.5)), 0.001 * std::pow(0.05, 2 * (t - 0.5)),
          static_cast<int>(std::lround(8 + 4 * t))};
}

}  // namespace sac
