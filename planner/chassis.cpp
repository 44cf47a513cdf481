#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <planner/chassis.hpp>

namespace talus::planner {
namespace {

using maps::Point;

constexpr int kBellyParts = 6;        // of the belly, along and across
constexpr double kStep_cells = 0.25;  // between the poses looked at along a motion
constexpr double kLeastStep = 0.05;   // and no finer than this share of the wheelbase

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
      wheels_.push_back(
          {rover.wheelbase_m * (0.5 - static_cast<double>(k) / (axles - 1)), side * rover.track_m});
}

// Least and greatest height of the bilinear surface over a square: on each patch between four middles both
// lie at corners of what the square shares with it.
std::optional<Bounds> Chassis::ground(Point middle, double reach_m) const {
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
          widen(found, z);
        }
    }
  return found;
}

// How far a point of the body, at the height of the contacts, moves in the map plane while it tilts within
// its limits.
double Chassis::tilt_m(double x_m, double y_m) const noexcept {
  const double tilt = rover_.max_pitch_rad + rover_.max_roll_rad;
  return std::hypot(x_m, y_m) * (1.0 - std::cos(std::min(tilt, M_PI / 2)));
}

std::optional<Chassis::Heights> Chassis::heights(const Pose& pose, double slack_m) const {
  Heights z;
  for (const Wheel& wheel : wheels_) {
    const auto found = ground(placed(pose, wheel.x_m, wheel.y_m), tilt_m(wheel.x_m, wheel.y_m) + slack_m);
    if (!found) return std::nullopt;
    z.push_back(*found);
  }
  return z;
}

// Three wheels carry, two of them on one side: the rise between those two is the rise of the long axis. The
// third lies across from a point of the line through them, which is nowhere below the ground and nowhere
// above the highest such line.
Stance Chassis::rigid(const Heights& z) const {
  Bounds pitch = nothing(), roll = nothing();
  const std::size_t axles = wheels_.size() / 2;
  const auto x = [&](std::size_t axle) { return wheels_[2 * axle].x_m; };
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

// The bogie's pivot lies half way between front and middle wheel, the body's a third of the way from there to
// the rear: at the mean of the three wheels of its side. The body pitches by the mean of both rockers.
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

// The least that parts of the belly stand above the ground that they can be above; `under` tells the height
// of the plane of contacts below a point of the body, at least.
template <typename Under>
std::optional<double> Chassis::clearance(const Pose& pose, double slack_m, Under under) const {
  const double length_m = rover_.wheelbase_m / kBellyParts, width_m = rover_.track_m / kBellyParts;
  const double lean_m =
      rover_.clearance_m * std::sin(std::min(rover_.max_pitch_rad + rover_.max_roll_rad, M_PI / 2));
  const double pitch = std::sin(rover_.max_pitch_rad), roll = std::sin(rover_.max_roll_rad);
  const double belly_m = rover_.clearance_m * std::sqrt(std::max(0.0, 1.0 - pitch * pitch - roll * roll));
  double least = INFINITY;
  for (int i = 0; i < kBellyParts; ++i)
    for (int k = 0; k < kBellyParts; ++k) {
      const double x = rover_.wheelbase_m / 2 - (i + 0.5) * length_m,
                   y = rover_.track_m / 2 - (k + 0.5) * width_m;
      const double reach_m = 0.5 * std::hypot(length_m, width_m) + tilt_m(x, y) + lean_m + slack_m;
      const auto below = ground(placed(pose, x, y), reach_m);
      if (!below) return std::nullopt;
      double plane = INFINITY;
      for (const double dx : {-0.5, 0.5})
        for (const double dy : {-0.5, 0.5})
          plane = std::min(plane, under(x + dx * length_m, y + dy * width_m));
      least = std::min(least, plane + belly_m - below->high);
    }
  return least;
}

std::optional<Stance> Chassis::stance(const Pose& pose, double slack_m) const {
  const auto z = heights(pose, slack_m);
  if (!z) return std::nullopt;
  std::optional<double> clear_m;
  Stance stance;
  if (suspension_ == Suspension::Rigid) {
    stance = rigid(*z);
    // No wheel is below the ground, and the plane at a point of the belly is a mean of its corners.
    const std::size_t last = z->size() - 2;
    clear_m = clearance(pose, slack_m, [&](double x, double y) {
      const double u = 0.5 + x / rover_.wheelbase_m, v = 0.5 + y / rover_.track_m;
      return u * (v * (*z)[0].low + (1 - v) * (*z)[1].low) +
             (1 - u) * (v * (*z)[last].low + (1 - v) * (*z)[last + 1].low);
    });
  } else {
    stance = rockerBogie(*z);
    double middle_m = 0.0;
    for (const Bounds& wheel : *z) middle_m += wheel.low / static_cast<double>(z->size());
    const auto lift = [](double metres, const Bounds& angle) {
      return std::min(metres * std::sin(angle.low), metres * std::sin(angle.high));
    };
    clear_m = clearance(pose, slack_m, [&](double x, double y) {
      return middle_m + lift(x, stance.pitch_rad) + lift(y, stance.roll_rad);
    });
  }
  if (!clear_m) return std::nullopt;
  stance.clearance_m = *clear_m;
  return stance;
}

std::string_view Chassis::refusal(const Pose& pose, double slack_m) const {
  const auto found = stance(pose, slack_m);
  if (!found) return "the ground under the chassis is not known";
  if (found->pitch_rad.high > rover_.max_pitch_rad || found->pitch_rad.low < -rover_.max_pitch_rad)
    return "the chassis may pitch beyond its limit";
  if (found->roll_rad.high > rover_.max_roll_rad || found->roll_rad.low < -rover_.max_roll_rad)
    return "the chassis may roll beyond its limit";
  return found->clearance_m < 0.0 ? "the belly may touch the ground" : "";
}

double Chassis::step_m() const noexcept {
  return std::max(kStep_cells * elevation_m_.grid().resolution_m, kLeastStep * rover_.wheelbase_m);
}

std::vector<Violation> Chassis::violations(const PosePath& drive) const {
  std::vector<Violation> found;
  Pose pose = drive.start;
  for (const PosePath::Leg& leg : drive.legs) {
    // No wheel goes further than the body's middle and its own circle about it.
    const double swept_m = std::abs(leg.arc.length_m) +
                           reach_m_ * std::abs(leg.turn_rad + leg.arc.length_m * leg.arc.curvature_1_m);
    const int parts = std::max(1, static_cast<int>(std::ceil(swept_m / step_m())));
    for (int k = 0; k < parts; ++k) {
      const double share = (k + 0.5) / parts;
      const Pose at =
          after(pose, PosePath::Leg{{leg.arc.length_m * share, leg.arc.curvature_1_m}, leg.turn_rad * share});
      const std::string_view reason = refusal(at, 0.5 * swept_m / parts);
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
      drive.legs.push_back({{}, std::remainder(ahead - heading, 2.0 * M_PI)});
    drive.legs.push_back({{std::hypot(dx, dy), 0.0}, 0.0});
    heading = ahead;
  }
  return violations(drive);
}

}  // namespace talus::planner
