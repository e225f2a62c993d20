// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "files/byte_order.h"

namespace sac {
namespace {

// The period that stands for samples with times of their own.
constexpr double kAcyclic = std::numeric_limits<double>::max() / 32;
constexpr double kNear = 1e-4;

}  // namespace

double AlembicTimeSampling::Time(std::uint32_t sample) const {
  if (acyclic) return times[std::min<std::size_t>(sample, times.size() - 1)];
  const auto count = static_cast<std::uint32_t>(times.size());
  return times[sample % count] + period * (sample / count);
}

AlembicMoment AlembicTimeSampling::At(double time, std::uint32_t samples) const {
  // The last sample that is not after the time, by halving: exact whatever the rounding of periods.
  std::uint32_t low = 0, high = samples;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (Time(middle) <= time ? low : high) = middle;
  }
  if (low + 1 >= samples || time <= Time(low)) return {low, low, 0};
  const double step = Time(low + 1) - Time(low), weight = (time - Time(low)) / step;
  if (!(weight > kNear)) return {low, low, 0};
  if (weight > 1 - kNear) return {low + 1, low + 1, 0};
  return {low, low + 1, weight};
}

double AlembicTimeSampling::Rate(std::uint32_t samples) const {
  double rate = 0;
  if (!acyclic) {
    rate = 1 / period;
  } else if (samples > 1) {
    const double span = Time(samples - 1) - Time(0);
    rate = span > 0 ? (samples - 1) / span : 0;
  }
  return std::isfinite(rate) ? rate : 0;
}

Status ParseAlembicTimes(std::string_view bytes, std::vector<AlembicTimeSampling>& samplings) {
  const auto bad = [](const std::string& what) { return Status::Corrupt("its list of times " + what); };
  samplings.clear();
  while (!bytes.empty()) {
    if (bytes.size() < 16) return bad("is cut short");
    AlembicTimeSampling sampling;
    sampling.period = LoadLittleDouble(bytes.data() + 4);
    sampling.acyclic = sampling.period == kAcyclic;
    const std::uint64_t count = LoadLittle32(bytes.data() + 12);
    bytes.remove_prefix(16);
    if (count == 0 || count > bytes.size() / 8) return bad("is cut short");
    for (std::uint64_t i = 0; i < count; ++i) sampling.times.push_back(LoadLittleDouble(bytes.data() + 8 * i));
    bytes.remove_prefix(static_cast<std::size_t>(8 * count));
    for (std::size_t i = 0; i < sampling.times.size(); ++i) {
      if (!std::isfinite(sampling.times[i])) return bad("has a time that is not finite");
      if (i > 0 && sampling.times[i] < sampling.times[i - 1]) return bad("has times that go back");
    }
    const double span = sampling.times.back() - sampling.times.front();
    if (!sampling.acyclic && !(sampling.period > 0 && std::isfinite(sampling.period) && span < sampling.period)) {
      return bad("has a period that is not positive, or shorter than its times");
    }
    samplings.push_back(std::move(sampling));
  }
  return samplings.empty() ? bad("is empty") : Status::Ok();
}

}  // namespace sac
