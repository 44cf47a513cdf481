#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <talus/common/constants.hpp>
#include <talus/planner/pose/turning_path.hpp>

namespace talus::planner {
namespace {

constexpr std::array<std::size_t, 12> kTurnSpans{1, 2, 3, 4, 6, 8, 12, 16, 20, 24, 32, 48};
constexpr double kNoTurn_rad = 1e-9;

// Straight leg into a point, from the point `from`, with the rover's heading on the leg.
struct Arrival {
  std::size_t from = 0;
  double heading_rad = 0.0;
  double length_m = 0.0;  // < 0 in reverse
  double price = kInfinity;
  const Arrival* before = nullptr;  // null at the start
};

class Turning {
 public:
  Turning(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost)
      : points_(points), ends_(ends), cost_(cost), arrivals_(points.size()) {
    for (std::size_t to = 1; to < points.size(); ++to)
      for (const std::size_t span : kTurnSpans)
        if (span <= to) arrive(to, to - span);
  }

  PosePath result() const {
    const Arrival* best = nullptr;
    double least = kInfinity;
    for (const Arrival& last : arrivals_.back()) {
      const double price = last.price + turnPrice(points_.back(), last.heading_rad, ends_.goal_rad);
      if (price < least) least = price, best = &last;
    }
    PosePath path;
    if (!best) return path;
    std::vector<const Arrival*> chain;
    for (const Arrival* at = best; at; at = at->before) chain.push_back(at);
    path.start = {points_.front(), ends_.start_rad.value_or(chain.back()->heading_rad)};
    double heading = path.start.heading_rad;
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      turn(path, heading, (*at)->heading_rad);
      path.legs.push_back({{(*at)->length_m, 0.0}, 0.0});
    }
    if (ends_.goal_rad) turn(path, heading, *ends_.goal_rad);
    return path;
  }

 private:
  static void turn(PosePath& path, double& heading, double next) {
    const double by = std::remainder(next - heading, 2.0 * std::numbers::pi);
    if (std::abs(by) > kNoTurn_rad) path.legs.push_back({{}, by});
    heading = next;
  }

  double turnPrice(maps::Point at, double from_rad, const std::optional<double>& to_rad) const {
    if (!to_rad) return 0.0;
    const double by = std::remainder(*to_rad - from_rad, 2.0 * std::numbers::pi);
    return std::abs(by) > kNoTurn_rad ? cost_({at, from_rad}, PosePath::Leg{{}, by}) : 0.0;
  }

  // Points of a route lie on cell sides, and a leg between two of them may leave the route, so
  // the turns at its ends must be checked.
  bool mayTurnAtEnds(std::size_t from, std::size_t to) const {
    const Segment leg{points_[from], points_[to]};
    return (from == 0 || cost_.motion().turnAllowed(leg, leg.from)) &&
           (to + 1 == points_.size() || cost_.motion().turnAllowed(leg, leg.to));
  }

  void arrive(std::size_t to, std::size_t from) {
    const maps::Point a = points_[from], b = points_[to];
    const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (!(length > 0.0) || !mayTurnAtEnds(from, to)) return;
    const double straight = cost_.motion()({a, b});
    if (straight == kInfinity) return;
    const double ahead = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
    for (const bool reverse : {false, true}) {
      if (reverse && !cost_.kinematics().may_reverse) break;
      Arrival made{.from = from,
                   .heading_rad = ahead + (reverse ? std::numbers::pi : 0.0),
                   .length_m = reverse ? -length : length};
      if (from == 0) {
        made.price = ends_.start_rad ? turnPrice(a, *ends_.start_rad, made.heading_rad) : 0.0;
      } else {
        for (const Arrival& before : arrivals_[from]) {
          const double cusp = before.length_m * made.length_m < 0.0 ? cost_.kinematics().cusp.cost_J : 0.0;
          if (before.price + cusp >= made.price) continue;
          const double price = before.price + cusp + turnPrice(a, before.heading_rad, made.heading_rad);
          if (price < made.price) made.price = price, made.before = &before;
        }
      }
      made.price += straight;
      if (made.price < kInfinity) arrivals_[to].push_back(made);
    }
  }

  const std::vector<maps::Point>& points_;
  const EndHeadings& ends_;
  const PoseCost& cost_;
  std::vector<std::vector<Arrival>> arrivals_;  // by point; complete before another point reads the entry
};

}  // namespace

PosePath turningPath(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost) {
  if (points.size() < 2) return {};
  return Turning(points, ends, cost).result();
}

}  // namespace talus::planner
