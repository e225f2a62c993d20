// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files/match_side.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

constexpr std::uint32_t kNone = MatchSide::kNone;
// So many of the nearest choices are tried.
constexpr std::size_t kMostChoices = 12;
// Centers are rounded to float.
constexpr double kRounding = 1.0001;

Status OtherTriangles() {
  return Status::InvalidArgument("its faces connect the vertices otherwise than those of the stream");
}

// The axis along which the box of positions is longest: sorted by it, few are near each other.
std::size_t WidestAxis(const Positions& positions) {
  const std::array<double, 3> size = BoundingBox(positions).size();
  return static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
}

// A triangle of the author's whose corner (k + rotation) % 3 may be corner k of a decoded one.
struct Choice {
  double distance = 0;  // the sum of the squares over the corners
  std::uint32_t triangle = 0;
  std::uint32_t rotation = 0;

  bool operator<(const Choice& other) const {
    return std::pair(distance, std::pair(triangle, rotation)) <
           std::pair(other.distance, std::pair(other.triangle, other.rotation));
  }
};

class Matching {
 public:
  Matching(const Mesh& decoded, const Mesh& author, std::size_t axis) : d_(decoded, axis), a_(author, axis) {
    vertex_.assign(decoded.positions.size(), kNone);
    back_.assign(author.positions.size(), kNone);
    done_.resize(decoded.triangles.size());
    used_.resize(author.triangles.size());
  }

  bool MatchTriangles();
  bool MatchLooseVertices();
  std::vector<std::uint32_t> TakeOrder() { return std::move(vertex_); }

 private:
  // Matches a decoded triangle and all that follows from it.
  bool Seed(std::uint32_t triangle);
  void ListChoices(std::uint32_t triangle, std::vector<Choice>& choices) const;
  void AddChoices(std::uint32_t triangle, std::uint32_t other, std::vector<Choice>& choices) const;

  // Spreads from a pair of triangles until nothing follows any more. False, and nothing is changed, where the meshes
  // differ, or where the sum of the squares of distances exceeds `bound`; it is in `sum` otherwise.
  bool Spread(std::uint32_t triangle, const Choice& choice, double bound, double& sum);
  bool Pair(std::uint32_t triangle, std::uint32_t other, std::uint32_t rotation, double& sum);
  bool PairVertices(std::uint32_t v, std::uint32_t other, double& sum);
  void Undo();

  MatchSide d_, a_;
  std::vector<std::uint32_t> vertex_, back_;  // of decoded vertices the author's, and the other way
  std::vector<bool> done_, used_;             // triangles
  // What the spreading at hand has matched.
  std::vector<std::uint32_t> new_vertices_;
  std::vector<std::array<std::uint32_t, 3>> new_triangles_;  // decoded, author's, rotation
};

bool Matching::PairVertices(std::uint32_t v, std::uint32_t other, double& sum) {
  if (vertex_[v] != kNone || back_[other] != kNone) return vertex_[v] == other;
  if (d_.color(v) != a_.color(other)) return false;
  vertex_[v] = other;
  back_[other] = v;
  new_vertices_.push_back(v);
  sum += SquaredDistance(d_.position(v), a_.position(other));
  return true;
}

bool Matching::Pair(std::uint32_t triangle, std::uint32_t other, std::uint32_t rotation, double& sum) {
  if (done_[triangle] || used_[other]) return false;
  done_[triangle] = used_[other] = true;
  new_triangles_.push_back({triangle, other, rotation});
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (!PairVertices(d_.triangle(triangle)[k], a_.triangle(other)[(k + rotation) % 3], sum)) return false;
  }
  return true;
}

void Matching::Undo() {
  for (const std::uint32_t v : new_vertices_) {
    back_[vertex_[v]] = kNone;
    vertex_[v] = kNone;
  }
  for (const auto& [triangle, other, rotation] : new_triangles_) done_[triangle] = used_[other] = false;
}

bool Matching::Spread(std::uint32_t triangle, const Choice& choice, double bound, double& sum) {
  new_vertices_.clear();
  new_triangles_.clear();
  sum = 0;
  bool good = Pair(triangle, choice.triangle, choice.rotation, sum);
  for (std::size_t next = 0; good && next < new_triangles_.size(); ++next) {
    const auto [t, o, rotation] = new_triangles_[next];
    for (std::uint32_t k = 0; good && k < 3; ++k) {
      const std::uint32_t edge = d_.twin(3 * t + k), other = a_.twin(3 * o + (k + rotation) % 3);
      good = (edge == kNone) == (other == kNone);
      if (!good || edge == kNone) continue;
      const std::uint32_t turned = (other % 3 + 3 - edge % 3) % 3;
      if (done_[edge / 3] && used_[other / 3]) {
        // Their corners have been compared where they were paired; they must have been paired with each other.
        for (std::uint32_t c = 0; good && c < 3; ++c) {
          good = vertex_[d_.triangle(edge / 3)[c]] == a_.triangle(other / 3)[(c + turned) % 3];
        }
        continue;
      }
      good = Pair(edge / 3, other / 3, turned, sum);
    }
    good = good && sum <= bound;
  }
  if (!good) Undo();
  return good;
}

void Matching::AddChoices(std::uint32_t triangle, std::uint32_t other, std::vector<Choice>& choices) const {
  if (used_[other]) return;
  // The sum over three corners is at least three times the square of what their means are apart.
  if (choices.size() == kMostChoices &&
      3 * SquaredDistance(d_.center(triangle), a_.center(other)) > choices.back().distance * kRounding) {
    return;
  }
  for (std::uint32_t rotation = 0; rotation < 3; ++rotation) {
    Choice choice{0, other, rotation};
    bool possible = true;
    for (std::uint32_t k = 0; possible && k < 3; ++k) {
      const std::uint32_t v = d_.triangle(triangle)[k], o = a_.triangle(other)[(k + rotation) % 3];
      possible = d_.color(v) == a_.color(o) && (vertex_[v] == kNone ? back_[o] == kNone : vertex_[v] == o);
      choice.distance += SquaredDistance(d_.position(v), a_.position(o));
    }
    if (!possible) continue;
    if (choices.size() == kMostChoices && !(choice < choices.back())) continue;
    choices.insert(std::upper_bound(choices.begin(), choices.end(), choice), choice);
    if (choices.size() > kMostChoices) choices.pop_back();
  }
}

void Matching::ListChoices(std::uint32_t triangle, std::vector<Choice>& choices) const {
  choices.clear();
  for (const std::uint32_t v : d_.triangle(triangle)) {
    if (vertex_[v] == kNone) continue;
    // Few triangles have a vertex in common.
    for (const std::uint32_t corner : a_.corners(vertex_[v])) {
      if (corner % 3 == 0 || a_.triangle(corner / 3)[0] != vertex_[v]) AddChoices(triangle, corner / 3, choices);
    }
    return;
  }
  const std::span<const std::uint32_t> alike = a_.TrianglesLike(d_.kind(triangle));
  const double x = d_.middle(triangle);
  const auto middle = std::lower_bound(alike.begin(), alike.end(), x,
                                       [this](std::uint32_t t, double value) { return a_.middle(t) < value; });
  // Outwards along the axis, from both sides in turn, until nothing nearer can come: the sum over three corners is at
  // least three times the square of what their means are apart.
  const auto near_enough = [&](std::uint32_t t) {
    const double apart = a_.middle(t) - x;
    return choices.size() < kMostChoices || 3 * apart * apart <= choices.back().distance;
  };
  auto after = middle, before = middle;
  for (bool more = true; more;) {
    more = false;
    if (after != alike.end() && near_enough(*after)) {
      AddChoices(triangle, *after++, choices);
      more = true;
    }
    if (before != alike.begin() && near_enough(*(before - 1))) {
      AddChoices(triangle, *--before, choices);
      more = true;
    }
  }
}

bool Matching::Seed(std::uint32_t triangle) {
  std::vector<Choice> choices;
  ListChoices(triangle, choices);
  double sum = 0, best_sum = std::numeric_limits<double>::infinity();
  if (choices.size() == 1) return Spread(triangle, choices.front(), best_sum, sum);
  const Choice* best = nullptr;
  for (const Choice& choice : choices) {
    if (!Spread(triangle, choice, best_sum, sum)) continue;
    Undo();
    // Of equals the first stays, which is the nearest.
    if (best != nullptr && sum >= best_sum) continue;
    best = &choice;
    best_sum = sum;
  }
  return best != nullptr && Spread(triangle, *best, std::numeric_limits<double>::infinity(), sum);
}

bool Matching::MatchTriangles() {
  std::vector<std::uint32_t> waiting;  // triangles at vertices that are matched
  for (const std::uint32_t rare : d_.RarestFirst()) {
    waiting.assign(1, rare);
    while (!waiting.empty()) {
      const std::uint32_t triangle = waiting.back();
      waiting.pop_back();
      if (done_[triangle]) continue;
      if (!Seed(triangle)) return false;
      for (const std::uint32_t v : new_vertices_) {
        for (const std::uint32_t corner : d_.corners(v)) {
          if (!done_[corner / 3]) waiting.push_back(corner / 3);
        }
      }
    }
  }
  return true;
}

bool Matching::MatchLooseVertices() {
  std::vector<std::uint32_t> loose;  // the author's, along the axis
  for (std::uint32_t v = 0; v < back_.size(); ++v) {
    if (back_[v] == kNone) loose.push_back(v);
  }
  const auto x_of = [this](std::uint32_t v) { return a_.along(v); };
  std::sort(loose.begin(), loose.end(), [&](std::uint32_t v, std::uint32_t w) { return x_of(v) < x_of(w); });
  // Those that are taken are passed by in one step, however many are side by side: links to the next that may be free.
  std::vector<std::uint32_t> right(loose.size() + 1), left(loose.size() + 1);
  for (std::uint32_t i = 0; i <= loose.size(); ++i) right[i] = left[i] = i;
  const auto find = [](std::vector<std::uint32_t>& links, std::uint32_t i) {
    while (links[i] != i) i = links[i] = links[links[i]];
    return i;
  };
  const auto end = static_cast<std::uint32_t>(loose.size());
  for (std::uint32_t v = 0; v < vertex_.size(); ++v) {
    if (vertex_[v] != kNone) continue;
    const double x = d_.along(v);
    const auto place =
        static_cast<std::uint32_t>(std::lower_bound(loose.begin(), loose.end(), x,
                                                    [&](std::uint32_t w, double value) { return x_of(w) < value; }) -
                                   loose.begin());
    std::uint32_t best = kNone;
    double best_distance = std::numeric_limits<double>::infinity();
    const auto visit = [&](std::uint32_t i) {
      const double apart = x_of(loose[i]) - x;
      if (apart * apart > best_distance) return false;
      const double distance = SquaredDistance(d_.position(v), a_.position(loose[i]));
      if (distance < best_distance || best == kNone) {
        best = i;
        best_distance = distance;
      }
      return true;
    };
    for (std::uint32_t i = find(right, place); i < end && visit(i);) i = find(right, i + 1);
    // `left` is shifted by one, so that 0 stands for none.
    for (std::uint32_t i = find(left, place); i > 0 && visit(i - 1);) i = find(left, i - 1);
    if (best == kNone) return false;
    vertex_[v] = loose[best];
    back_[loose[best]] = v;
    right[best] = best + 1;
    left[best + 1] = best;
  }
  return true;
}

}  // namespace

Status MatchVertices(const Mesh& decoded, const Mesh& author, VertexOrder& order, MatchDistance& distance) {
  const auto differ = [](const char* what, std::size_t own, std::size_t streams) {
    return Status::InvalidArgument("it has " + std::to_string(own) + " " + what + ", the stream " +
                                   std::to_string(streams));
  };
  if (author.positions.size() != decoded.positions.size()) {
    return differ("vertices", author.positions.size(), decoded.positions.size());
  }
  if (author.triangles.size() != decoded.triangles.size()) {
    return differ("triangles", author.triangles.size(), decoded.triangles.size());
  }
  Matching matching(decoded, author, WidestAxis(author.positions));
  if (!matching.MatchTriangles() || !matching.MatchLooseVertices()) return OtherTriangles();
  order = matching.TakeOrder();
  distance = {};
  for (std::size_t v = 0; v < order.size(); ++v) {
    const double d = std::sqrt(SquaredDistance(decoded.positions[v], author.positions[order[v]]));
    distance.mean += d / static_cast<double>(order.size());
    distance.largest = std::max(distance.largest, d);
  }
  return Status::Ok();
}

}  // namespace sac
