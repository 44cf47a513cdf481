#include <algorithm>
#include <array>

#include <talus/common/constants.hpp>
#include <talus/planner/refine/fewer_turns.hpp>
#include <talus/planner/route/heading_sweep.hpp>

namespace talus::planner {
namespace {

constexpr std::array<std::size_t, 5> kSpans{1, 2, 3, 5, 8};
constexpr double kApart_rad = 0.1;  // spacing of the headings checked in a turn
// Cost of a vertex relative to the route's cost; prefers fewer vertices if turns cost nothing.
constexpr double kVertex = 1e-12;

// Leg from the point `from` into a point, and the cheapest path up to the end of the leg.
struct Arrival {
  std::size_t from;
  bool merged;  // the leg skips points
  costmap::Direction heading;
  double cost_J;
  const Arrival* before;  // null at the start
};

class FewerTurns {
 public:
  FewerTurns(const MotionCost& cost, const Polyline& route)
      : cost_(cost), route_(route), vertex_J_(kVertex * cost.along(route)), arrivals_(route.size()) {
    for (std::size_t to = 1; to < route.size(); ++to)
      for (const std::size_t span : kSpans)
        if (span <= to) arrive(to, to - span);
  }

  Polyline best() const {
    const auto& last = arrivals_.back();
    if (last.empty()) return route_;
    Polyline points{route_.back()};
    for (const Arrival* at = &*std::ranges::min_element(last, {}, &Arrival::cost_J); at; at = at->before)
      points.push_back(route_[at->from]);
    std::ranges::reverse(points);
    return points;
  }

 private:
  void arrive(std::size_t to, std::size_t from) {
    const Segment leg{route_[from], route_[to]};
    if ((from > 0 && !cost_.turnAllowed(leg, leg.from)) ||
        (to + 1 < route_.size() && !cost_.turnAllowed(leg, leg.to)))
      return;
    const double straight_J = cost_(leg) + vertex_J_;
    Arrival made{from, to - from > 1, directionOf(leg), from == 0 ? straight_J : kInfinity, nullptr};
    for (const Arrival& before : arrivals_[from]) {
      const double so_far_J = before.cost_J + straight_J;
      if (!(so_far_J < made.cost_J)) continue;
      const double through_J = so_far_J + cost_.turn(leg.from, before.heading, made.heading);
      if (!(through_J < made.cost_J) || !mayTurn(leg.from, before, made)) continue;
      made.cost_J = through_J;
      made.before = &before;
    }
    if (made.cost_J < kInfinity) arrivals_[to].push_back(made);
  }

  // A turn that the given route does not have must pass allowed headings only, so that the rover can turn as
  // before.
  bool mayTurn(maps::Point at, const Arrival& before, const Arrival& next) const {
    if (!before.merged && !next.merged) return true;
    return holdsBetween(before.heading, next.heading, kApart_rad,
                        [&](costmap::Direction heading) { return cost_.headingAllowed(at, heading); });
  }

  const MotionCost& cost_;
  const Polyline& route_;
  double vertex_J_;
  std::vector<std::vector<Arrival>> arrivals_;  // by point; complete before another point reads the entry
};

}  // namespace

Polyline withFewerTurns(const MotionCost& cost, const Polyline& route) {
  if (route.size() < 3 || !(cost.along(route) < kInfinity)) return route;
  return FewerTurns(cost, route).best();
}

}  // namespace talus::planner
