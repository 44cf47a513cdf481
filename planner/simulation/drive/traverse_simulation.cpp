#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::planner {

namespace {

constexpr std::size_t kRemembered = 120;  // readings
constexpr std::size_t kLeast = 20;        // readings needed for a datum

double medianOf(std::deque<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Excess sinkage divided by the wheel radius, minus the wheel's own datum (the median of earlier excesses).
double WheelAlarm::excessSinkage(std::size_t wheel, const costmap::TelemetryReading& reading,
                                 const WheelExpectation& expected) {
  if (std::isnan(reading.sinkage_m) || reading.pass > 1) return 0.0;
  std::deque<double>& before = excess_[wheel];
  const double excess = reading.sinkage_m / radius_m_ - expected.sinkage_over_radius;
  const double datum = before.size() >= kLeast ? medianOf(before) : 0.0;
  before.push_back(excess);
  if (before.size() > kRemembered) before.pop_front();
  return excess - datum;
}

WheelAlarm::AlarmCheck WheelAlarm::check(const WheelMeasurements& look,
                                         const std::vector<WheelExpectation>& expected) {
  AlarmCheck check;
  excess_.resize(std::max(excess_.size(), look.wheels.size()));
  std::size_t slipping = 0, reading_slip = 0;
  double expected_angle_rad = 0.0;
  for (std::size_t w = 0; w < look.wheels.size(); ++w) {
    const costmap::TelemetryReading& reading = look.wheels[w];
    reading_slip += std::isnan(reading.slip) ? 0U : 1U;
    // The threshold is at least the limit: downhill, slip below the limit is traction even if the expected
    // slip is negative, and a rover that stops there must climb back.
    slipping += reading.slip > std::max(expected[w].slip, 0.0) + limits_.slip ? 1U : 0U;
    expected_angle_rad = std::fmax(expected_angle_rad, expected[w].slip_angle_rad);
    check.sank.push_back(excessSinkage(w, reading, expected[w]) > limits_.sinkage);
  }
  if (slipping > 0 && 2 * slipping >= reading_slip)
    check.reason = "slips";
  else if (std::abs(look.slip_angle_rad) > expected_angle_rad + limits_.slip_angle_rad)
    check.reason = "slides";
  else if (std::find(check.sank.begin(), check.sank.end(), true) != check.sank.end())
    check.reason = "sinks";
  return check;
}

costmap::TravelState MapExpectation::at(const maps::Point& place, const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  const auto grid = map_.published();
  const auto curve = grid->at(*cell).curve();
  return grid->cost().detail(onSlope(curve >= costmap::CellCode::kUnknown ? classCurve(*cell) : curve),
                             heading);
}

costmap::TravelState MapExpectation::ofClass(const maps::Point& place,
                                             const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  costmap::TravelState state = at(place, heading);
  const costmap::TravelState of_class = map_.published()->cost().detail(onSlope(classCurve(*cell)), heading);
  state.slip = std::min(state.slip, of_class.slip);
  state.sinkage_m = std::min(state.sinkage_m, of_class.sinkage_m);
  return state;
}

WheelExpectation MapExpectation::ofWheel(const maps::Point& place, const maps::Point& middle,
                                         const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  const double radius_m = map_.model().rover().wheel.radius_m;
  return {.slip = static_cast<double>(ofClass(middle, heading).slip),
          .sinkage_over_radius = static_cast<double>(ofClass(place, heading).sinkage_m) / radius_m,
          .slip_angle_rad =
              cell ? std::abs(static_cast<double>(
                         map_.published()->cost().detail(onSlope(classCurve(*cell)), heading).slip_angle_rad))
                   : 0.0};
}

costmap::CellCode MapExpectation::onSlope(costmap::CellCode::Curve curve) const {
  return costmap::CellCode({.dz_dx = slope_.dzDx(), .dz_dy = slope_.dzDy(), .curve = curve});
}

costmap::CellCode::Curve MapExpectation::classCurve(maps::Cell cell) const noexcept {
  return static_cast<costmap::CellCode::Curve>(std::max(map_.surface().classIndex(cell), 0));
}

namespace {

// Situation in which a simulated rover was immobilised or slid.
struct LossScene {
  // Map of the planner at that time.
  const costmap::TraversabilityMap& map;
  // True soils of the world.
  const TrueWorld& world;
  const TrueWorld::Step& step;    // last step that the rover attempted
  const WheelMeasurements& seen;  // latest readings of the wheels
  maps::Point estimated;          // estimated position of the rover [m]
  std::string why_it_stopped;     // reason of the alarm at which the rover stopped; empty without an alarm
};

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// Map properties of the wheel position with the weakest estimated ground.
std::string estimateThere(const LossScene& scene) {
  std::optional<costmap::GroundBelief> weakest;
  std::uint8_t category = 0;
  for (const costmap::TelemetryReading& wheel : scene.seen.wheels) {
    const auto cell = scene.map.grid().cellAt(wheel.place);
    const auto ground = cell ? scene.map.ground(*cell) : std::nullopt;
    if (!ground || (weakest && ground->pull.value >= weakest->pull.value)) continue;
    weakest = ground;
    category = scene.map.costs().category(*cell);
  }
  if (!weakest) return "no ground on the map there";
  return std::string("category on the map: ") + terramech::name(static_cast<terramech::Category>(category)) +
         ", DP/W " + rounded(weakest->pull.value) + " +- " + rounded(weakest->pull.std);
}

std::string readings(const LossScene& scene) {
  const double radius_m = scene.map.model().rover().wheel.radius_m;
  double slip = std::nan(""), sinkage = std::nan("");
  for (const costmap::TelemetryReading& wheel : scene.seen.wheels) {
    slip = std::fmax(slip, wheel.slip);
    sinkage = std::fmax(sinkage, wheel.sinkage_m / radius_m);
  }
  return "wheels read slip up to " + rounded(slip) + ", sinkage over radius up to " + rounded(sinkage);
}

// Returns one line of text with the reason of the stop, the number of wheels on soil patches that the map
// does not contain, the map's estimate of the weakest ground under the wheels, and the readings of the
// wheels.
std::string causeOfLoss(const LossScene& scene) {
  int undeclared = 0;
  for (const TrueWorld::SimulatedWheel& wheel : scene.step.wheels)
    undeclared += scene.world.inPatch(wheel.place) ? 1 : 0;
  const std::string stop = scene.why_it_stopped.empty()
                               ? scene.step.slides ? "slid without an alarm" : "spun without an alarm"
                               : "held when it reversed after '" + scene.why_it_stopped + "'";
  return stop + "; " + std::to_string(undeclared) + " of " + std::to_string(scene.step.wheels.size()) +
         " wheels on undeclared ground; " + estimateThere(scene) + "; " + readings(scene);
}

using costmap::Direction;

// Depth that a wheel digs on the spot per metre of rim travel (ours; Spirit sank to the hub in some metres).
constexpr double kDugPerMetre = 0.05;

// One drive, step by step.
class Drive {
 public:
  Drive(costmap::TraversabilityMap& map, const TrueWorld& world, const SimulationOptions& options)
      : map_(map),
        world_(world),
        options_(options),
        intake_(map),
        sensors_(options.sensors, map.model().rover()),
        alarm_(options.alarm, map.model().rover().wheel.radius_m),
        ruts_(map.model().rover().wheel.width_m),
        here_(options.start) {}

  TraverseSimulation run() {
    arriveAt(here_, {});
    while (!options_.watch.stopped()) {
      if (!plan()) return held_ ? lost() : ended(Outcome::GaveUp, "no route is left");
      const FollowEnd end = follow();
      if (end == FollowEnd::Arrived) return ended(Outcome::Reached);
      if (end == FollowEnd::Stuck) return lost();
      if (end == FollowEnd::Tipped) return ended(Outcome::Tipped);
      if (++result_.replans > options_.max_replans) return ended(Outcome::GaveUp, "too many replans");
    }
    return ended(Outcome::GaveUp, "cancelled");
  }

 private:
  enum class FollowEnd { Arrived, Stuck, Tipped, Replan };

  TraverseSimulation lost() { return ended(last_step_.slides ? Outcome::Slid : Outcome::Immobilised); }

  TraverseSimulation ended(Outcome outcome, std::string cause = {}) {
    result_.outcome = outcome;
    if (!cause.empty())
      result_.cause = std::move(cause);
    else if (outcome == Outcome::Immobilised || outcome == Outcome::Slid)
      result_.cause = causeOfLoss({map_, world_, last_step_, seen_, estimated(), why_it_stopped_});
    recordEvent(std::string(name(outcome)));
    return std::move(result_);
  }

  void recordEvent(std::string text, std::vector<maps::Point> route = {}) {
    result_.events.push_back({result_.time_s, std::move(text), std::move(route)});
  }

  // Plans from the estimated position. If the ground under the rover or all ground around it is refused, the
  // rover first drives back along its track, a keep-out radius at a time, until a route is found.
  bool plan() {
    const MotionCost cost(map_.published());
    for (;;) {
      while (options_.senses && !cost.allowed(estimated()))
        if (!leaveOneStep(0.0)) return false;
      Plan plan = planned();
      if (plan.status == RouteStatus::Found) {
        route_ = std::move(plan.points);
        next_ = 1;
        planned_J_ = plan.cost_J;
        recordEvent("planned", route_);
        return true;
      }
      if (plan.status != RouteStatus::NoRoute && plan.status != RouteStatus::NoneFound) return false;
      const double from_m = result_.length_m;
      while (result_.length_m - from_m < options_.keep_out_radius_m)
        if (!options_.senses || !leaveOneStep(0.0)) return false;
      recordEvent("reversed");
    }
  }

  // Plans from the estimated position.
  Plan planned() {
    Problem problem;
    problem.map = map_.published();
    problem.start = estimated();
    problem.goal = options_.goal;
    problem.goal_tolerance_m = options_.goal_tolerance_m;
    problem.prove = false;
    problem.watch = {.progress = {}, .stop = options_.watch.stop};
    return options_.planner ? options_.planner(problem) : planner_.plan(problem);
  }

  // Estimated position of the rover.
  maps::Point estimated() const { return sensors_.estimatedPlace(here_); }

  FollowEnd follow() {
    while (next_ < route_.size()) {
      const double left = distance_m(estimated(), route_[next_]);
      if (left < 1e-9) {
        ++next_;
        continue;
      }
      if (options_.watch.stopped()) return FollowEnd::Replan;
      const Direction heading = directionOf({estimated(), route_[next_]});
      if (tipped(heading)) return FollowEnd::Tipped;
      const auto end = lookAndStep(heading, std::min(left, options_.step_m));
      if (end) return *end;
    }
    return FollowEnd::Arrived;
  }

  // Reads the wheels once, then drives one step unless the leg ends.
  std::optional<FollowEnd> lookAndStep(const Direction& heading, double length_m) {
    const TrueWorld::Step step = world_.drive(motion(heading, dug_m_));
    result_.max_slip = std::max(result_.max_slip, step.slip);
    last_step_ = step;
    seen_ = sensors_.look(step, {.time_s = result_.time_s,
                                 .heading = heading,
                                 .gradient = gradient(heading),
                                 .across = gradient({-heading.y, heading.x}),
                                 .dug_m = dug_m_});
    if (step.stuck && !options_.senses) return FollowEnd::Stuck;
    const WheelAlarm::AlarmCheck check =
        options_.senses ? alarm_.check(seen_, expectations(step, heading)) : WheelAlarm::AlarmCheck{};
    const bool learned = learn(check.reason.has_value());
    if (check.reason) return retreat(step, check);
    if (step.slides) return FollowEnd::Stuck;
    if (step.stuck) return dig(step);
    if (learned && anotherRoutePays()) return retreat(step, {"soil weaker than estimated", {}});
    report(step, heading, length_m);
    if (const auto before = std::exchange(heading_, heading)) {
      const terramech::TurnEffort turn = world_.turn(*before, motion(heading, 0.0));
      result_.energy_J += turn.energy_J;
      result_.time_s += turn.time_s;
    }
    advance(step, heading, length_m);
    return std::nullopt;
  }

  // One step of spinning on the spot by a rover that does not sense the stall.
  std::optional<FollowEnd> dig(const TrueWorld::Step& step) {
    const double radius_m = map_.model().rover().wheel.radius_m;
    dug_m_ += kDugPerMetre * options_.step_m;
    result_.energy_J += std::max(step.torque_Nm, 0.0) * options_.step_m / radius_m;
    result_.time_s += options_.step_m / map_.model().rover().max_speed_mps;
    why_it_stopped_.clear();
    return dug_m_ > radius_m ? std::optional(FollowEnd::Stuck) : std::nullopt;
  }

  void report(const TrueWorld::Step& step, const Direction& heading, double length_m) const {
    if (!options_.on_step) return;
    const costmap::TravelState state = MapExpectation(map_, ground()).at(estimated(), heading);
    const double slope = gradient(heading);
    options_.on_step(
        {.time_s = result_.time_s,
         .place = here_,
         .heading = heading,
         .gradient = slope,
         .length_m = length_m,
         .expected_slip = static_cast<double>(state.slip),
         .expected_energy_J_per_m = static_cast<double>(state.energy_J_per_m) / std::hypot(1.0, slope),
         .truth = step});
  }

  // Cell code under the rover's centre.
  costmap::CellCode ground() const {
    const auto cell = map_.grid().cellAt(here_);
    return cell ? map_.published()->at(*cell) : costmap::CellCode();
  }
  double gradient(const Direction& heading) const { return gradientOf(ground(), heading).along; }
  Motion motion(const Direction& heading, double dug_m) const {
    return {.place = here_,
            .heading = heading,
            .gradient = gradient(heading),
            .across = gradient({-heading.y, heading.x}),
            .dug_m = dug_m,
            .ruts = &ruts_};
  }

  std::vector<WheelExpectation> expectations(const TrueWorld::Step& step, const Direction& heading) const {
    const MapExpectation map(map_, ground());
    std::vector<WheelExpectation> of_wheels;
    for (const TrueWorld::SimulatedWheel& wheel : step.wheels)
      of_wheels.push_back(map.ofWheel(sensors_.estimatedPlace(wheel.place), estimated(), heading));
    return of_wheels;
  }

  bool tipped(const Direction& heading) const {
    const auto& rover = map_.model().rover();
    return std::abs(std::atan(gradient(heading))) > 1.5 * rover.max_pitch_rad ||
           std::abs(std::atan(gradient({-heading.y, heading.x}))) > 1.5 * rover.max_roll_rad;
  }

  void spend(const TrueWorld::Step& step, double length_m, double gradient) {
    const double surface_m = length_m * std::hypot(1.0, gradient);
    result_.energy_J += step.energy_J_per_m * surface_m;
    result_.time_s += surface_m / step.speed_mps;
    result_.length_m += length_m;
    for (const TrueWorld::SimulatedWheel& wheel : step.wheels) ruts_.press(wheel.place);
    ruts_.moved(length_m);
    sensors_.moved(length_m);
  }

  void arriveAt(const maps::Point& place, const TrueWorld::Step& step) {
    here_ = place;
    double deepest = 0.0;
    for (const TrueWorld::SimulatedWheel& wheel : step.wheels)
      deepest = std::max(deepest, wheel.forces.sinkage);
    result_.track.push_back(
        {place, result_.time_s, result_.energy_J, step.slip, deepest * map_.model().rover().wheel.radius_m});
  }

  void advance(const TrueWorld::Step& step, const Direction& heading, double length_m) {
    const bool there = length_m >= distance_m(estimated(), route_[next_]) - 1e-9;
    dug_m_ = 0.0;
    downhill_ = false;
    spend(step, length_m, gradient(heading));
    since_sensing_m_ += length_m;
    way_back_.push_back(here_);
    arriveAt({here_.x_m + length_m * heading.x, here_.y_m + length_m * heading.y}, step);
    if (there) ++next_;
  }

  // Drives one step back along the track. Returns false at the end of the track or if the rover is stuck.
  bool backOneStep(double dug_m) {
    while (!way_back_.empty() && distance_m(way_back_.back(), here_) < 1e-9) way_back_.pop_back();
    if (way_back_.empty()) return false;
    const maps::Point to = way_back_.back();
    const Direction heading = directionOf({here_, to});
    const double slope = gradient(heading);
    const TrueWorld::Step step = world_.drive(motion(heading, dug_m));
    if (step.stuck) {
      held_ = true;
      last_step_ = step;
      return false;
    }
    way_back_.pop_back();
    spend(step, distance_m(here_, to), slope);
    arriveAt(to, step);
    return true;
  }

  // Drives one step straight down the slope, which needs no side force. Returns false if the rover is stuck.
  bool downOneStep() {
    const costmap::CellCode code = ground();
    const double steepest = std::hypot(code.dzDx(), code.dzDy());
    if (!(steepest > 0.0)) return false;
    const Direction heading{-code.dzDx() / steepest, -code.dzDy() / steepest};
    const TrueWorld::Step step = world_.drive(motion(heading, 0.0));
    if (step.stuck) {
      last_step_ = step;
      return false;
    }
    spend(step, options_.step_m, steepest);
    way_back_.push_back(here_);
    arriveAt({here_.x_m + options_.step_m * heading.x, here_.y_m + options_.step_m * heading.y}, step);
    return true;
  }

  // Leaves unsuitable ground by one step: back along the track, or downhill if the rover slides there.
  bool leaveOneStep(double dug_m) {
    if (!downhill_ && backOneStep(dug_m)) return true;
    if (!downhill_ && !(held_ && last_step_.slides)) return false;
    held_ = !downOneStep();
    if (!downhill_ && !held_) recordEvent("turned downhill");
    downhill_ = !held_;
    return downhill_;
  }

  // Drives back in its own ruts by the keep-out radius; plan() leaves ground that the map refuses. The ground that
  // raised the alarm is refused afterwards.
  FollowEnd retreat(const TrueWorld::Step& stopped, const WheelAlarm::AlarmCheck& check) {
    recordEvent(*check.reason);
    why_it_stopped_ = *check.reason;
    const double radius_m = map_.model().rover().wheel.radius_m;
    const double spun_m = stopped.stuck ? options_.stall_detection_m * stopped.slip : 0.0;
    result_.energy_J += std::max(stopped.torque_Nm, 0.0) * spun_m / radius_m;
    for (const TrueWorld::SimulatedWheel& wheel : stopped.wheels) ruts_.press(wheel.place);
    ruts_.turnBack();
    double hole_m = std::exchange(dug_m_, 0.0) + kDugPerMetre * spun_m;
    const double from_m = result_.length_m;
    while (result_.length_m - from_m < options_.keep_out_radius_m &&
           leaveOneStep(std::exchange(hole_m, 0.0))) {
    }
    ruts_.turnBack();
    if (held_) return FollowEnd::Stuck;
    recordEvent("reversed");
    if (!check.sank.empty()) refuseGround(stopped, check);
    return FollowEnd::Replan;
  }

  // Refuses the ground under wheels that sank and the two foremost wheels, but not under the rover itself.
  void refuseGround(const TrueWorld::Step& stopped, const WheelAlarm::AlarmCheck& check) {
    ++result_.alarms;
    const double outline_m = 0.5 * std::hypot(map_.model().rover().wheelbase_m, map_.model().rover().track_m);
    for (std::size_t w = 0; w < stopped.wheels.size(); ++w) {
      if (w >= 2 && !check.sank[w]) continue;
      const maps::Point& at = stopped.wheels[w].place;
      const double room_m = distance_m(at, here_) - outline_m;
      if (room_m > 0.0)
        map_.refuse(sensors_.estimatedPlace(at), std::min(options_.keep_out_radius_m, room_m));
    }
    map_.publish();
    if (options_.on_learned) options_.on_learned(result_.time_s);
  }

  // Adds readings to the map at each sensing interval, or if `now`. Returns true if the map was updated.
  bool learn(bool now) {
    if (!now && since_sensing_m_ < options_.sensing_interval_m) return false;
    since_sensing_m_ = 0.0;
    for (std::size_t w = 0; w < seen_.wheels.size() && options_.record; ++w)
      result_.records.push_back({w, seen_.heading_rad, seen_.wheels[w]});
    if (!options_.senses) return false;
    intake_.add(telemetryOf(seen_));
    map_.publish();
    if (options_.on_learned) options_.on_learned(result_.time_s);
    return true;
  }

  // Standard deviation of the cost of a route: ground stronger by s costs what it costs at a gradient lower by s.
  double deviation_J(const std::vector<maps::Point>& route) const {
    const auto grid = map_.published();
    double sum_J = 0.0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const Direction on = directionOf({route[i], route[i + 1]});
      for (double m = 0.5 * options_.step_m; m < distance_m(route[i], route[i + 1]); m += options_.step_m) {
        const auto cell = map_.grid().cellAt({route[i].x_m + m * on.x, route[i].y_m + m * on.y});
        const auto ground = cell ? map_.costs().ground(*cell) : std::nullopt;
        if (!ground) continue;
        const double s = ground->pull.std;
        const costmap::CellCode code = grid->at(*cell),
                                stronger({code.dzDx() - s * on.x, code.dzDy() - s * on.y, code.curve()});
        sum_J += options_.step_m * static_cast<double>(grid->cost().costPerMetre(code, on) -
                                                       grid->cost().costPerMetre(stronger, on));
      }
    }
    return std::abs(sum_J);
  }

  // True if the rest of the route became dearer, and another is cheaper by more than the deviation of the difference.
  bool anotherRoutePays() {
    std::vector<maps::Point> rest{estimated()};
    rest.insert(rest.end(), route_.begin() + static_cast<std::ptrdiff_t>(next_), route_.end());
    const double left_J = MotionCost(map_.published()).ofLegs(rest), noise_J = deviation_J(rest);
    const double before_J = std::exchange(planned_J_, std::min(planned_J_, left_J));
    if (!std::isfinite(left_J) || left_J <= before_J + noise_J) return !std::isfinite(left_J);
    planned_J_ = left_J;
    const Plan other = planned();
    return other.status == RouteStatus::Found &&
           left_J - other.cost_J > std::hypot(noise_J, deviation_J(other.points));
  }

  costmap::TraversabilityMap& map_;
  const TrueWorld& world_;
  const SimulationOptions& options_;
  costmap::DriveIntake intake_;
  SimulatedSensors sensors_;
  WheelAlarm alarm_;
  FieldPlanner planner_;
  Ruts ruts_;
  maps::Point here_;
  std::optional<Direction> heading_;  // of the previous step
  std::vector<maps::Point> way_back_;
  std::vector<maps::Point> route_;
  std::size_t next_ = 1;
  double planned_J_ = 0.0;
  double since_sensing_m_ = 0.0;
  double dug_m_ = 0.0;         // depth of the holes in which the wheels stand
  TrueWorld::Step last_step_;  // last step attempted
  WheelMeasurements seen_;     // readings of the wheels before the last step
  std::string why_it_stopped_;
  bool held_ = false;
  bool downhill_ = false;  // slides, and leaves by the fall line
  TraverseSimulation result_;
};

}  // namespace

std::string_view name(Outcome outcome) noexcept {
  constexpr std::string_view kNames[] = {"reached", "immobilised", "tipped", "gave_up", "slid"};
  return kNames[static_cast<int>(outcome)];
}

TraverseSimulation simulateTraverse(costmap::TraversabilityMap& map, const TrueWorld& world,
                                    const SimulationOptions& options) {
  return Drive(map, world, options).run();
}

}  // namespace talus::planner
