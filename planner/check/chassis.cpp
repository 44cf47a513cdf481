#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <talus/maps/maps.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {
namespace {

using maps::Point;

constexpr int kBellyParts = 6;  // sections of the belly along and across
constexpr int kTightenings = 4;
constexpr double kStep = 0.1;  // spacing of the poses checked along a motion [wheelbases]

double asine(double sine) noexcept {
  return std::asin(std::clamp(sine, -1.0, 1.0));
}

void widen(Bounds& bounds, double value) noexcept {
  bounds.low = std::min(bounds.low, value);
  bounds.high = std::max(bounds.high, value);
}

Bounds nothing() noexcept {
  return {INFINITY, -INFINITY};
}

Point placed(const Pose& pose, double x_m, double y_m) noexcept {
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  return {pose.place.x_m + c * x_m - s * y_m, pose.place.y_m + s * x_m + c * y_m};
}

}  // namespace

std::string_view name(Suspension suspension) noexcept {
  return suspension == Suspension::Rigid ? "rigid" : "rocker-bogie";
}

Chassis::Chassis(const maps::Raster<float>& elevation_m, const terramech::Rover& rover, Suspension suspension)
    : elevation_m_(elevation_m),
      rover_(rover),
      suspension_(suspension),
      reach_m_(0.5 * std::hypot(rover.wheelbase_m, rover.track_m)) {
  if (suspension == Suspension::RockerBogie && rover.wheel_count != 6)
    throw std::invalid_argument("rover '" + rover.name + "': wheels.count = " +
                                std::to_string(rover.wheel_count) + ", must be 6 for a rocker-bogie");
  const int axles = std::max(2, rover.wheel_count / 2);
  for (int k = 0; k < axles; ++k)
    for (const double side : {0.5, -0.5})
      p_body_wheels_.push_back(
          {rover.wheelbase_m * (0.5 - static_cast<double>(k) / (axles - 1)), side * rover.track_m});
}

// Plane of the ground under the rover, from the heights at the ends of a cross; level if a height is unknown.
// The bounds hold for any plane; a close plane makes them tight.
Chassis::Plane Chassis::planeUnder(const Pose& pose) const {
  const double arm_m = std::max(reach_m_, 0.5 * elevation_m_.grid().resolution_m);
  const auto height = [&](double dx, double dy) {
    return maps::elevationAt(elevation_m_, {pose.place.x_m + dx, pose.place.y_m + dy}).value_or(NAN);
  };
  const double east = (height(arm_m, 0.0) - height(-arm_m, 0.0)) / (2.0 * arm_m);
  const double north = (height(0.0, arm_m) - height(0.0, -arm_m)) / (2.0 * arm_m);
  return {pose.place, std::isfinite(east) ? east : 0.0, std::isfinite(north) ? north : 0.0};
}

// Returns the smallest and largest height of the bilinear surface above a plane over a square. On each patch
// between four cell centres, both extremes lie at corners of the intersection of the square and the patch.
std::optional<Bounds> Chassis::above(const Plane& plane, Point middle, double reach_m) const {
  const maps::Grid& grid = elevation_m_.grid();
  const auto inCells = [&](double metres, double corner) {
    return (metres - corner) / grid.resolution_m - 0.5;
  };
  const double left = inCells(middle.x_m - reach_m, grid.south_west.x_m),
               right = inCells(middle.x_m + reach_m, grid.south_west.x_m),
               low = inCells(middle.y_m - reach_m, grid.south_west.y_m),
               high = inCells(middle.y_m + reach_m, grid.south_west.y_m);
  if (!(left >= 0.0 && low >= 0.0 && right <= grid.width - 1 && high <= grid.height - 1)) return std::nullopt;
  Bounds found = nothing();
  for (int row = static_cast<int>(low); row < std::max(high, std::floor(low) + 1e-12); ++row)
    for (int column = static_cast<int>(left); column < std::max(right, std::floor(left) + 1e-12); ++column) {
      const int east = std::min(column + 1, grid.width - 1), north = std::min(row + 1, grid.height - 1);
      const auto at = [&](int c, int r) { return static_cast<double>(elevation_m_[{c, r}]); };
      const double sw = at(column, row), se = at(east, row), nw = at(column, north), ne = at(east, north);
      for (const double x : {std::max(left, column + 0.0), std::min(right, column + 1.0)})
        for (const double y : {std::max(low, row + 0.0), std::min(high, row + 1.0)}) {
          const double u = x - column, v = y - row;
          const double z = (1 - v) * ((1 - u) * sw + u * se) + v * ((1 - u) * nw + u * ne);
          if (!std::isfinite(z)) return std::nullopt;
          widen(found, z - plane.at({grid.south_west.x_m + (x + 0.5) * grid.resolution_m,
                                     grid.south_west.y_m + (y + 0.5) * grid.resolution_m}));
        }
    }
  return found;
}

// Horizontal displacement of a point of the body at contact height when the body tilts: the long axis
// shortens to cos(pitch); the cross axis, perpendicular to it, also swings forward by tan(pitch) sin(roll).
double Chassis::moves_m(double x_m, double y_m, const Tilt& tilt) noexcept {
  const double rise = std::sin(tilt.roll_rad), swing = std::tan(tilt.pitch_rad) * rise;
  const double side = std::sqrt(std::max(0.0, 1.0 - rise * rise - swing * swing));
  return std::abs(x_m) * (1.0 - std::cos(tilt.pitch_rad)) + std::abs(y_m) * (swing + 1.0 - side);
}

// A shift of the whole rover raises all wheels equally along the plane, so only deviations from the plane are
// added for a shift.
std::optional<Chassis::Heights> Chassis::heights(const Place& place, const Tilt& tilt) const {
  Heights z;
  for (const BodyPoint& wheel : p_body_wheels_) {
    const Point nominal = placed(place.pose, wheel.x_m, wheel.y_m);
    const double own_m = moves_m(wheel.x_m, wheel.y_m, tilt) + place.slack.turn_m;
    const auto rough = above(place.plane, nominal, own_m + place.slack.shift_m);
    if (!rough) return std::nullopt;
    const double even = place.plane.at(nominal), lift = place.plane.steepness() * own_m;
    z.push_back({even + rough->low - lift, even + rough->high + lift});
  }
  return z;
}

// Three wheels carry the rover, two of them on one side; the rise between these two wheels is the rise of the
// long axis. The third wheel lies opposite a point of the line through the first two, which is nowhere below
// the ground and nowhere above the highest such line.
Stance Chassis::rigid(const Heights& z) const {
  Bounds pitch = nothing(), roll = nothing();
  const std::size_t axles = p_body_wheels_.size() / 2;
  const auto x = [&](std::size_t axle) { return p_body_wheels_[2 * axle].x_m; };
  for (const std::size_t side : {0U, 1U}) {
    std::vector<double> highest(axles, -INFINITY);
    for (std::size_t a = 0; a < axles; ++a)
      for (std::size_t b = a + 1; b < axles; ++b) {
        const Bounds &front = z[2 * a + side], &rear = z[2 * b + side];
        const double apart = x(a) - x(b);
        widen(pitch, asine((front.high - rear.low) / apart));
        widen(pitch, asine((front.low - rear.high) / apart));
        for (std::size_t k = 0; k < axles; ++k) {
          const double share = (x(k) - x(b)) / apart;
          highest[k] = std::max({highest[k], share * front.high + (1 - share) * rear.high,
                                 share * front.low + (1 - share) * rear.high,
                                 share * front.high + (1 - share) * rear.low});
        }
      }
    const double sign = side == 0 ? 1.0 : -1.0;
    for (std::size_t k = 0; k < axles; ++k) {
      const Bounds &own = z[2 * k + side], &other = z[2 * k + 1 - side];
      widen(roll, sign * asine((highest[k] - other.low) / rover_.track_m));
      widen(roll, sign * asine((own.low - other.high) / rover_.track_m));
    }
  }
  return {.pitch_rad = pitch, .roll_rad = roll};
}

// The bogie pivot lies midway between front and middle wheel, the body pivot a third of the way from the
// bogie pivot to the rear wheel, at the mean of the three wheels of its side. The body's pitch is the mean of
// both rockers' pitch.
Stance Chassis::rockerBogie(const Heights& z) const {
  const double rocker_m = 0.75 * rover_.wheelbase_m;
  Stance stance;
  double low[2], high[2];
  for (const std::size_t side : {0U, 1U}) {
    const Bounds &front = z[side], &middle = z[2 + side], &rear = z[4 + side];
    stance.pitch_rad.low += 0.5 * asine((0.5 * (front.low + middle.low) - rear.high) / rocker_m);
    stance.pitch_rad.high += 0.5 * asine((0.5 * (front.high + middle.high) - rear.low) / rocker_m);
    low[side] = (front.low + middle.low + rear.low) / 3.0;
    high[side] = (front.high + middle.high + rear.high) / 3.0;
  }
  stance.roll_rad = {asine((low[0] - high[1]) / rover_.track_m), asine((high[0] - low[1]) / rover_.track_m)};
  return stance;
}

// Returns a lower bound of the height of the belly's sections above the ground below them. `under(x, y)`
// returns a lower bound of the height of the contact plane at a point of the body.
template <typename Under>
std::optional<double> Chassis::clearance(const Place& place, const Tilt& tilt, Under under) const {
  const double length_m = rover_.wheelbase_m / kBellyParts, width_m = rover_.track_m / kBellyParts;
  const double lean = std::min(1.0, std::hypot(std::sin(tilt.pitch_rad), std::sin(tilt.roll_rad)));
  const double lean_m = rover_.clearance_m * lean,
               belly_m = rover_.clearance_m * std::sqrt(1.0 - lean * lean);
  double least = INFINITY;
  for (int i = 0; i < kBellyParts; ++i)
    for (int k = 0; k < kBellyParts; ++k) {
      const double x = rover_.wheelbase_m / 2 - (i + 0.5) * length_m,
                   y = rover_.track_m / 2 - (k + 0.5) * width_m;
      const double own_m =
          moves_m(std::abs(x) + length_m / 2, std::abs(y) + width_m / 2, tilt) + lean_m + place.slack.turn_m;
      const auto rough = above(place.plane, placed(place.pose, x, y),
                               0.5 * std::hypot(length_m, width_m) + own_m + place.slack.shift_m);
      if (!rough) return std::nullopt;
      double over_plane = INFINITY;
      for (const double dx : {-0.5 * length_m, 0.5 * length_m})
        for (const double dy : {-0.5 * width_m, 0.5 * width_m})
          over_plane = std::min(over_plane,
                                under(x + dx, y + dy) - place.plane.at(placed(place.pose, x + dx, y + dy)));
      least = std::min(least, over_plane + belly_m - rough->high - place.plane.steepness() * own_m);
    }
  return least;
}

std::optional<Stance> Chassis::stance(const Pose& pose, const Slack& slack) const {
  const Place place{pose, slack, planeUnder(pose)};
  Tilt tilt{rover_.max_pitch_rad, rover_.max_roll_rad};
  std::optional<Heights> z;
  Stance stance;
  // Every stance within a tilt limit lies within the bounds computed from that limit, so the limit can be
  // tightened to the bounds.
  for (int round = 0; round < kTightenings; ++round) {
    z = heights(place, tilt);
    if (!z) return std::nullopt;
    stance = suspension_ == Suspension::Rigid ? rigid(*z) : rockerBogie(*z);
    tilt = {std::min(tilt.pitch_rad, std::max(stance.pitch_rad.high, -stance.pitch_rad.low)),
            std::min(tilt.roll_rad, std::max(stance.roll_rad.high, -stance.roll_rad.low))};
  }
  const auto clear_m =
      suspension_ == Suspension::Rigid ? underRigid(place, tilt, *z) : underRockerBogie(place, tilt, *z);
  if (!clear_m) return std::nullopt;
  stance.clearance_m = *clear_m;
  return stance;
}

// No wheel is below the ground, and the contact plane at a point of the belly is a weighted mean of its
// corners.
std::optional<double> Chassis::underRigid(const Place& place, const Tilt& tilt, const Heights& z) const {
  const std::size_t last = z.size() - 2;
  return clearance(place, tilt, [&](double x, double y) {
    const double u = 0.5 + x / rover_.wheelbase_m, v = 0.5 + y / rover_.track_m;
    return u * (v * z[0].low + (1 - v) * z[1].low) + (1 - u) * (v * z[last].low + (1 - v) * z[last + 1].low);
  });
}

std::optional<double> Chassis::underRockerBogie(const Place& place, const Tilt& tilt,
                                                const Heights& z) const {
  const Stance bounds = rockerBogie(z);
  double middle_m = 0.0;
  for (const Bounds& wheel : z) middle_m += wheel.low / static_cast<double>(z.size());
  const auto lift = [](double metres, const Bounds& angle) {
    return std::min(metres * std::sin(angle.low), metres * std::sin(angle.high));
  };
  return clearance(place, tilt, [&](double x, double y) {
    return middle_m + lift(x, bounds.pitch_rad) + lift(y, bounds.roll_rad);
  });
}

std::string_view Chassis::refusal(const Pose& pose, const Slack& slack) const {
  const auto found = stance(pose, slack);
  if (!found) return "elevation under the chassis unknown";
  if (found->pitch_rad.high > rover_.max_pitch_rad || found->pitch_rad.low < -rover_.max_pitch_rad)
    return "chassis pitch above its limit";
  if (found->roll_rad.high > rover_.max_roll_rad || found->roll_rad.low < -rover_.max_roll_rad)
    return "chassis roll above its limit";
  return found->clearance_m < 0.0 ? "ground clearance of the chassis too small" : "";
}

std::vector<Violation> Chassis::violations(const PosePath& drive) const {
  std::vector<Violation> found;
  Pose pose = drive.start;
  for (const PosePath::Leg& leg : drive.legs) {
    // No wheel moves farther than the body's centre plus its own rotation about the centre.
    const double shift_m = std::abs(leg.arc.length_m);
    const double turn_m = reach_m_ * std::abs(leg.turn_rad + leg.arc.length_m * leg.arc.curvature_1_m);
    const double swept_m = shift_m + turn_m;
    const int parts = std::max(1, static_cast<int>(std::ceil(swept_m / (kStep * rover_.wheelbase_m))));
    for (int k = 0; k < parts; ++k) {
      const double share = (k + 0.5) / parts;
      const Pose at =
          after(pose, PosePath::Leg{{leg.arc.length_m * share, leg.arc.curvature_1_m}, leg.turn_rad * share});
      const std::string_view reason = refusal(at, {0.5 * shift_m / parts, 0.5 * turn_m / parts});
      if (!reason.empty()) found.push_back({at.place, std::string(reason)});
    }
    pose = after(pose, leg);
  }
  return found;
}

std::vector<Violation> Chassis::violations(const std::vector<maps::Point>& route) const {
  PosePath drive;
  double heading = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double dx = route[i].x_m - route[i - 1].x_m, dy = route[i].y_m - route[i - 1].y_m;
    if (dx == 0.0 && dy == 0.0) continue;
    const double ahead = std::atan2(dy, dx);
    if (drive.legs.empty())
      drive.start = {route[i - 1], ahead};
    else
      drive.legs.push_back({{}, std::remainder(ahead - heading, 2.0 * std::numbers::pi)});
    drive.legs.push_back({{std::hypot(dx, dy), 0.0}, 0.0});
    heading = ahead;
  }
  return violations(drive);
}

}  // namespace talus::planner
