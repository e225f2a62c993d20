// SPDX-License-Identifier: Apache-2.0
#include "format/residual_contexts.h"

#include <algorithm>
#include <cstdlib>

#include "format/logistic.h"

namespace sac {

constexpr LogisticTables kLogisticTables;

namespace {

constexpr std::size_t kRows = 1024;  // with contexts of their own

std::uint32_t Magnitude(std::int32_t residual) { return static_cast<std::uint32_t>(std::abs(residual)); }

int Sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

std::uint8_t Class(std::uint32_t value, std::uint32_t max_class) {
  return static_cast<std::uint8_t>(std::min(HalfOctave(value), max_class));
}

}  // namespace

ResidualContexts::ResidualContexts(const PlaneLayout& layout)
    : layout_(layout),
      channels_(layout.channels),
      places_(layout.size()),
      recent_(layout.size()),
      magnitudes_(layout.size() + 4 * layout.channels),
      signs_(layout.size() + layout.channels) {
  const std::size_t rows = std::min(layout.row_classes.size(), kRows);
  sizes_ = {20 * kLevels * 2, 16 * 14, 24 * channels_ * kLevels, rows * kLevels, channels_ * kLevels, rows * channels_};
}

void ResidualContexts::Start(std::uint32_t level, std::int32_t step, std::size_t plane,
                             const ReferenceFrames& references, std::span<const std::int32_t> first,
                             std::span<const std::int32_t> second) {
  level_ = std::min<std::size_t>(level, kLevels - 1);
  step_ = step;
  next_ = 0;
  const std::size_t size = places_.size();
  const auto unsigned_step = static_cast<std::uint32_t>(step);
  const auto both = [&](std::size_t i) { return Magnitude(first[i]) + Magnitude(second[i]); };
  for (std::size_t i = 0; i < size; ++i) {
    Place& place = places_[i];
    const bool has_above = i >= channels_, has_below = i + channels_ < size;
    place = {};
    const std::uint32_t here = both(i);
    place.touched = here > 0;
    place.around = 4 * here + 2 * ((has_above ? both(i - channels_) : 0) + (has_below ? both(i + channels_) : 0));
    // All of these are 0 most often.
    const auto recent = static_cast<std::uint32_t>(recent_[i]);
    if (recent > 0) place.recent = Class(4 * recent / unsigned_step, 19);
    const auto beside =
        static_cast<std::uint32_t>((has_above ? recent_[i - channels_] : 0) + (has_below ? recent_[i + channels_] : 0));
    if (recent + beside > 0) place.recent_around = Class((16 * recent + 4 * beside) / unsigned_step, 63);
    place.reference_sign = static_cast<std::uint8_t>(Sign(Sign(first[i]) + Sign(second[i])) + 1);
    place.bend_sign = 8;
    if (!references.first) continue;
    const std::int64_t a = references.first->planes[plane][i], b = references.second->planes[plane][i];
    if (a != b) {
      place.spread = Class(static_cast<std::uint32_t>(16 * std::abs(a - b) / step), 63);
    }
    const std::int64_t bend = references.Bend(plane, i);
    if (bend != 0) {
      const auto size_of_bend = static_cast<std::uint32_t>(std::min<std::int64_t>(std::abs(bend), 1 << 30));
      place.bend = Class(size_of_bend / (2 * unsigned_step), 11);
      place.bend_sign = static_cast<std::uint8_t>(8 + Sign(bend) * std::min<int>(place.bend, 8));
    }
  }
}

ResidualContext ResidualContexts::Next() {
  const std::size_t i = next_, row = i / channels_, channel = i % channels_;
  if (channel == 0) before_ = 0;
  const Place& place = places_[i];
  const std::uint32_t* above = &magnitudes_[i];  // four rows up
  const std::uint32_t near = 12 * above[3 * channels_] + 6 * above[2 * channels_] + 3 * above[channels_] + 3 * above[0];
  const std::uint32_t before = channel > 0 ? 24 * before_ / static_cast<std::uint32_t>(channel) : 0;
  const std::size_t own_row = std::min(row, kRows - 1);
  const auto feature = [](std::uint32_t value_class, std::int32_t offset) {
    return 64 * static_cast<std::int32_t>(value_class) - offset;
  };
  ResidualContext context;
  context.states = {(place.recent * kLevels + level_) * 2 + (place.touched ? 1 : 0),
                    Class(near / 3, 15) * std::size_t{14} + Class(before / 6, 13),
                    (layout_.row_classes[row] * channels_ + channel) * kLevels + level_,
                    own_row * kLevels + level_,
                    channel * kLevels + level_,
                    own_row * channels_ + channel};
  context.features = {256,
                      feature(place.recent_around, 512),
                      feature(place.spread, 512),
                      feature(HalfOctave(near), 256),
                      feature(place.bend, 256),
                      128 * static_cast<std::int32_t>(level_) - 256};
  context.level = level_;
  context.activity = Class((near + place.around + before) / 2, kActivities - 1);
  const auto sign_above = static_cast<std::size_t>(signs_[i] + 1);
  context.sign_states = {place.bend_sign * kLevels + level_,
                         (place.reference_sign * std::size_t{3} + sign_above) * kLevels + level_};
  return context;
}

void ResidualContexts::Put(std::int32_t residual) {
  const std::uint32_t magnitude = Magnitude(residual);
  magnitudes_[next_ + 4 * channels_] = magnitude;
  signs_[next_ + channels_] = static_cast<std::int8_t>(Sign(residual));
  before_ += magnitude;
  ++next_;
}

void ResidualContexts::Finish(std::span<const std::int32_t> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto size = std::min<std::int64_t>(std::abs(std::int64_t{values[i]} * step_), 1 << 20);
    recent_[i] += (4 * static_cast<std::int32_t>(size) - recent_[i]) >> 3;
  }
}

}  // namespace sac
