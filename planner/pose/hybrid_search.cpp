#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <stdexcept>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/pose/hybrid_search.hpp>
#include <talus/planner/pose/pose_shortcut.hpp>

namespace talus::planner {
namespace {

constexpr double kStretch_cells = 0.5;  // longest stretch priced by a single cell

constexpr double kJoint_cells = 4.0;  // spacing of the joints for shortening
constexpr double kBetter = 0.998;     // relative cost below which a better drive extends the search
constexpr float kClosed = -std::numeric_limits<float>::infinity();
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint32_t kNone = 0xffffffff;

struct Node {
  maps::Point place;
  float cost = 0.0F;
  const MotionSet::Motion* motion = nullptr;  // motion that led to the node; null at the start
  std::uint32_t parent = kNone;
  std::int16_t heading = 0;   // index of the heading
  std::int8_t direction = 0;  // direction of travel: +1 forward, -1 reverse, 0 not moved yet
};

struct Queued {
  double estimate;
  std::uint32_t node;
  bool operator<(const Queued& other) const noexcept {
    return estimate != other.estimate ? estimate > other.estimate : node > other.node;
  }
};

// A single search; HybridSearch keeps the data reused by later searches.
class HybridAStar {
 public:
  HybridAStar(const PoseProblem& problem, const HybridOptions& options, CostToGo& field,
              const StopCheck& stop)
      : problem_(problem),
        options_(options),
        stop_(stop),
        field_(field),
        motion_cost_(problem.map),
        cost_(motion_cost_, problem.kinematics),
        cheapest_J_per_m_(cheapestMetre_J(*problem.map)),
        motions_(*problem.map, problem.kinematics,
                 {.headings = options.headings,
                  .step_cells = options.step_cells,
                  .offset_rad = problem.start_heading_rad.value_or(0.0)}) {}

  RouteStatus run() {
    begin();
    while (!open_.empty()) {
      const Queued next = open_.top();
      if (next.estimate >= best_cost_ || expanded_ >= last_) return RouteStatus::Found;
      if (last_ == kNever && best_cost_ <= options_.suboptimality_bound * next.estimate)
        last_ = expanded_ + options_.improve;
      open_.pop();
      if (best(nodes_[next.node]) != nodes_[next.node].cost) continue;  // replaced by a cheaper node
      if ((++expanded_ & 63) == 0 && stop_()) {
        if (stop_.cancelled()) return RouteStatus::Cancelled;
        return best_cost_ < kInfinity ? RouteStatus::Found : RouteStatus::TimedOut;
      }
      if (expanded_ * motions_.work() > std::min(options_.most_expanded, problem_.most_expanded))
        return best_cost_ < kInfinity ? RouteStatus::Found : RouteStatus::TimedOut;
      expand(next.node);
    }
    return best_cost_ < kInfinity ? RouteStatus::Found : RouteStatus::NoneFound;
  }

  PosePath path() const {
    std::uint32_t root = best_node_;
    while (nodes_[root].motion) root = nodes_[root].parent;
    PosePath path = pathFrom(root, best_node_);
    path.legs.insert(path.legs.end(), best_finish_.begin(), best_finish_.end());
    return path;
  }

  bool checked(const PosePath& path) const { return mayBeDriven(*problem_.map, path, problem_.kinematics); }

  std::uint64_t expanded() const noexcept { return expanded_; }
  const PoseCost& cost() const noexcept { return cost_; }
  double cheapest_J_per_m() const noexcept { return cheapest_J_per_m_; }

 private:
  // Path from a node to one of its descendants.
  PosePath pathFrom(std::uint32_t first, std::uint32_t last) const {
    PosePath path{.start = poseOf(nodes_[first]), .legs = {}};
    for (; last != first; last = nodes_[last].parent) path.legs.push_back(nodes_[last].motion->leg);
    std::reverse(path.legs.begin(), path.legs.end());
    return path;
  }

  Pose poseOf(const Node& node) const noexcept { return {node.place, motions_.heading_rad(node.heading)}; }

  void begin() {
    const int ways = problem_.start_heading_rad ? 1 : options_.headings;
    for (int k = 0; k < ways; ++k) offer({.place = problem_.start, .heading = static_cast<std::int16_t>(k)});
  }

  // The node's motion was priced approximately. At expansion its exact cost along chords and the check follow, in
  // which its arc passes all headings between those of the chords.
  bool stands(std::uint32_t index) const {
    const Node& node = nodes_[index];
    return !node.motion || (cost_(poseOf(nodes_[node.parent]), node.motion->leg) < kInfinity &&
                            checked(pathFrom(before(node.parent), index)));
  }

  std::uint32_t before(std::uint32_t index) const {
    return nodes_[index].motion ? nodes_[index].parent : index;
  }

  void expand(std::uint32_t index) {
    if (!stands(index)) {
      best(nodes_[index]) = std::numeric_limits<float>::infinity();
      return;
    }
    best(nodes_[index]) = kClosed;
    if (due(nodes_[index])) finish(index);
    const Node from = nodes_[index];
    for (const auto& motion : motions_.from(from.heading)) {
      const double cost = static_cast<double>(from.cost) + motions_.quickCost(motion, from.place) +
                          (from.direction * motion.direction < 0 ? cost_.cusp_J() : 0.0);
      if (cost >= best_cost_) continue;
      const int way = motion.direction == 0 ? from.direction : motion.direction;
      offer({.place = {from.place.x_m + motion.dx_m, from.place.y_m + motion.dy_m},
             .cost = static_cast<float>(cost),
             .motion = &motion,
             .parent = index,
             .heading = static_cast<std::int16_t>(motion.heading),
             .direction = static_cast<std::int8_t>(way)});
    }
  }

  // Keeps the node if it is the cheapest at its cell and heading.
  void offer(const Node& node) {
    const auto cell = problem_.map->grid().cellAt(node.place);
    if (!cell) return;
    const double rest = toGo(*cell);
    const auto cost = static_cast<double>(node.cost);
    if (cost + rest >= best_cost_) return;
    float& least = best(node);
    if (least <= node.cost) return;
    least = node.cost;
    open_.push({cost + options_.heuristic_weight * rest, static_cast<std::uint32_t>(nodes_.size())});
    nodes_.push_back(node);
  }

  double toGo(maps::Cell cell) {
    field_.settle(cell, stop_);
    return field_.cost_J(cell).value_or(kInfinity);
  }

  // Lowest cost at the node's cell and heading; separately by direction of travel if a cusp has a cost.
  float& best(const Node& node) {
    const maps::Grid& grid = problem_.map->grid();
    const bool apart = cost_.cusp_J() > 0.0 && node.direction < 0;
    return table_.at(grid.index(*grid.cellAt(node.place)),
                     static_cast<std::size_t>(node.heading + (apart ? options_.headings : 0)));
  }

  // A direct curve to the goal is tried more often near the goal.
  bool due(const Node& node) const {
    const double cells = std::hypot(node.place.x_m - problem_.goal.x_m, node.place.y_m - problem_.goal.y_m) /
                         problem_.map->grid().resolution_m;
    const auto every = static_cast<std::uint64_t>(std::clamp(cells / 4.0, 1.0, 64.0));
    return expanded_ % every == 0 || !node.motion;
  }

  void finish(std::uint32_t index) {
    const maps::Point place = nodes_[index].place, goal = problem_.goal;
    if (problem_.goal_heading_rad) return finish(index, *problem_.goal_heading_rad);
    const double facing = std::atan2(goal.y_m - place.y_m, goal.x_m - place.x_m);
    finish(index, facing);
    if (problem_.kinematics.may_reverse) finish(index, facing + std::numbers::pi);
  }

  void finish(std::uint32_t index, double goal_heading_rad) {
    const Node& node = nodes_[index];
    PosePath rest{.start = poseOf(node), .legs = {}};
    rest.legs = cost_.direct(rest.start, {problem_.goal, goal_heading_rad});
    const bool turns = !rest.legs.empty() && node.direction * direction(rest.legs.front()) < 0;
    const double so_far = static_cast<double>(node.cost) + (turns ? cost_.cusp_J() : 0.0);
    if (so_far + cheapest_J_per_m_ * length_m(rest) >= best_cost_) return;
    const double cost = so_far + cost_(rest);
    if (cost >= best_cost_) return;
    PosePath last = pathFrom(before(index), index);
    last.legs.insert(last.legs.end(), rest.legs.begin(), rest.legs.end());
    if (!checked(last)) return;
    if (last_ != kNever && cost < kBetter * best_cost_) last_ = expanded_ + options_.improve;
    best_cost_ = cost;
    best_node_ = index;
    best_finish_ = std::move(rest.legs);
  }

  const PoseProblem& problem_;
  const HybridOptions& options_;
  const StopCheck& stop_;
  CostToGo& field_;
  MotionCost motion_cost_;
  PoseCost cost_;
  double cheapest_J_per_m_;
  MotionSet motions_;
  std::vector<Node> nodes_;
  PoseTable table_{problem_.map->grid().size(), static_cast<std::size_t>(2 * options_.headings)};
  std::priority_queue<Queued> open_;
  std::uint64_t expanded_ = 0;
  std::uint64_t last_ = kNever;
  double best_cost_ = kInfinity;
  std::uint32_t best_node_ = 0;
  std::vector<PosePath::Leg> best_finish_;
};

PosePlan refused(RouteStatus status, const char* reason) {
  PosePlan plan;
  plan.status = status;
  plan.reason = reason;
  return plan;
}

// If no motion of the given length passes from the given headings, shorter motions from more headings may.
HybridOptions finerThan(HybridOptions options) {
  constexpr std::uint64_t kMostFine = 200'000;
  options.headings *= 2;
  options.step_cells = std::max(1.0, options.step_cells / 1.5);
  options.most_expanded = std::min(options.most_expanded, kMostFine);
  return options;
}

std::string whyNot(RouteStatus status) {
  switch (status) {
    case RouteStatus::Cancelled:
      return "cancelled";
    case RouteStatus::TimedOut:
      return "no feasible route found within the time limit; increase it";
    default:
      return "no feasible route found from start to goal with this turning radius; try another heading or a "
             "smaller radius";
  }
}

}  // namespace

MotionSet::MotionSet(const costmap::CostGrid& map, const Kinematics& kinematics, const Options& options)
    : map_(map),
      kinematics_(kinematics),
      options_(options),
      bin_rad_(2.0 * std::numbers::pi / options.headings),
      inverse_resolution_(1.0 / map.grid().resolution_m),
      motions_(static_cast<std::size_t>(options.headings)) {
  const auto all = legs();
  for (int k = 0; k < options.headings; ++k)
    for (const PosePath::Leg& leg : all) {
      const double turn = leg.turn_rad + leg.arc.length_m * leg.arc.curvature_1_m;
      const int turned = static_cast<int>(std::lround(turn / bin_rad_));
      const int heading = ((k + turned) % options.headings + options.headings) % options.headings;
      motions_[static_cast<std::size_t>(k)].push_back(made(leg, k, heading));
    }
}

// Legs from heading number 0; every change of heading is an integer number of bins.
std::vector<PosePath::Leg> MotionSet::legs() const {
  const double step_m = options_.step_cells * map_.grid().resolution_m;
  const double radius_m = kinematics_.turning_radius_m;
  std::vector<PosePath::Leg> legs{{{step_m, 0.0}, 0.0}};
  if (radius_m > 0.0)
    for (const double curvature : {1.0 / radius_m, 1.0 / (3.0 * radius_m)}) {
      const double bins = std::clamp(std::round(step_m * curvature / bin_rad_), 1.0, options_.headings / 4.0);
      for (const double side : {1.0, -1.0})
        legs.push_back({{bins * bin_rad_ / curvature, side * curvature}, 0.0});
    }
  if (kinematics_.may_reverse)
    for (std::size_t k = 0, count = legs.size(); k < count; ++k) {
      legs.push_back(legs[k]);
      legs.back().arc.length_m *= -1.0;
    }
  if (radius_m <= 0.0)
    for (const int bins : {1, 3, 9})
      for (const double side : {1.0, -1.0}) legs.push_back({{}, side * bins * bin_rad_});
  return legs;
}

MotionSet::Motion MotionSet::made(const PosePath::Leg& leg, int heading, int turned) const {
  const Pose from{{0.0, 0.0}, heading_rad(heading)};
  const Pose end = after(from, leg);
  Motion motion{.leg = leg,
                .dx_m = end.place.x_m,
                .dy_m = end.place.y_m,
                .heading = turned,
                .direction = direction(leg),
                .turn_rad = std::abs(leg.turn_rad) + std::abs(leg.arc.length_m * leg.arc.curvature_1_m)};
  const int count =
      static_cast<int>(std::ceil(std::abs(leg.arc.length_m) * inverse_resolution_ / kStretch_cells - 1e-9));
  for (int k = 0; k < count; ++k) {
    const Pose middle = after(from, Arc{leg.arc.length_m * (k + 0.5) / count, leg.arc.curvature_1_m});
    const costmap::Direction way{motion.direction * std::cos(middle.heading_rad),
                                 motion.direction * std::sin(middle.heading_rad)};
    motion.stretches.push_back({.dx_m = middle.place.x_m,
                                .dy_m = middle.place.y_m,
                                .length_m = std::abs(leg.arc.length_m) / count,
                                .cost = HeadingCost(map_.cost(), way)});
  }
  return motion;
}

std::uint64_t MotionSet::work() const noexcept {
  constexpr std::uint64_t kUsual = 80;  // number of stretches for a radius of five cells
  std::uint64_t stretches = 0;
  for (const Motion& motion : from(0)) stretches += motion.stretches.size();
  return std::max<std::uint64_t>(1, stretches / kUsual);
}

double MotionSet::quickCost(const Motion& motion, maps::Point from) const noexcept {
  const maps::Grid& grid = map_.grid();
  const auto code = [&](double dx_m, double dy_m) {
    const double column = (from.x_m + dx_m - grid.south_west.x_m) * inverse_resolution_;
    const double row = (from.y_m + dy_m - grid.south_west.y_m) * inverse_resolution_;
    if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height))
      return costmap::CellCode({.curve = costmap::CellCode::kBlocked});
    return map_.at({static_cast<int>(column), static_cast<int>(row)});
  };
  double sum = 0.0;
  for (const Stretch& stretch : motion.stretches) {
    const float metre_J = stretch.cost(code(stretch.dx_m, stretch.dy_m));
    if (metre_J == std::numeric_limits<float>::infinity()) return kInfinity;
    sum += static_cast<double>(metre_J) * stretch.length_m;
  }
  if (motion.turn_rad == 0.0) return sum;
  const costmap::TravelCost& cost = map_.cost();
  const TurnEfforts& turns = kinematics_.turnsOn(code(0.0, 0.0).curve());
  if (motion.direction == 0)
    return sum + cost.cost_J(kinematics_.stop) + cost.cost_J(turns.in_place) * motion.turn_rad;
  return sum + cost.cost_J(turns.on_arc) * motion.turn_rad;
}

bool mayBeDriven(const costmap::CostGrid& map, const PosePath& path, const Kinematics& kinematics) {
  std::vector<maps::Point> points;
  for (const Pose& pose : chords(path, map)) points.push_back(pose.place);
  return violations(map, path, kinematics.turning_radius_m).empty() &&
         violationsOfChords(map, points).empty();
}

HybridSearch::HybridSearch(const HybridOptions& options) : options_(options) {
  if (options.headings < 8)
    throw std::invalid_argument("hybrid search: headings = " + std::to_string(options.headings) +
                                ", must be >= 8");
}

bool HybridSearch::prepareField(const PoseProblem& problem, const StopCheck& stop) {
  const maps::Cell goal = *problem.map->grid().cellAt(problem.goal);
  const bool same_map = edges_ && edges_->mapPointer() == problem.map;
  if (!same_map)
    edges_ = std::make_shared<const EdgeLayer>(
        problem.map, EdgeUnits(problem.map->cost(), problem.map->grid().resolution_m), 1, stop);
  if (!edges_->complete()) {
    edges_.reset();
    return false;
  }
  if (!same_map || !field_ || !(field_goal_ == goal))
    field_.emplace(edges_, std::vector<FieldGoal>{{.cell = goal}});
  field_goal_ = goal;
  return true;
}

PosePlan HybridSearch::plan(const PoseProblem& problem) {
  if (!problem.map) throw std::invalid_argument("hybrid search: no map");
  const MotionCost allowed(problem.map);
  if (!allowed.allowed(problem.start))
    return refused(RouteStatus::StartInvalid,
                   "the start is outside the map or on a cell that may not be entered");
  if (!allowed.allowed(problem.goal))
    return refused(RouteStatus::GoalInvalid,
                   "the goal is outside the map or on a cell that may not be entered");
  const StopCheck stop(problem.watch, problem.time_limit_s);
  if (!prepareField(problem, stop)) {
    const RouteStatus why = stop.cancelled() ? RouteStatus::Cancelled : RouteStatus::TimedOut;
    return refused(why, whyNot(why).c_str());
  }
  std::optional<HybridAStar> made(std::in_place, problem, options_, *field_, stop);
  PosePlan plan;
  plan.status = made->run();
  plan.expanded = made->expanded();
  const HybridOptions finer = finerThan(options_);
  if (plan.status == RouteStatus::NoneFound && plan.expanded > 1) {
    made.emplace(problem, finer, *field_, stop);
    const RouteStatus again = made->run();
    if (again == RouteStatus::Found || again == RouteStatus::Cancelled) plan.status = again;
    plan.expanded += made->expanded();
  }
  const HybridAStar& search = *made;
  if (plan.status != RouteStatus::Found) {
    if (plan.status == RouteStatus::TimedOut && !stop.timedOut()) {
      plan.status = RouteStatus::NoneFound;
      plan.reason = "none found within the allowed work of " + std::to_string(plan.expanded) +
                    " poses; try a part of the map, a smaller radius, or more via points";
      return plan;
    }
    plan.reason = whyNot(plan.status);
    return plan;
  }
  plan.path = search.path();
  PosePath shorter = shortened(plan.path, search.cost(),
                               {.joint_m = kJoint_cells * problem.map->grid().resolution_m,
                                .cheapest_J_per_m = search.cheapest_J_per_m(),
                                .stop = stop});
  if (problem.kinematics.turning_radius_m <= 0.0) {
    std::vector<maps::Point> places;
    for (const Pose& pose : sampled(plan.path, kJoint_cells * problem.map->grid().resolution_m))
      if (places.empty() || !(places.back() == pose.place)) places.push_back(pose.place);
    PosePath turning =
        turningPath(places, {problem.start_heading_rad, problem.goal_heading_rad}, search.cost());
    if (!turning.legs.empty() && search.cost()(turning) < search.cost()(shorter))
      shorter = std::move(turning);
  }
  if (search.checked(shorter)) plan.path = std::move(shorter);
  plan.cost_J = search.cost()(plan.path);
  return plan;
}

}  // namespace talus::planner
