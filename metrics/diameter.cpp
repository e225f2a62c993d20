// SPDX-License-Identifier: Apache-2.0
#include "metrics/diameter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace sac {
namespace {

using Point = std::array<double, 3>;

// Bounds are widened by this factor against rounding, so that pruning never loses the farthest pair.
constexpr double kSlack = 1 + 1e-12;
// Angles come out of acos with an error of up to about 1.5e-8 near pi.
constexpr double kAngleSlack = 1e-7;
constexpr std::size_t kLeafSize = 12;

Point operator-(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
double Dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
double Distance2(const Point& p, const Point& q) { return Dot(p - q, p - q); }
double Norm(const Point& p) { return std::sqrt(Dot(p, p)); }

// A range of the points with two bounds: a box, and a cone from the common centre with a largest radius. On a sphere
// about the centre boxes prune badly (they poke out of it), whereas cones only leave the pairs that are nearly
// antipodal.
struct Node {
  Point low, high;
  Point axis;
  double half_angle, radius;
  std::size_t begin, end;
  std::size_t left = 0, right = 0;  // children; 0 in a leaf
};

class DiameterSearch {
 public:
  explicit DiameterSearch(const Positions& points) {
    for (const Vec3f& p : points) points_.push_back({p[0], p[1], p[2]});
  }

  double Run() {
    if (points_.size() < 2) return 0;
    FindCentre();
    Climb();
    DropInner();
    Build(0, points_.size());
    Search(0, 0);
    return std::sqrt(best2_);
  }

 private:
  // The centre of the bounding box. Any point would do; the middle makes the radii small.
  void FindCentre() {
    Point low = points_[0], high = points_[0];
    for (const Point& p : points_) {
      for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
    }
    for (int c = 0; c < 3; ++c) centre_[c] = (low[c] + high[c]) / 2;
  }

  // A good first guess: from the extremes of the axes, go to the farthest point as long as that gains.
  void Climb() {
    for (int c = 0; c < 3; ++c) {
      Point p = *std::min_element(points_.begin(), points_.end(),
                                  [c](const Point& a, const Point& b) { return a[c] < b[c]; });
      for (double last2 = -1, d2 = 0; d2 > last2;) {
        last2 = d2;
        Point far = p;
        for (const Point& q : points_) {
          if (const double q2 = Distance2(p, q); q2 > d2) d2 = q2, far = q;
        }
        p = far;
        best2_ = std::max(best2_, d2);
      }
    }
  }

  // By the triangle inequality a point at radius r has no partner farther than r + the largest radius.
  void DropInner() {
    double largest = 0;
    for (const Point& p : points_) largest = std::max(largest, Norm(p - centre_));
    const double needed = std::sqrt(best2_);
    std::erase_if(points_, [&](const Point& p) { return (Norm(p - centre_) + largest) * kSlack < needed; });
  }

  std::size_t Build(std::size_t begin, std::size_t end) {
    const std::size_t index = nodes_.size();
    nodes_.push_back(Bound(begin, end));
    if (end - begin <= kLeafSize) return index;
    const Point extent = nodes_[index].high - nodes_[index].low;
    const auto c = std::max_element(extent.begin(), extent.end()) - extent.begin();
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [c](const Point& p, const Point& q) { return p[c] < q[c]; });
    const std::size_t left = Build(begin, middle), right = Build(middle, end);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
  }

  Node Bound(std::size_t begin, std::size_t end) const {
    Node node{points_[begin], points_[begin], {}, 0, 0, begin, end};
    for (std::size_t i = begin; i < end; ++i) {
      const Point& p = points_[i];
      for (int c = 0; c < 3; ++c)
        node.low[c] = std::min(node.low[c], p[c]), node.high[c] = std::max(node.high[c], p[c]);
      node.radius = std::max(node.radius, Norm(p - centre_));
    }
    Point middle;
    for (int c = 0; c < 3; ++c) middle[c] = (node.low[c] + node.high[c]) / 2 - centre_[c];
    const double norm = Norm(middle);
    double cosine = norm > 0 ? 1 : -1;
    if (norm > 0) {
      for (int c = 0; c < 3; ++c) node.axis[c] = middle[c] / norm;
      for (std::size_t i = begin; i < end; ++i) {
        const Point d = points_[i] - centre_;
        const double r = Norm(d);
        cosine = std::min(cosine, r > 0 ? Dot(d, node.axis) / r : -1.0);
      }
    }
    node.half_angle = std::acos(std::max(cosine, -1.0)) + kAngleSlack;
    return node;
  }

  // No pair of points from the two nodes has a larger squared distance.
  double UpperBound2(const Node& a, const Node& b) const {
    double box2 = 0;
    for (int c = 0; c < 3; ++c) {
      const double d = std::max(a.high[c] - b.low[c], b.high[c] - a.low[c]);
      box2 += d * d;
    }
    if (box2 * kSlack <= best2_) return box2 * kSlack;
    const double angle =
        std::acos(std::clamp(Dot(a.axis, b.axis), -1.0, 1.0)) + a.half_angle + b.half_angle + kAngleSlack;
    const double cosine = angle < std::numbers::pi ? std::cos(angle) : -1;
    double cone2 = a.radius * a.radius + b.radius * b.radius - 2 * a.radius * b.radius * cosine;
    // Within a right angle the law of cosines is convex in the two radii rather than increasing: it may peak at a
    // corner.
    if (cosine > 0) cone2 = std::max({cone2, a.radius * a.radius, b.radius * b.radius});
    return std::min(box2, cone2) * kSlack;
  }

  void Search(std::size_t i, std::size_t j) {
    const Node &a = nodes_[i], &b = nodes_[j];
    if (UpperBound2(a, b) <= best2_) return;
    if (a.left == 0 && b.left == 0) {
      for (std::size_t p = a.begin; p < a.end; ++p) {
        for (std::size_t q = b.begin; q < b.end; ++q) best2_ = std::max(best2_, Distance2(points_[p], points_[q]));
      }
    } else if (i == j) {
      Search(a.left, a.right);
      Search(a.left, a.left);
      Search(a.right, a.right);
    } else if (b.left == 0 || (a.left != 0 && a.end - a.begin >= b.end - b.begin)) {
      Search(a.left, j);
      Search(a.right, j);
    } else {
      Search(i, b.left);
      Search(i, b.right);
    }
  }

  std::vector<Point> points_;
  std::vector<Node> nodes_;
  Point centre_{};
  double best2_ = 0;
};

}  // namespace

double Diameter(const Positions& points) {
  for (const Vec3f& p : points) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  return DiameterSearch(points).Run();
}

}  // namespace sac
