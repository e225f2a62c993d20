#include "codec/encode/search/band.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sac {
namespace {

struct Point {
  double x, y;
};

}  // namespace

Status FindInBand(const BandProblem& problem, double& x) {
  std::optional<Point> above, below, last;
  int same_side = 0;
  bool was_above = false;
  x = std::clamp(x, problem.low, problem.high);
  for (int i = 0; i < problem.most_evaluations; ++i) {
    double y = 0;
    SAC_RETURN_IF_ERROR(problem.evaluate(x, y));
    if (InBand(y)) return Status::Ok();
    const bool is_above = y > 0;
    same_side = i > 0 && is_above == was_above ? same_side + 1 : 0;
    was_above = is_above;
    (is_above ? above : below) = Point{x, y};
    double next = x;
    if (above && below) {
      double t = (kBandAim - above->y) / (below->y - above->y);
      // An end that stays makes secants crawl.
      t = same_side >= 2 ? 0.5 : std::clamp(t, 0.05, 0.95);
      next = above->x + t * (below->x - above->x);
      if (std::abs(above->x - below->x) < 1e-3) {  // a jump across the band
        x = below->x;
        break;
      }
    } else {
      double slope = problem.slope;
      if (last && last->x != x) {
        const double secant = (y - last->y) / (x - last->x);
        if (secant / slope > 0) slope *= std::clamp(secant / slope, 0.2, 5.0);
      }
      const double reach = 0.3 * (problem.high - problem.low);
      next = std::clamp(x + std::clamp((kBandAim - y) / slope, -reach, reach), problem.low, problem.high);
      if (next == x) break;  // the range ends
    }
    last = Point{x, y};
    x = next;
  }
  return Status::Ok();
}

}  // namespace sac
