#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/pose/pose_shortcut.hpp>

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
          const double cusp = before.length_m * made.length_m < 0.0 ? cost_.cusp_J() : 0.0;
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

constexpr std::array<std::size_t, 8> kSpans{2, 3, 4, 6, 8, 12, 16, 24};
// Joint spacing per round, relative to joint_m: first coarse, then fine.
constexpr std::array kSpacings{1.0, 0.35, 0.35};
constexpr double kLeastGain = 2e-3;  // relative gain below which no further fine round is tried
// A forward curve of at most this multiple of the straight distance is accepted.
constexpr double kStraight = 1.1;

double apart_m(const Pose& a, const Pose& b) noexcept {
  return std::hypot(b.place.x_m - a.place.x_m, b.place.y_m - a.place.y_m);
}

using Legs = std::vector<PosePath::Leg>;

bool goesOn(const PosePath::Leg& leg, const PosePath::Leg& next) noexcept {
  return leg.turn_rad == 0.0 && next.turn_rad == 0.0 && direction(leg) == direction(next) &&
         leg.arc.curvature_1_m == next.arc.curvature_1_m;
}

// Returns the drive with consecutive legs of equal curvature merged.
Legs joined(const Legs& legs) {
  Legs long_legs;
  for (const auto& leg : legs)
    if (!long_legs.empty() && goesOn(long_legs.back(), leg))
      long_legs.back().arc.length_m += leg.arc.length_m;
    else
      long_legs.push_back(leg);
  return long_legs;
}

// The drive divided into stretches of about `apart_m` metres, also divided at cusps and turns in place.
std::vector<Legs> divided(const PosePath& path, double apart_m) {
  std::vector<Legs> stretches;
  double room_m = 0.0;  // remaining length of the last stretch
  int way = 0;
  for (const auto& leg : joined(path.legs)) {
    if (direction(leg) != way || leg.turn_rad != 0.0) room_m = 0.0;
    way = direction(leg);
    const double length_m = std::abs(leg.arc.length_m);
    const int parts = std::max(1, static_cast<int>(std::ceil(length_m / apart_m)));
    for (int k = 0; k < parts; ++k) {
      if (room_m < 0.5 * length_m / parts || stretches.empty()) {
        stretches.emplace_back();
        room_m = apart_m;
      }
      stretches.back().push_back({{leg.arc.length_m / parts, leg.arc.curvature_1_m}, leg.turn_rad});
      room_m -= length_m / parts;
    }
    if (leg.turn_rad != 0.0) room_m = 0.0;
  }
  return stretches;
}

Pose after(Pose pose, const Legs& legs) noexcept {
  for (const auto& leg : legs) pose = after(pose, leg);
  return pose;
}

// Cheapest path found to a joint of the drive.
struct Joint {
  Pose pose;
  double price = kInfinity;
  std::size_t from = 0;  // previous joint
  Legs legs;             // legs from the previous joint
  int direction = 0;     // direction of travel on arrival
};

// Dynamic programming over the joints of a drive: each joint is reached from the previous joint by the
// drive's own legs, or from an earlier joint by a direct curve.
class Shortening {
 public:
  Shortening(const Pose& start, const std::vector<Legs>& path, const PoseCost& cost,
             const ShortenOptions& options)
      : cost_(cost), cheapest_J_per_m_(options.cheapest_J_per_m), joints_(path.size() + 1) {
    joints_[0].pose = start;
    joints_[0].price = 0.0;
    bool stopped = false;
    for (std::size_t k = 1; k < joints_.size(); ++k) {
      joints_[k].pose = after(joints_[k - 1].pose, path[k - 1]);
      reach(k, k - 1, path[k - 1]);
      stopped = stopped || ((k & 15) == 0 && options.stop());
      if (stopped) continue;
      for (const std::size_t span : kSpans) {
        if (span > k) break;
        if (promising(k, k - span)) reach(k, k - span, direct(path, k - span, k));
      }
    }
  }

  // The drive itself if its end cannot be reached.
  PosePath result(const PosePath& given) const {
    if (joints_.back().price == kInfinity) return given;
    std::vector<std::size_t> chain;
    for (std::size_t k = joints_.size() - 1; k > 0; k = joints_[k].from) chain.push_back(k);
    PosePath path{.start = joints_[0].pose, .legs = {}};
    for (auto k = chain.rbegin(); k != chain.rend(); ++k)
      path.legs.insert(path.legs.end(), joints_[*k].legs.begin(), joints_[*k].legs.end());
    return path;
  }

 private:
  bool promising(std::size_t to, std::size_t from) const noexcept {
    return joints_[from].price + cheapest_J_per_m_ * apart_m(joints_[from].pose, joints_[to].pose) <
           joints_[to].price;
  }

  // If the drive goes forward at both ends, a forward-only curve is computed faster. Such a curve is accepted
  // over long distances, where reversing does not pay, and if hardly any curve can be shorter.
  Legs direct(const std::vector<Legs>& path, std::size_t from, std::size_t to) const {
    const Pose &a = joints_[from].pose, &b = joints_[to].pose;
    if (direction(path[from].front()) > 0 && direction(path[to - 1].back()) > 0) {
      const double apart = apart_m(a, b);
      Legs legs = cost_.direct(a, b, true);
      if (apart > 4.0 * cost_.kinematics().turning_radius_m || length_m({a, legs}) < kStraight * apart)
        return legs;
    }
    return cost_.direct(a, b);
  }

  void reach(std::size_t to, std::size_t from, Legs legs) {
    Joint& there = joints_[to];
    double price = joints_[from].price;
    int way = joints_[from].direction;
    Pose pose = joints_[from].pose;
    for (const auto& leg : legs) {
      const int now = direction(leg);
      if (now * way < 0) price += cost_.cusp_J();
      if (now != 0) way = now;
      price += cheapest_J_per_m_ * std::abs(leg.arc.length_m);
    }
    if (price >= there.price) return;
    for (const auto& leg : legs) {
      price += cost_(pose, leg) - cheapest_J_per_m_ * std::abs(leg.arc.length_m);
      if (price >= there.price) return;
      pose = after(pose, leg);
    }
    there.price = price;
    there.from = from;
    there.legs = std::move(legs);
    there.direction = way;
  }

  const PoseCost& cost_;
  double cheapest_J_per_m_;
  std::vector<Joint> joints_;
};

}  // namespace

PosePath turningPath(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost) {
  if (points.size() < 2) return {};
  return Turning(points, ends, cost).result();
}

PosePath shortened(const PosePath& path, const PoseCost& cost, const ShortenOptions& options) {
  PosePath best = path;
  double price = cost(best);
  for (const double spacing : kSpacings) {
    const auto stretches = divided(best, spacing * options.joint_m);
    PosePath shorter = Shortening(best.start, stretches, cost, options).result(best);
    const double shorter_price = cost(shorter);
    const bool improved = shorter_price < price * (1.0 - kLeastGain);
    if (shorter_price < price) best = std::move(shorter), price = shorter_price;
    if ((!improved && spacing < 1.0) || options.stop()) break;
  }
  return best;
}

}  // namespace talus::planner
