// SPDX-License-Identifier: Apache-2.0
#include "cli/component_count.h"

#include <algorithm>
#include <string>
#include <utility>

namespace sac {
namespace {

constexpr std::uint32_t kFirst = 8, kMost = 1024;

}  // namespace

Status DecomposeToError(ClipReader& clip, const DecompositionSettings& settings, double erms, SparseComponents& result,
                        DecompositionReport& report, ReconstructionError& error, std::uint32_t& decompositions) {
  DecompositionSettings trial = settings;
  const auto decompose = [&](std::uint32_t count, SparseComponents& components, DecompositionReport& found,
                             ReconstructionError& measured) -> Status {
    trial.count = count;
    ++decompositions;
    SAC_RETURN_IF_ERROR(DecomposeClip(clip, trial, components, found));
    return MeasureComponents(clip, components, measured);
  };
  const auto strokes = static_cast<std::uint32_t>(settings.strokes.size());
  std::uint32_t count = std::max(kFirst, strokes), failed = strokes > 0 ? strokes - 1 : 0;
  for (;; failed = count, count = std::min(kMost, count + count / 2)) {
    SAC_RETURN_IF_ERROR(decompose(count, result, report, error));
    if (error.erms <= erms) break;
    if (count == kMost) {
      return Status::InvalidArgument(clip.name() + ": " + std::to_string(count) + " components leave an Erms of " +
                                     std::to_string(error.erms) + "; a smaller --locality leaves less");
    }
  }
  while (count - failed > std::max(1u, count / 10)) {
    const std::uint32_t middle = failed + (count - failed) / 2;
    SparseComponents components;
    DecompositionReport found;
    ReconstructionError measured;
    SAC_RETURN_IF_ERROR(decompose(middle, components, found, measured));
    if (measured.erms > erms) {
      failed = middle;
      continue;
    }
    count = middle;
    result = std::move(components);
    report = std::move(found);
    error = measured;
  }
  return Status::Ok();
}

}  // namespace sac
