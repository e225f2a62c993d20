// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "synth/icosphere.h"
#include "synth/kinds.h"

namespace sac::synth {
namespace {

struct Piece {
  std::size_t begin, end;                    // range of its points
  Eigen::Vector3d home, swing, rate, phase;  // centre = home + swing sin(rate t + phase), per axis
  Eigen::Vector3d spin_axis, nod_axis;
  double spin_rate, nod_rate, nod;
};

struct Solid {
  std::vector<Eigen::Vector3d> points;
  std::vector<Triangle> triangles;
};

Solid Tetrahedron() {
  return {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}}};
}

Solid Box() {
  Solid box;
  for (int i = 0; i < 8; ++i) box.points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

Solid Ball(std::uint32_t frequency) {
  Icosphere s = MakeIcosphere(frequency);
  return {std::move(s.points), std::move(s.triangles)};
}

std::size_t PieceCount(std::uint32_t vertices) {
  return std::max<std::size_t>(vertices / 26, std::min<std::size_t>(100, vertices / 4));
}

Piece RandomPiece(double room, Random& random) {
  Piece p{};
  for (int c = 0; c < 3; ++c) {
    p.home[c] = random.Uniform(-room, room);
    p.swing[c] = random.Uniform(0.1, 0.5) * room;
    p.rate[c] = random.Uniform(0.3, 1.2);
    p.phase[c] = random.Angle();
  }
  p.spin_axis = random.Direction();
  p.nod_axis = random.Direction();
  p.spin_rate = random.Uniform(-5, 5);
  p.nod_rate = random.Uniform(0.5, 2);
  p.nod = random.Uniform(0, 1.5);
  return p;
}

Positions Fly(const std::vector<Eigen::Vector3d>& points, const std::vector<Piece>& pieces, double t) {
  Positions out;
  out.reserve(points.size());
  for (const Piece& p : pieces) {
    const Eigen::Vector3d centre = p.home + p.swing.cwiseProduct((p.rate * t + p.phase).array().sin().matrix());
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(p.nod * std::sin(p.nod_rate * t), p.nod_axis) *
                                  Eigen::AngleAxisd(p.spin_rate * t, p.spin_axis))
                                     .toRotationMatrix();
    for (std::size_t i = p.begin; i < p.end; ++i) out.push_back(ToFloat(turn * points[i] + centre));
  }
  return out;
}

}  // namespace

// A piece has about 26 vertices, or fewer where that would give fewer than a hundred pieces.
Animation MakeParts(std::uint32_t vertices, Random random) {
  const std::array<Solid, 5> solids{Tetrahedron(), Box(), Ball(1), Ball(2), Ball(3)};
  const std::size_t count = PieceCount(vertices);
  const double room = 0.25 * std::cbrt(static_cast<double>(count));  // half the side of the pieces' cube, metres
  std::vector<Eigen::Vector3d> points;
  std::vector<Piece> pieces;
  Animation animation;
  Mesh& mesh = animation.mesh;
  for (std::size_t i = 0; i < count; ++i) {
    // The next solid is chosen at random from those with more, or fewer, vertices than the mean that the remaining
    // pieces need, so that the total comes near the wanted number.
    const double mean = (vertices - static_cast<double>(points.size())) / static_cast<double>(count - i);
    const auto above =
        std::find_if(solids.begin() + 1, solids.end() - 1, [&](const Solid& s) { return s.points.size() > mean; });
    const auto larger = random.Next() % static_cast<std::uint64_t>(solids.end() - above);
    const auto smaller = random.Next() % static_cast<std::uint64_t>(above - solids.begin());
    const double low = solids[smaller].points.size(), high = above[static_cast<std::ptrdiff_t>(larger)].points.size();
    const bool take_high = random.Uniform(low, high) < mean;
    const Solid& solid = take_high ? above[static_cast<std::ptrdiff_t>(larger)] : solids[smaller];

    Piece piece = RandomPiece(room, random);
    piece.begin = points.size();
    const double sx = random.Uniform(0.05, 0.12), sy = random.Uniform(0.05, 0.12), sz = random.Uniform(0.05, 0.12);
    for (const Eigen::Vector3d& p : solid.points) points.emplace_back(p[0] * sx, p[1] * sy, p[2] * sz);
    piece.end = points.size();
    for (const Triangle& t : solid.triangles) {
      const auto base = static_cast<std::uint32_t>(piece.begin);
      mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    }
    const std::uint64_t rgb = random.Next();
    mesh.colors.resize(points.size(), {static_cast<std::uint8_t>(rgb), static_cast<std::uint8_t>(rgb >> 8),
                                       static_cast<std::uint8_t>(rgb >> 16), 255});
    pieces.push_back(piece);
  }
  animation.motion = [points = std::move(points), pieces = std::move(pieces)](double t) {
    return Fly(points, pieces, t);
  };
  return animation;
}

}  // namespace sac::synth
