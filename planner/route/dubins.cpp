#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/planner/route/dubins.hpp>

namespace talus::planner {
namespace {

// Wraps an angle to [0, 2 pi); values less than 1e-9 below a full turn are rounding and become 0.
double turned(double angle) noexcept {
  const double full = 2.0 * std::numbers::pi;
  const double rest = angle - full * std::floor(angle / full);
  return full - rest < 1e-9 ? 0.0 : rest;
}

// A path of three pieces: lengths in radii; sides +1 left, 0 straight, -1 right.
struct Word {
  std::array<double, 3> length{};
  std::array<int, 3> side{};
  double total() const noexcept { return length[0] + length[1] + length[2]; }
};

// Start at the origin with heading `alpha`, end at (d, 0) with heading `beta`, both relative to the
// connecting line.
struct Ends {
  double d, alpha, beta;
  double sin_alpha = std::sin(alpha), cos_alpha = std::cos(alpha);
  double sin_beta = std::sin(beta), cos_beta = std::cos(beta);
};

// Turn, straight, turn. (along, across) is the vector between the centres of both circles. The straight piece
// has the same length (outer tangent) or is the other leg to 2 radii (inner tangent).
Word turnStraightTurn(const Ends& e, int first, int last) noexcept {
  Word none{.length = {std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const double along = e.d - last * e.sin_beta + first * e.sin_alpha;
  const double across = last * e.cos_beta - first * e.cos_alpha;
  const double square = along * along + across * across;
  double straight = std::sqrt(square), heading = std::atan2(across, along);
  if (first != last) {
    if (square < 4.0) return none;
    straight = std::sqrt(square - 4.0);
    heading += first * std::atan2(2.0, straight);
  }
  return {.length = {turned(first * (heading - e.alpha)), straight, turned(last * (e.beta - heading))},
          .side = {first, 0, last}};
}

// Turn, turn the other way by more than half a circle, turn the first way.
Word threeTurns(const Ends& e, int side) noexcept {
  Word none{.length = {std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const double along = e.d - side * e.sin_beta + side * e.sin_alpha;
  const double across = side * e.cos_beta - side * e.cos_alpha;
  const double apart = std::hypot(along, across);
  if (apart > 4.0) return none;
  // Centre of the middle circle, which touches both others, on the side for which the middle turn exceeds
  // half a circle.
  const double corner = side * std::acos(apart / 4.0), heading = std::atan2(across, along);
  const double to_middle = heading + corner, from_last = heading + std::numbers::pi - corner;
  const double first = turned(side * (to_middle - e.alpha) + std::numbers::pi / 2);
  const double middle = turned(side * (to_middle - from_last));
  const double last = turned(side * (e.beta - from_last) - std::numbers::pi / 2);
  return {.length = {first, middle, last}, .side = {side, -side, side}};
}

}  // namespace

std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m) {
  const double dx = to.place.x_m - from.place.x_m, dy = to.place.y_m - from.place.y_m;
  const double line = std::atan2(dy, dx);
  const Ends ends{std::hypot(dx, dy) / radius_m, from.heading_rad - line, to.heading_rad - line};
  Word best = turnStraightTurn(ends, 1, 1);
  for (const Word& word : {turnStraightTurn(ends, -1, -1), turnStraightTurn(ends, 1, -1),
                           turnStraightTurn(ends, -1, 1), threeTurns(ends, 1), threeTurns(ends, -1)})
    if (word.total() < best.total()) best = word;
  std::vector<Arc> arcs;
  for (std::size_t k = 0; k < 3; ++k)
    if (best.length[k] > 1e-12) arcs.push_back({best.length[k] * radius_m, best.side[k] / radius_m});
  return arcs;
}

}  // namespace talus::planner
