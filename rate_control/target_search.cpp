// SPDX-License-Identifier: Apache-2.0
#include "rate_control/target_search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <sstream>
#include <vector>

#include "codec/encode/quality.h"
#include "rate_control/proposal.h"
#include "rate_control/rate_model.h"
#include "rate_control/search_point.h"

namespace sac {
namespace {

// Excess, cost and their differences are natural logarithms.
constexpr double kBand = 0.0304;  // a figure of at least 97 % of its target is near it
// The excess that proposals aim at is below 0, so that the error of the prediction does not exceed the target. It falls
// by kAim with each trial in a row that exceeded the target, down to kFarthestAim.
constexpr double kAim = -0.004, kFarthestAim = -0.024;
constexpr double kGain = 0.0025;   // a predicted gain in cost below this times the number of trials ends the search
constexpr double kFar = 0.15;      // farther from the targets than this, only the quality changes
constexpr double kBehind = 0.1;    // a mode whose predicted cost is higher than the other's by this is given up
constexpr double kHopeless = 0.3;  // a predicted excess above this at the finest point ends a mode
constexpr int kMostTrials = 12;    // trials in a mode
// Detail is tried after the smooth planes when their best quality is above kSmoothWins. After detail, the smooth planes
// are tried when its best quality is below kDetailWins.
constexpr double kSmoothWins = 62, kDetailWins = 84;

// When decoders refuse a number of harmonics, kFewer times as many are tried, as long as it exceeded kFewestHarmonics.
constexpr double kFewer = 0.9, kFewestHarmonics = 20;

double LogRatio(double figure, double target) { return std::log(std::max(figure, 1e-12) / target); }

class Search {
 public:
  Search(const RateTargets& targets, const EncoderSettings& base, const Mesh& mesh,
         const std::function<Status(Trial&)>& run)
      : targets_(targets),
        base_(base),
        max_harmonics_(MostHarmonics(static_cast<std::uint32_t>(mesh.positions.size()))),
        bits_of_density_(BitsOfDensity(mesh)),
        run_(run),
        free_{targets.kg && targets.sted, true, !base.harmonics, targets.kg && targets.sted ? 1.0 : 0.6} {}

  Status Run(Trial& best);

 private:
  struct Tried {
    SearchPoint point;
    bool detail;
    Trial trial;
  };

  bool BoundsDistortion() const { return targets_.kg || targets_.sted; }
  // The largest logarithm of the ratio of a bounded figure to its target. The targets are met when it is at most 0.
  double Excess(const RateFigures& figures) const;
  // What is minimized among the trials that meet the targets, as a logarithm: the bytes when an error is bounded,
  // otherwise the product of the errors.
  double Cost(const RateFigures& figures) const;
  RateFigures FiguresOf(const Trial& t) const { return {static_cast<double>(t.bytes), t.kg, t.sted}; }
  // The cost of a trial, plus its excess times the cost that it takes to reduce the excess. Less is better.
  double Merit(const Tried& tried) const;

  SearchPoint Extreme(const CodingMode& mode) const;
  Status SearchMode(const CodingMode& mode, double quality);
  Status Evaluate(const SearchPoint& point, const CodingMode& mode);
  OperatingPoint Point(const SearchPoint& point, const CodingMode& mode) const {
    return PointOf(point, mode, base_.harmonics.value_or(0), max_harmonics_, bits_of_density_);
  }
  // The cheapest trial of a mode that meets the targets, null when there is none.
  const Tried* Best(bool detail) const;
  Status Choose(Trial& best) const;
  Status Unreachable() const;

  const RateTargets& targets_;
  const EncoderSettings& base_;
  double max_harmonics_;  // largest number of harmonics that is worth trying and that decoders allow
  const double bits_of_density_;
  const std::function<Status(Trial&)>& run_;
  const FreePlace free_;
  std::deque<Tried> tried_;
  double bytes_of_bpvf_ = 0;  // bytes for one bit per vertex and frame; known from the first trial on
};

double Search::Excess(const RateFigures& figures) const {
  if (!BoundsDistortion()) return LogRatio(figures.bytes, *targets_.bpvf * bytes_of_bpvf_);
  double largest = -std::numeric_limits<double>::infinity();
  if (targets_.kg) largest = std::max(largest, LogRatio(figures.kg, *targets_.kg));
  if (targets_.sted) largest = std::max(largest, LogRatio(figures.sted, *targets_.sted));
  return largest;
}

double Search::Cost(const RateFigures& figures) const {
  return BoundsDistortion() ? std::log(figures.bytes) : LogRatio(figures.kg, 1) + LogRatio(figures.sted, 1);
}

double Search::Merit(const Tried& tried) const {
  const RateFigures figures = FiguresOf(tried.trial);
  return Cost(figures) + (BoundsDistortion() ? 2 : 10) * std::max(0.0, Excess(figures));
}

Status Search::Evaluate(const SearchPoint& point, const CodingMode& mode) {
  Trial trial;
  trial.point = Point(point, mode);
  trial.settings = SettingsOf(trial.point, point.quality, base_);
  Status status = run_(trial);
  while (status.code() == StatusCode::kLimit && !base_.harmonics && trial.point.harmonics > kFewestHarmonics) {
    max_harmonics_ = kFewer * trial.point.harmonics;
    trial.point = Point(point, mode);
    trial.settings = SettingsOf(trial.point, point.quality, base_);
    status = run_(trial);
  }
  SAC_RETURN_IF_ERROR(status);
  bytes_of_bpvf_ = static_cast<double>(trial.bytes) / trial.bpvf;
  tried_.push_back({point, mode.detail, trial});
  return Status::Ok();
}

const Search::Tried* Search::Best(bool detail) const {
  const Tried* best = nullptr;
  for (const Tried& t : tried_) {
    if (t.detail != detail || Excess(FiguresOf(t.trial)) > 0) continue;
    if (!best || Cost(FiguresOf(t.trial)) < Cost(FiguresOf(best->trial))) best = &t;
  }
  return best;
}

Status Search::SearchMode(const CodingMode& mode, double quality) {
  SearchPoint next;
  next.quality = std::clamp(quality, mode.min_quality, mode.max_quality);
  int misses = 0;
  for (int i = 1;; ++i) {
    SAC_RETURN_IF_ERROR(Evaluate(next, mode));
    if (i == kMostTrials) return Status::Ok();
    std::vector<const Trial*> trials;
    const Tried* centre = nullptr;
    for (const Tried& t : tried_) {
      if (t.detail != mode.detail) continue;
      trials.push_back(&t.trial);
      if (!centre || Merit(t) < Merit(*centre)) centre = &t;
    }
    const RateModel model(trials, centre->trial);
    const auto predict = [&](const SearchPoint& point) { return model.Predict(Point(point, mode)); };
    misses = Excess(FiguresOf(tried_.back().trial)) > 0 ? misses + 1 : 0;
    const double aim = std::max((1 + misses) * kAim, kFarthestAim);
    const bool far = std::abs(Excess(FiguresOf(centre->trial))) > kFar;
    const FreePlace free = far ? FreePlace{false, false, false, 0} : free_;
    const ProposalProblem problem{[&](const SearchPoint& p) { return Excess(predict(p)) - aim; },
                                  [&](const SearchPoint& p) { return Cost(predict(p)); },
                                  !BoundsDistortion(),
                                  mode,
                                  free,
                                  far ? 35.0 : 14.0};
    const Tried* best = Best(mode.detail);
    if (!best && BoundsDistortion() && problem.excess(Extreme(mode)) > (i == 1 ? 3 * kHopeless : kHopeless))
      return Status::Ok();
    next = Propose(problem, centre->point);
    const double cost = problem.cost(next);
    if (best) {
      const bool near = Excess(FiguresOf(best->trial)) >= -kBand;
      if (Cost(FiguresOf(best->trial)) - cost < (near ? i * kGain : kGain / 2)) return Status::Ok();
    }
    if (const Tried* other = Best(!mode.detail); other && i > 1 && cost > Cost(FiguresOf(other->trial)) + kBehind) {
      return Status::Ok();
    }
    const auto again = [&](const Tried& t) { return t.detail == mode.detail && t.point == next; };
    if (std::any_of(tried_.begin(), tried_.end(), again)) return Status::Ok();
  }
}

// The point of the mode with the smallest errors.
SearchPoint Search::Extreme(const CodingMode& mode) const {
  SearchPoint point;
  point.quality = mode.max_quality;
  if (free_.motion) point.log_motion = kFinestMotion;
  if (free_.bits) point.more_bits = kMostMoreBits;
  return point;
}

Status Search::Run(Trial& best) {
  // 1. Begin with the quality that typically meets the targets.
  double quality = kSmooth.min_quality;
  if (targets_.kg) quality = std::max(quality, TypicalQuality(&TypicalFigures::kg, *targets_.kg));
  const double for_kg = quality;
  if (targets_.sted) quality = std::max(quality, TypicalQuality(&TypicalFigures::sted, *targets_.sted));
  if (!BoundsDistortion()) quality = TypicalQuality(&TypicalFigures::bpvf, *targets_.bpvf);

  // 2. Try the smooth planes alone, then detail, unless one of the two is clearly cheaper. Targets for KG or the rate
  // that are typical of detail are tried with detail first. With a target for STED the smooth planes are tried too,
  // since they may reach it with fewer bytes.
  const bool first_detail = for_kg > kDetailQuality || (!targets_.sted && quality > kDetailQuality);
  if (first_detail) SAC_RETURN_IF_ERROR(SearchMode(kDetailed, quality));
  const Tried* detailed = Best(true);
  if (!detailed || targets_.sted || detailed->point.quality < kDetailWins) {
    SAC_RETURN_IF_ERROR(SearchMode(kSmooth, std::min(quality, kDetailQuality)));
  }
  const Tried* smooth = Best(false);
  if (!first_detail && (!smooth || smooth->point.quality > kSmoothWins)) {
    SAC_RETURN_IF_ERROR(SearchMode(kDetailed, std::max(quality, kDetailQuality)));
  }
  return Choose(best);
}

Status Search::Choose(Trial& best) const {
  const Tried *smooth = Best(false), *detailed = Best(true);
  if (!smooth && !detailed) return Unreachable();
  const bool detail = !smooth || (detailed && Cost(FiguresOf(detailed->trial)) < Cost(FiguresOf(smooth->trial)));
  best = (detail ? detailed : smooth)->trial;
  if (targets_.bpvf && best.bpvf > *targets_.bpvf) {
    std::ostringstream message;
    message << "the targets exclude each other: KG " << best.kg << " % and STED " << best.sted << " take " << best.bpvf
            << " bits a vertex and frame";
    return Status::InvalidArgument(message.str());
  }
  return Status::Ok();
}

Status Search::Unreachable() const {
  const auto nearest = std::min_element(tried_.begin(), tried_.end(), [&](const Tried& a, const Tried& b) {
    return Excess(FiguresOf(a.trial)) < Excess(FiguresOf(b.trial));
  });
  const Trial& trial = nearest->trial;
  std::ostringstream message;
  message << "the target cannot be reached; nearest came KG " << trial.kg << " %, STED " << trial.sted << " at "
          << trial.bpvf << " bits a vertex and frame";
  return Status::InvalidArgument(message.str());
}

}  // namespace

Status SearchTargets(const RateTargets& targets, const EncoderSettings& base, const Mesh& mesh,
                     const std::function<Status(Trial&)>& run, Trial& best) {
  for (const std::optional<double>& target : {targets.kg, targets.sted, targets.bpvf}) {
    if (target && !(std::isfinite(*target) && *target > 0)) return Status::InvalidArgument("a target must be positive");
  }
  if (!targets.any()) return Status::InvalidArgument("no target");
  return Search(targets, base, mesh, run).Run(best);
}

}  // namespace sac
