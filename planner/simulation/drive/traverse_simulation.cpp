#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/simulation/drive/loss_report.hpp>
#include <talus/planner/simulation/drive/map_expectation.hpp>
#include <talus/planner/simulation/drive/traverse_simulation.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::planner {
namespace {

using costmap::Direction;

// The route is replanned if the cost of its remainder exceeds this multiple of its cost when planned: more than
// the noise of estimates on ground as its class changes it (ours).
constexpr double kDearer = 2.0;
// Depth that a wheel digs on the spot per metre of rim travel (ours; Spirit sank to the hub in some metres).
constexpr double kDugPerMetre = 0.05;

Direction directionTo(const maps::Point& from, const maps::Point& to) {
  const double d = distance_m(from, to);
  return {(to.x_m - from.x_m) / d, (to.y_m - from.y_m) / d};
}

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
      if (const RouteStatus status = planFromHere();
          status != RouteStatus::NoRoute && status != RouteStatus::NoneFound)
        return status == RouteStatus::Found;
      const double from_m = result_.length_m;
      while (result_.length_m - from_m < options_.keep_out_radius_m)
        if (!options_.senses || !leaveOneStep(0.0)) return false;
      recordEvent("reversed");
    }
  }

  RouteStatus planFromHere() {
    Problem problem;
    problem.map = map_.published();
    problem.start = estimated();
    problem.goal = options_.goal;
    problem.goal_tolerance_m = options_.goal_tolerance_m;
    problem.prove = false;
    problem.watch = {.progress = {}, .stop = options_.watch.stop};
    Plan plan = options_.planner ? options_.planner(problem) : planner_.plan(problem);
    if (plan.status != RouteStatus::Found) return plan.status;
    route_ = std::move(plan.points);
    next_ = 1;
    planned_J_ = plan.cost_J;
    recordEvent("planned", route_);
    return plan.status;
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
      const Direction heading = directionTo(estimated(), route_[next_]);
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
    if (learned && routeTurnedDear()) return retreat(step, {"soil weaker than estimated", {}});
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
  double gradient(const Direction& heading) const {
    const costmap::CellCode code = ground();
    return code.dzDx() * heading.x + code.dzDy() * heading.y;
  }
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
    const Direction heading = directionTo(here_, to);
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

  // Returns true if the ground at four points of the outline is no weaker than (class mean - 1 sigma).
  bool standsSound() const {
    const auto& model = map_.model();
    const double reach_m = 0.5 * std::hypot(model.rover().wheelbase_m, model.rover().track_m);
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}) {
      const auto cell = map_.grid().cellAt({estimated().x_m + x * reach_m, estimated().y_m + y * reach_m});
      const auto ground = cell ? map_.ground(*cell) : std::nullopt;
      if (!ground) continue;
      const int index = map_.surface().classIndex(*cell);
      const double ordinary = map_.evidence().classBelief(index).pull.value -
                              model.parts().classes[static_cast<std::size_t>(index)].pull_std;
      if (ground->pull.value < ordinary) return false;
    }
    return true;
  }

  // Drives back in its own ruts by at least the keep-out radius, until the rover stands on sound ground,
  // where it may turn. The ground that raised the alarm is refused afterwards.
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
    while ((result_.length_m - from_m < options_.keep_out_radius_m || !standsSound()) &&
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
    const bool blind = !options_.senses && !options_.record;
    if (blind || (!now && since_sensing_m_ < options_.sensing_interval_m)) return false;
    since_sensing_m_ = 0.0;
    for (std::size_t w = 0; w < seen_.wheels.size() && options_.record; ++w)
      result_.records.push_back({w, seen_.heading_rad, seen_.wheels[w]});
    if (!options_.senses) return false;
    intake_.add(telemetryOf(seen_));
    map_.publish();
    if (options_.on_learned) options_.on_learned(result_.time_s);
    return true;
  }

  bool routeTurnedDear() {
    const MotionCost cost(map_.published());
    double left_J = cost({estimated(), route_[std::min(next_, route_.size() - 1)]});
    for (std::size_t i = next_; i + 1 < route_.size(); ++i) left_J += cost({route_[i], route_[i + 1]});
    const bool dear = !(left_J <= kDearer * planned_J_);
    planned_J_ = std::min(planned_J_, left_J);
    return dear;
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
