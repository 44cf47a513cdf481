#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/heading_set.hpp>

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

using maps::Point;

constexpr std::size_t kShortest = 3;  // smallest number of legs that is replaced by two
constexpr int kMostRounds = 6;
constexpr double kGain = 1e-9;  // smallest gain relative to the stretch's cost

// Route with the costs of its legs, of which stretches are replaced by two legs.
class Tacks {
 public:
  Tacks(const MotionCost& cost, Polyline route)
      : cost_(cost), route_(std::move(route)), drive_J_(route_.size()), turn_J_(route_.size()) {
    for (std::size_t k = 1; k < route_.size(); ++k) price(k);
  }

  const Polyline& route() const noexcept { return route_; }

  /// Replaces stretches of `legs` legs where that is cheaper; successive stretches begin legs / 2 legs apart.
  /// Returns true if the route changed.
  bool gather(std::size_t legs) {
    bool any = false;
    for (std::size_t first = 0; first + kShortest < route_.size();) {
      const std::size_t last = std::min(first + legs, route_.size() - 1);
      const bool made = last - first >= kShortest && gather(first, last);
      first += made ? 1 : std::max<std::size_t>(legs / 2, 1);
      any = any || made;
    }
    return any;
  }

 private:
  // Replaces a stretch by the cheaper of the two paths of two legs, if it is cheaper than the stretch. The adjacent
  // legs, whose turns change, too, count.
  bool gather(std::size_t first, std::size_t last) {
    const std::size_t from = first > 0 ? first - 1 : 0, to = std::min(last + 1, route_.size() - 1);
    double best_J = drive_J_[from + 1];
    for (std::size_t k = from + 2; k <= to; ++k) best_J += turn_J_[k] + drive_J_[k];
    best_J *= 1.0 - kGain;
    std::optional<Point> corner;
    const double beside_J = (from < first ? drive_J_[first] : 0.0) + (to > last ? drive_J_[to] : 0.0);
    for (const Point& tried : corners(first, last)) {
      const Segment there{route_[first], tried}, on{tried, route_[last]};
      if (!(beside_J + cost_(there) + cost_(on) < best_J)) continue;  // without the turns
      Polyline points(route_.begin() + offset(from), route_.begin() + offset(first + 1));
      points.push_back(tried);
      points.insert(points.end(), route_.begin() + offset(last), route_.begin() + offset(to + 1));
      const double tried_J = cost_.along(points);
      if (!(tried_J < best_J)) continue;
      best_J = tried_J;
      corner = tried;
    }
    if (!corner) return false;
    route_[first + 1] = *corner;
    for (auto* costs : {&drive_J_, &turn_J_})
      costs->erase(costs->begin() + offset(first + 2), costs->begin() + offset(last));
    route_.erase(route_.begin() + offset(first + 2), route_.begin() + offset(last));
    for (std::size_t k = first + 1; k < std::min(first + 4, route_.size()); ++k) price(k);
    return true;
  }

  static std::ptrdiff_t offset(std::size_t k) noexcept { return static_cast<std::ptrdiff_t>(k); }

  // Computes the costs of the leg to point k and of the turn into it.
  void price(std::size_t k) {
    const Segment leg{route_[k - 1], route_[k]};
    drive_J_[k] = cost_(leg);
    if (k > 1) turn_J_[k] = cost_.turn(leg.from, directionOf({route_[k - 2], leg.from}), directionOf(leg));
  }

  // Corners of both orders: all displacement to the left of the line between the ends first, or last.
  std::array<Point, 2> corners(std::size_t first, std::size_t last) const {
    const Point from = route_[first], to = route_[last];
    const double x_m = to.x_m - from.x_m, y_m = to.y_m - from.y_m;
    Point left{0.0, 0.0};
    for (std::size_t k = first; k < last; ++k) {
      const double dx_m = route_[k + 1].x_m - route_[k].x_m, dy_m = route_[k + 1].y_m - route_[k].y_m;
      if (!(x_m * dy_m - y_m * dx_m > 0.0)) continue;
      left.x_m += dx_m;
      left.y_m += dy_m;
    }
    return {{{from.x_m + left.x_m, from.y_m + left.y_m}, {to.x_m - left.x_m, to.y_m - left.y_m}}};
  }

  const MotionCost& cost_;
  Polyline route_;
  std::vector<double> drive_J_, turn_J_;  // of the leg to a point, and of the turn into this leg
};

constexpr std::array kSteps{0.2, 0.1, 0.05, 0.025, 0.0125};  // cells
constexpr int kSweeps = 4;                                   // largest number of sweeps per step
constexpr std::array kOff{0.02, 0.005, 0.001, 2e-4};         // distance from a side [cells]
constexpr double kOnCircle = 1e-6, kInside = 1.0 - 1e-9;     // relative to the tolerance
// Smallest gain relative to the local cost; smaller gains are rounding.
constexpr double kLeastGain = 1e-9;

// Returns the cost [J] of the legs from vertex i - 2 to vertex i + 2, turns between them included. All costs
// that depend on the place of vertex i are among them.
double around_J(const MotionCost& cost, const Polyline& points, std::size_t i) {
  const std::size_t first = i > 1 ? i - 2 : 0, last = std::min(i + 2, points.size() - 1);
  return cost.along({points.begin() + static_cast<std::ptrdiff_t>(first),
                     points.begin() + static_cast<std::ptrdiff_t>(last) + 1});
}

// Moves vertex i by one step in the cheapest of eight directions. Returns false if no direction is cheaper.
bool moved(const MotionCost& cost, Polyline& points, std::size_t i, double step_m) {
  const double before_J = around_J(cost, points, i);
  const maps::Point here = points[i];
  maps::Point best = here;
  double best_J = before_J * (1.0 - kLeastGain);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) {
      if (x == 0 && y == 0) continue;
      points[i] = {here.x_m + x * step_m, here.y_m + y * step_m};
      const double tried_J = around_J(cost, points, i);
      if (tried_J < best_J) best_J = tried_J, best = points[i];
    }
  points[i] = best;
  return !(best == here);
}

}  // namespace

Polyline withoutCloseVertices(const MotionCost& cost, Polyline points) {
  const double least_m = 0.01 * cost.map().grid().resolution_m;
  for (std::size_t i = 0; i + 1 < points.size();) {
    const maps::Point a = points[i], b = points[i + 1];
    const bool first = i == 0, last = i + 2 == points.size();
    if (std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) >= least_m || (first && last)) {
      ++i;
      continue;
    }
    // The stretch around the pair, extended by one vertex on each side to include the turns at its ends.
    const std::size_t from = i >= 2 ? i - 2 : 0, to = std::min(i + 4, points.size());
    std::vector<maps::Point> meeting;
    if (first || last)
      meeting = {first ? a : b};
    else
      meeting = {a, b, {0.5 * (a.x_m + b.x_m), 0.5 * (a.y_m + b.y_m)}};
    double least_J = std::numeric_limits<double>::infinity();
    maps::Point best{};
    for (const maps::Point& p : meeting) {
      Polyline stretch(points.begin() + static_cast<std::ptrdiff_t>(from),
                       points.begin() + static_cast<std::ptrdiff_t>(i));
      stretch.push_back(p);
      stretch.insert(stretch.end(), points.begin() + static_cast<std::ptrdiff_t>(i + 2),
                     points.begin() + static_cast<std::ptrdiff_t>(to));
      if (const double sum_J = cost.along(stretch); sum_J < least_J) {
        least_J = sum_J;
        best = p;
      }
    }
    if (!std::isfinite(least_J)) {
      ++i;
      continue;
    }
    points[i] = best;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i + 1));
    i = i > 0 ? i - 1 : 0;
  }
  return points;
}

Polyline withFewerTurns(const MotionCost& cost, const Polyline& route) {
  if (route.size() < 3 || !(cost.along(route) < kInfinity)) return route;
  return FewerTurns(cost, route).best();
}

Polyline withLongerTacks(const MotionCost& cost, Polyline route) {
  Tacks tacks(cost, std::move(route));
  for (int round = 0; round < kMostRounds; ++round) {
    bool any = false;
    for (std::size_t legs = std::bit_ceil(tacks.route().size()); legs >= kShortest; legs /= 2)
      any = tacks.gather(legs) || any;
    if (!any) break;
  }
  return tacks.route();
}

Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop,
                             std::vector<std::size_t> vertices) {
  if (!(cost.along(points) < kInfinity)) return points;
  if (vertices.empty())
    for (std::size_t i = 1; i + 1 < points.size(); ++i) vertices.push_back(i);
  for (const double cells : kSteps) {
    bool any = true;
    for (int sweep = 0; sweep < kSweeps && any && !stop(); ++sweep) {
      any = false;
      for (const std::size_t i : vertices)
        any = moved(cost, points, i, cells * cost.map().grid().resolution_m) || any;
    }
  }
  return points;
}

Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m) {
  if (points.size() < 2 || std::abs(distance_m(points.back(), goal) - tolerance_m) > kOnCircle * tolerance_m)
    return points;
  const std::size_t first = points.size() > 2 ? points.size() - 3 : 0;
  const auto end_J = [&] {
    return cost.along({points.begin() + static_cast<std::ptrdiff_t>(first), points.end()});
  };
  double angle = std::atan2(points.back().y_m - goal.y_m, points.back().x_m - goal.x_m), best_J = end_J();
  const double most_rad = cost.map().grid().resolution_m / tolerance_m;
  for (const double cells : {1.6, 0.8, 0.4, 0.2, 0.1, 0.05, 0.025})
    for (int tries = 0; tries < kSweeps; ++tries) {
      const double before = angle;
      for (const double way : {-1.0, 1.0}) {
        const double tried = before + way * std::min(cells * most_rad, 1.0);
        const maps::Point kept = points.back();
        points.back() = {goal.x_m + kInside * tolerance_m * std::cos(tried),
                         goal.y_m + kInside * tolerance_m * std::sin(tried)};
        const double tried_J = end_J();
        if (tried_J < best_J * (1.0 - kLeastGain))
          best_J = tried_J, angle = tried;
        else
          points.back() = kept;
      }
      if (angle == before) break;
    }
  return points;
}

Polyline offSides(const MotionCost& cost, Polyline points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const maps::Point here = points[i];
    // Turns before the vertex are allowed and must remain allowed; later turns are processed next.
    const auto until = points.begin() + static_cast<std::ptrdiff_t>(i) + 2;
    const auto with_J = [&](maps::Point place) {
      points[i] = place;
      return cost.along({until - std::min<std::ptrdiff_t>(4, until - points.begin()), until});
    };
    double best_J = with_J(here);
    if (best_J < kInfinity) continue;
    maps::Point best = here;
    for (const std::size_t to : {i - 1, i + 1})
      for (const double cells : kOff)
        for (const double sense : {1.0, -1.0}) {
          const maps::Point end = points[to];
          const double share =
              sense * std::min(cells * cost.map().grid().resolution_m / distance_m(here, end), 0.5);
          const maps::Point tried{here.x_m + share * (end.x_m - here.x_m),
                                  here.y_m + share * (end.y_m - here.y_m)};
          const double tried_J = with_J(tried);
          if (tried_J < best_J) best_J = tried_J, best = tried;
        }
    points[i] = best;
  }
  return points;
}

}  // namespace talus::planner
