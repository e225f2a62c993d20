#include "codec/encode/search/target_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

#include "codec/encode/quality.h"
#include "codec/encode/search/band.h"
#include "codec/encode/search/two_bands.h"

namespace sac {
namespace {

// Beyond 0..100 the table of qualities goes on with its last steps' ratios.
constexpr double kLeastQuality = -40, kMostQuality = 125;
constexpr int kLeastBits = 4, kMostBits = 20;
constexpr double kDetailFrom = 60;       // there is no detail at lower qualities
constexpr int kFineBits = 13;            // more make little difference without detail
constexpr int kMostTrials = 10;          // of a number of position bits
constexpr int kFirstTrials = 3;          // to find the number of position bits about which to search
constexpr double kQualitySlope = -0.03;  // of log KG and log STED, about
constexpr double kSizeSlope = 0.03;      // of log bpvf

// What the qualities come to on most clips (docs/quality.md), to begin with.
struct Typical {
  double quality, kg, sted, bpvf;
};
constexpr std::array<Typical, 9> kTypical = {{{0, 4.3, 0.2, 0.09},
                                              {10, 2.6, 0.11, 0.12},
                                              {25, 1.9, 0.072, 0.15},
                                              {50, 1.35, 0.052, 0.19},
                                              {60, 0.95, 0.048, 0.23},
                                              {70, 0.3, 0.044, 0.55},
                                              {80, 0.18, 0.032, 0.85},
                                              {90, 0.1, 0.021, 1.4},
                                              {100, 0.025, 0.007, 3.3}}};

// The quality at which `figure` typically comes to `target`.
double TypicalQuality(double Typical::*figure, double target) {
  const bool falls = kTypical.front().*figure > kTypical.back().*figure;
  for (std::size_t i = 1; i < kTypical.size(); ++i) {
    const double a = kTypical[i - 1].*figure, b = kTypical[i].*figure;
    if (i + 1 < kTypical.size() && (falls ? b > target : b < target)) continue;
    const double t = std::clamp(std::log(target / a) / std::log(b / a), -3.0, 3.0);
    return kTypical[i - 1].quality + t * (kTypical[i].quality - kTypical[i - 1].quality);
  }
  return 50;
}

double LogRatio(double figure, double target) { return std::log(std::max(figure, 1e-12) / target); }

// Whole bits are near enough to the best: what they leave, the other steps make up for.
int WholeBits(double quality) { return static_cast<int>(std::lround(SettingsOfQuality(quality).position_bits)); }

class Search {
 public:
  Search(const RateTargets& targets, const EncoderSettings& base, const std::function<Status(Trial&)>& run)
      : targets_(targets), base_(base), run_(run) {}

  Status Run(Trial& best);

 private:
  // A place on the table of qualities: steps by `quality`, but position bits and the motion step apart.
  Status Evaluate(double quality, double log_motion, int bits, Trial& trial);
  // KG and STED against their targets: the one that is nearer to or further beyond its own.
  double Distortion(const Trial& trial) const;
  bool BoundsDistortion() const { return targets_.kg || targets_.sted; }
  // What is to be 0 or less.
  double Excess(const Trial& trial) const {
    return BoundsDistortion() ? Distortion(trial) : LogRatio(trial.bpvf, *targets_.bpvf);
  }
  // Less is better, among trials that are not beyond a target.
  double Score(const Trial& trial) const {
    return BoundsDistortion() ? static_cast<double>(trial.bytes) : trial.kg * trial.sted;
  }
  Status AlongQualities(int bits, int most_trials, double& quality);
  // The best of a number of position bits, in `best_score`.
  Status AtBits(int bits, double& best_score);
  Status WithoutDetail();
  Status Choose(Trial& best) const;
  Status Unreachable() const;

  const RateTargets& targets_;
  const EncoderSettings& base_;
  const std::function<Status(Trial&)>& run_;
  std::map<std::tuple<double, double, int>, Trial> trials_;
  // Where the search of the next number of bits begins.
  double quality_ = 50, log_motion_ = 0;
  double most_quality_ = kMostQuality;
  Sensitivity sensitivity_;
};

Status Search::Evaluate(double quality, double log_motion, int bits, Trial& trial) {
  const auto [at, is_new] = trials_.try_emplace({quality, log_motion, bits});
  if (is_new) {
    const QualitySettings steps = SettingsOfQuality(quality);
    EncoderSettings& s = at->second.settings = base_;
    s.quality = std::clamp(quality, 0.0, 100.0);
    s.motion_step = steps.motion_step * std::exp(log_motion);
    s.displacement_step = steps.displacement_step;
    s.detail_step = steps.detail_step;
    s.position_bits = bits;
    if (Status status = run_(at->second); !status.ok()) {
      trials_.erase(at);
      return status;
    }
  }
  trial = at->second;
  return Status::Ok();
}

double Search::Distortion(const Trial& trial) const {
  double most = std::log(1e-12);
  if (targets_.kg) most = std::max(most, LogRatio(trial.kg, *targets_.kg));
  if (targets_.sted) most = std::max(most, LogRatio(trial.sted, *targets_.sted));
  return most;
}

// `bits` 0: those of the table.
Status Search::AlongQualities(int bits, int most_trials, double& quality) {
  const double slope = BoundsDistortion() ? kQualitySlope : kSizeSlope;
  const auto evaluate = [&](double q, double& y) {
    Trial trial;
    const int b = bits != 0 ? bits : std::clamp(WholeBits(q), kLeastBits, kMostBits);
    SAC_RETURN_IF_ERROR(Evaluate(q, 0, b, trial));
    y = Excess(trial);
    return Status::Ok();
  };
  return FindInBand({evaluate, slope, kLeastQuality, most_quality_, most_trials}, quality);
}

Status Search::AtBits(int bits, double& best_score) {
  if (targets_.kg && targets_.sted) {
    const auto evaluate = [&](double quality, double log_motion, double& kg, double& sted) {
      Trial trial;
      SAC_RETURN_IF_ERROR(Evaluate(quality, log_motion, bits, trial));
      kg = LogRatio(trial.kg, *targets_.kg);
      sted = LogRatio(trial.sted, *targets_.sted);
      return Status::Ok();
    };
    SAC_RETURN_IF_ERROR(FindInTwoBands({evaluate, kLeastQuality, most_quality_}, sensitivity_, quality_, log_motion_));
  } else {
    SAC_RETURN_IF_ERROR(AlongQualities(bits, kMostTrials, quality_));
  }
  best_score = std::numeric_limits<double>::infinity();
  for (const auto& [place, trial] : trials_) {
    if (std::get<int>(place) == bits && Excess(trial) <= 0) best_score = std::min(best_score, Score(trial));
  }
  return Status::Ok();
}

Status Search::Run(Trial& best) {
  quality_ = kLeastQuality;
  if (targets_.kg) quality_ = std::max(quality_, TypicalQuality(&Typical::kg, *targets_.kg));
  if (targets_.sted) quality_ = std::max(quality_, TypicalQuality(&Typical::sted, *targets_.sted));
  if (!BoundsDistortion()) quality_ = TypicalQuality(&Typical::bpvf, *targets_.bpvf);
  SAC_RETURN_IF_ERROR(AlongQualities(0, kFirstTrials, quality_));
  const int start = std::clamp(WholeBits(quality_), kLeastBits + 1, kMostBits - 1);
  double score = 0, other = 0;
  SAC_RETURN_IF_ERROR(AtBits(start, score));
  const double quality = quality_, log_motion = log_motion_;
  SAC_RETURN_IF_ERROR(AtBits(start - 1, other));
  if (!(other < score)) {  // it may be better the other way
    quality_ = quality;
    log_motion_ = log_motion;
    SAC_RETURN_IF_ERROR(AtBits(start + 1, other));
  }
  if (targets_.sted) SAC_RETURN_IF_ERROR(WithoutDetail());
  return Choose(best);
}

// A low STED has two ways: detail, or finer positions and motion, which are cheaper where they suffice.
Status Search::WithoutDetail() {
  Trial best;
  if (Choose(best).ok() && *best.settings.detail_step == 0) return Status::Ok();
  most_quality_ = quality_ = kDetailFrom;
  log_motion_ = targets_.kg ? kFinestMotion : 0;
  Trial finest;
  SAC_RETURN_IF_ERROR(Evaluate(quality_, log_motion_, kFineBits, finest));
  if (Excess(finest) > 0) return Status::Ok();
  double score = std::numeric_limits<double>::infinity();
  for (int bits = kFineBits; bits > kFineBits - 3; --bits) {
    double next = 0;
    SAC_RETURN_IF_ERROR(AtBits(bits, next));
    if (!(next < score)) break;
    score = next;
  }
  return Status::Ok();
}

Status Search::Choose(Trial& best) const {
  const Trial* smallest = nullptr;
  const Trial* tightest = nullptr;  // close to all targets
  for (const auto& entry : trials_) {
    const Trial& trial = entry.second;
    if (Excess(trial) > 0) continue;
    // The best that is close to a target; if none is, the best.
    const auto better = [&](const Trial* than) {
      if (!than) return true;
      const bool close = InBand(Excess(trial)), other_close = InBand(Excess(*than));
      return close != other_close ? close : Score(trial) < Score(*than);
    };
    if (better(smallest)) smallest = &trial;
    const bool all = (!targets_.kg || InBand(LogRatio(trial.kg, *targets_.kg))) &&
                     (!targets_.sted || InBand(LogRatio(trial.sted, *targets_.sted)));
    if (all && better(tightest)) tightest = &trial;
  }
  if (!smallest) return Unreachable();
  // A hundredth more is not worth a target that is missed by far.
  const bool tight = tightest && BoundsDistortion() && Score(*tightest) < 1.01 * Score(*smallest);
  best = tight ? *tightest : *smallest;
  if (targets_.bpvf && best.bpvf > *targets_.bpvf) {
    std::ostringstream message;
    message << "the targets exclude each other: KG " << best.kg << " % and STED " << best.sted << " take " << best.bpvf
            << " bits a vertex and frame";
    return Status::InvalidArgument(message.str());
  }
  return Status::Ok();
}

Status Search::Unreachable() const {
  const auto nearest = std::min_element(trials_.begin(), trials_.end(), [&](const auto& a, const auto& b) {
    return Excess(a.second) < Excess(b.second);
  });
  const Trial& trial = nearest->second;
  std::ostringstream message;
  message << "the target cannot be reached; nearest came KG " << trial.kg << " %, STED " << trial.sted << " at "
          << trial.bpvf << " bits a vertex and frame";
  return Status::InvalidArgument(message.str());
}

}  // namespace

Status SearchTargets(const RateTargets& targets, const EncoderSettings& base, const std::function<Status(Trial&)>& run,
                     Trial& best) {
  for (const std::optional<double>& target : {targets.kg, targets.sted, targets.bpvf}) {
    if (target && !(std::isfinite(*target) && *target > 0)) return Status::InvalidArgument("a target must be positive");
  }
  if (!targets.any()) return Status::InvalidArgument("no target");
  return Search(targets, base, run).Run(best);
}

}  // namespace sac
