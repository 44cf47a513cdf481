#include <cmath>
#include <random>

#include <costmap/wheel_observation.hpp>
#include <planner/field_planner.hpp>
#include <planner/motion_cost.hpp>
#include <planner/rehearsal.hpp>

namespace talus::planner {
namespace {

using costmap::Direction;

// Standard deviations of the rover's sensors: those that WheelObserver expects.
constexpr double kSlipNoise = 0.02, kTorqueNoise = 0.05, kSinkageNoise = 0.03;
// The route is planned anew when what is left of it costs this much more than when it was planned.
constexpr double kDearer = 1.3;

double distance_m(const maps::Point& a, const maps::Point& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

// One drive, step by step.
class Drive {
 public:
  Drive(costmap::TraversabilityMap& map, const TrueWorld& world, const RehearsalOptions& options)
      : map_(map),
        world_(world),
        options_(options),
        observer_(map.model()),
        random_(options.seed),
        here_(options.start) {}

  Rehearsal run() {
    result_.track.push_back(here_);
    while (!options_.watch.stopped()) {
      if (!plan()) return ended(Outcome::GaveUp);
      const Leg leg = follow();
      if (leg == Leg::Arrived) return ended(Outcome::Reached);
      if (leg == Leg::Stuck) return ended(Outcome::Immobilised);
      if (leg == Leg::Tipped) return ended(Outcome::Tipped);
      if (++result_.replans > options_.max_replans) return ended(Outcome::GaveUp);
    }
    return ended(Outcome::GaveUp);
  }

 private:
  enum class Leg { Arrived, Stuck, Tipped, Replan };

  Rehearsal ended(Outcome outcome) {
    result_.outcome = outcome;
    return std::move(result_);
  }

  bool plan() {
    Problem problem;
    problem.map = map_.published();
    problem.start = here_;
    problem.goal = options_.goal;
    problem.goal_tolerance_m = options_.goal_tolerance_m;
    const Plan plan = planner_.plan(problem);
    route_ = plan.points;
    next_ = 1;
    planned_J_ = plan.cost_J;
    return plan.status == RouteStatus::Found;
  }

  Leg follow() {
    while (next_ < route_.size()) {
      const double left = distance_m(here_, route_[next_]);
      const double length = std::min(left, options_.step_m);
      if (length < 1e-9) {
        ++next_;
        continue;
      }
      const Direction heading{(route_[next_].x_m - here_.x_m) / left, (route_[next_].y_m - here_.y_m) / left};
      const TrueWorld::Step step = world_.drive(here_, heading, gradient(heading));
      if (tipped(heading)) return Leg::Tipped;
      result_.max_slip = std::max(result_.max_slip, step.slip);
      const double expected = expectedSlip(heading);
      learn(step, heading);
      if (step.stuck || (options_.senses && step.slip > expected + options_.alarm_slip))
        return retreat(step, heading);
      advance(step, heading, length);
      if (options_.senses && routeTurnedDear()) return Leg::Replan;
    }
    return Leg::Arrived;
  }

  double gradient(const Direction& heading) const {
    const auto cell = map_.grid().cellAt(here_);
    if (!cell) return 0.0;
    const costmap::CellCode code = map_.code(*cell);
    return code.dzDx() * heading.x + code.dzDy() * heading.y;
  }

  // What the map says before this step's readings are in.
  double expectedSlip(const Direction& heading) const {
    const auto cell = map_.grid().cellAt(here_);
    if (!cell) return 0.0;
    const auto grid = map_.published();
    return static_cast<double>(grid->cost().detail(grid->at(*cell), heading).slip);
  }

  bool tipped(const Direction& heading) const {
    const auto& rover = map_.model().rover();
    return std::abs(std::atan(gradient(heading))) > 1.5 * rover.max_pitch_rad ||
           std::abs(std::atan(gradient({-heading.y, heading.x}))) > 1.5 * rover.max_roll_rad;
  }

  void advance(const TrueWorld::Step& step, const Direction& heading, double length_m) {
    const double surface_m = length_m * std::hypot(1.0, gradient(heading));
    result_.energy_J += step.energy_J_per_m * surface_m;
    result_.time_s += surface_m / step.speed_mps;
    result_.length_m += length_m;
    here_ = {here_.x_m + length_m * heading.x, here_.y_m + length_m * heading.y};
    result_.track.push_back(here_);
    if (distance_m(here_, route_[next_]) < 1e-9) ++next_;
  }

  // Backs out along the track it came on, which it knows; wheels that dig unwatched do not get that far.
  Leg retreat(const TrueWorld::Step& stopped, const Direction& heading) {
    if (!options_.senses && stopped.stuck) return Leg::Stuck;
    result_.energy_J += stopped.energy_J_per_m * 0.1;
    for (double backed = 0.0; backed < 1.5 && result_.track.size() > 1; backed += options_.step_m) {
      const TrueWorld::Step step = world_.drive(here_, {-heading.x, -heading.y}, -gradient(heading));
      if (step.stuck) return Leg::Stuck;
      result_.energy_J += step.energy_J_per_m * options_.step_m;
      result_.length_m += options_.step_m;
      result_.track.pop_back();
      here_ = result_.track.back();
    }
    return Leg::Replan;
  }

  void learn(const TrueWorld::Step& step, const Direction& heading) {
    if (!options_.senses) return;
    const auto& rover = map_.model().rover();
    std::normal_distribution<double> noise;
    for (std::size_t i = 0; i < step.wheels.size(); ++i) {
      const auto cell = map_.grid().cellAt(step.wheels[i]);
      if (!cell || map_.classIndex(*cell) < 0) continue;
      const double load_N = terramech::wheelLoad_N(rover);
      const WheelTable::Row& row = step.rows[i];
      const costmap::WheelReading reading{
          .time_s = result_.time_s,
          .place = step.wheels[i],
          .load_N = load_N,
          .slip = std::clamp(step.slip + kSlipNoise * noise(random_), -1.0, 1.0),
          .torque_Nm = row.torque * load_N * rover.wheel.radius_m * (1.0 + kTorqueNoise * noise(random_)),
          .sinkage_m = row.sinkage * rover.wheel.radius_m * (1.0 + kSinkageNoise * noise(random_)),
          .gradient = step.stuck ? std::nan("") : gradient(heading),
          .drawbar_pull_N = std::nan(""),
          .pass = 1};
      if (const auto seen = observer_.observe(map_.classIndex(*cell), reading)) map_.learn(*seen);
    }
    map_.publish();
  }

  bool routeTurnedDear() {
    const MotionCost cost(map_.published());
    double left_J = cost({here_, route_[std::min(next_, route_.size() - 1)]});
    for (std::size_t i = next_; i + 1 < route_.size(); ++i) left_J += cost({route_[i], route_[i + 1]});
    const bool dear = !(left_J <= kDearer * planned_J_);
    planned_J_ = std::min(planned_J_, left_J);
    return dear;
  }

  costmap::TraversabilityMap& map_;
  const TrueWorld& world_;
  const RehearsalOptions& options_;
  costmap::WheelObserver observer_;
  std::mt19937_64 random_;
  FieldPlanner planner_;
  maps::Point here_;
  std::vector<maps::Point> route_;
  std::size_t next_ = 1;
  double planned_J_ = 0.0;
  Rehearsal result_;
};

}  // namespace

std::string_view name(Outcome outcome) noexcept {
  constexpr std::string_view kNames[] = {"reached", "immobilised", "tipped", "gave_up"};
  return kNames[static_cast<int>(outcome)];
}

Rehearsal rehearse(costmap::TraversabilityMap& map, const TrueWorld& world, const RehearsalOptions& options) {
  return Drive(map, world, options).run();
}

}  // namespace talus::planner
