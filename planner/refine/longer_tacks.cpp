#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include <talus/planner/refine/longer_tacks.hpp>

namespace talus::planner {
namespace {

using maps::Point;

constexpr std::size_t kShortest = 3;  // smallest number of legs that is replaced by two
constexpr int kMostRounds = 6;
constexpr double kGain = 1e-9;  // smallest gain relative to the stretch's cost

// Stretch between two points of a route, with the adjacent legs, whose turns change, too.
class Stretch {
 public:
  Stretch(const MotionCost& cost, const Polyline& route, std::size_t first, std::size_t last)
      : cost_(cost), route_(route), first_(first), last_(last) {}

  /// Sets the corner of the cheaper of the two paths of two legs. Returns false if neither is cheaper than
  /// the stretch.
  bool gather(Point& corner) const {
    double best_J = cost_.along(with(route_.begin() + offset(first_ + 1), route_.begin() + offset(last_)));
    best_J *= 1.0 - kGain;
    bool found = false;
    for (const Point& tried : corners()) {
      const double tried_J = cost_.along(with(&tried, &tried + 1));
      if (!(tried_J < best_J)) continue;
      best_J = tried_J;
      corner = tried;
      found = true;
    }
    return found;
  }

 private:
  static std::ptrdiff_t offset(std::size_t k) noexcept { return static_cast<std::ptrdiff_t>(k); }

  template <typename Iterator>
  Polyline with(Iterator begin, Iterator end) const {
    Polyline points;
    if (first_ > 0) points.push_back(route_[first_ - 1]);
    points.push_back(route_[first_]);
    points.insert(points.end(), begin, end);
    points.push_back(route_[last_]);
    if (last_ + 1 < route_.size()) points.push_back(route_[last_ + 1]);
    return points;
  }

  // Corners of both orders: all displacement to the left of the line between the ends first, or last.
  std::array<Point, 2> corners() const {
    const Point from = route_[first_], to = route_[last_];
    const double x_m = to.x_m - from.x_m, y_m = to.y_m - from.y_m;
    Point left{0.0, 0.0};
    for (std::size_t k = first_; k < last_; ++k) {
      const double dx_m = route_[k + 1].x_m - route_[k].x_m, dy_m = route_[k + 1].y_m - route_[k].y_m;
      if (!(x_m * dy_m - y_m * dx_m > 0.0)) continue;
      left.x_m += dx_m;
      left.y_m += dy_m;
    }
    return {{{from.x_m + left.x_m, from.y_m + left.y_m}, {to.x_m - left.x_m, to.y_m - left.y_m}}};
  }

  const MotionCost& cost_;
  const Polyline& route_;
  std::size_t first_, last_;
};

// Replaces stretches of `legs` legs by two legs where gather() allows; successive stretches begin legs / 2
// legs apart. Returns true if the route changed.
bool gatherAll(const MotionCost& cost, Polyline& route, std::size_t legs) {
  bool any = false;
  for (std::size_t first = 0; first + kShortest < route.size();) {
    const std::size_t last = std::min(first + legs, route.size() - 1);
    Point corner;
    if (last - first < kShortest || !Stretch(cost, route, first, last).gather(corner)) {
      first += std::max<std::size_t>(legs / 2, 1);
      continue;
    }
    route.erase(route.begin() + static_cast<std::ptrdiff_t>(first) + 2,
                route.begin() + static_cast<std::ptrdiff_t>(last));
    route[first + 1] = corner;
    any = true;
    ++first;
  }
  return any;
}

}  // namespace

Polyline withLongerTacks(const MotionCost& cost, Polyline route) {
  for (int round = 0; round < kMostRounds; ++round) {
    bool any = false;
    for (std::size_t legs = std::bit_ceil(route.size()); legs >= kShortest; legs /= 2)
      any = gatherAll(cost, route, legs) || any;
    if (!any) break;
  }
  return route;
}

}  // namespace talus::planner
