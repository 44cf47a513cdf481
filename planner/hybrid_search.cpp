#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <vector>

#include <planner/hybrid_search.hpp>
#include <planner/pose_shortcut.hpp>
#include <planner/pose_table.hpp>

namespace talus::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Node {
  Pose pose;
  PosePath::Leg leg;  // that led here
  std::uint32_t parent = PoseTable::kNone;
  int direction = 0;  // of travel: +1 forward, -1 reverse, 0 not moved yet
  double cost = kInfinity;
  bool closed = false;
};

struct Queued {
  double estimate;
  std::uint32_t node;
  bool operator<(const Queued& other) const noexcept {
    return estimate != other.estimate ? estimate > other.estimate : node > other.node;
  }
};

// Motions tried from every pose.
std::vector<PosePath::Leg> motions(const Kinematics& kinematics, const HybridOptions& options,
                                   double resolution_m) {
  const double step = options.step_cells * resolution_m, bin = 2.0 * M_PI / options.headings;
  std::vector<PosePath::Leg> legs{{{step, 0.0}, 0.0}};
  if (kinematics.turning_radius_m > 0.0) {
    for (const double curvature :
         {1.0 / kinematics.turning_radius_m, 1.0 / (3.0 * kinematics.turning_radius_m)}) {
      const double bins = std::clamp(std::round(step * curvature / bin), 1.0, options.headings / 4.0);
      for (const double side : {1.0, -1.0}) legs.push_back({{bins * bin / curvature, side * curvature}, 0.0});
    }
  }
  if (kinematics.may_reverse)
    for (std::size_t k = 0, count = legs.size(); k < count; ++k) {
      legs.push_back(legs[k]);
      legs.back().arc.length_m *= -1.0;
    }
  if (kinematics.turning_radius_m <= 0.0)
    for (const int bins : {1, 3, 9})
      for (const double side : {1.0, -1.0}) legs.push_back({{}, side * bins * bin});
  return legs;
}

// One search; HybridSearch keeps what outlives it.
class Search {
 public:
  Search(const PoseProblem& problem, const HybridOptions& options, CostToGo& field)
      : problem_(problem),
        options_(options),
        field_(field),
        motion_cost_(problem.map),
        cost_(motion_cost_, problem.kinematics),
        motions_(motions(problem.kinematics, options, problem.map->grid().resolution_m)) {}

  RouteStatus run() {
    begin();
    while (!open_.empty()) {
      const Queued next = open_.top();
      if (next.estimate >= best_cost_) return RouteStatus::Found;
      open_.pop();
      if (nodes_[next.node].closed) continue;
      if (problem_.watch.stopped()) return RouteStatus::Cancelled;
      if (++expanded_ > options_.most_expanded)
        return best_cost_ < kInfinity ? RouteStatus::Found : RouteStatus::TimedOut;
      expand(next.node);
    }
    return best_cost_ < kInfinity ? RouteStatus::Found : RouteStatus::NoRoute;
  }

  PosePath path() const {
    PosePath path{.start = {}, .legs = {best_finish_.rbegin(), best_finish_.rend()}};
    std::uint32_t at = best_node_;
    for (; nodes_[at].parent != PoseTable::kNone; at = nodes_[at].parent) path.legs.push_back(nodes_[at].leg);
    std::reverse(path.legs.begin(), path.legs.end());
    path.start = nodes_[at].pose;
    return path;
  }

  std::uint64_t expanded() const noexcept { return expanded_; }
  const PoseCost& cost() const noexcept { return cost_; }

 private:
  void begin() {
    const int ways = problem_.start_heading_rad ? 1 : options_.headings;
    for (int k = 0; k < ways; ++k) {
      const double heading = problem_.start_heading_rad.value_or(2.0 * M_PI * k / options_.headings);
      offer({.pose = {problem_.start, heading}, .leg = {}, .cost = 0.0});
    }
  }

  void expand(std::uint32_t index) {
    nodes_[index].closed = true;
    if (due(nodes_[index])) finish(index);
    for (const auto& leg : motions_) {
      const Node from = nodes_[index];
      const Pose to = after(from.pose, leg);
      if (!problem_.map->grid().cellAt(to.place)) continue;
      const double cost = from.cost + cost_(from.pose, leg) + cusp(from, leg.arc);
      if (cost < best_cost_)
        offer({.pose = to, .leg = leg, .parent = index, .direction = direction(from, leg.arc), .cost = cost});
    }
  }

  // Keeps the node when it is the best at its cell and heading.
  void offer(const Node& node) {
    const auto cell = problem_.map->grid().cellAt(node.pose.place);
    const double rest = toGo(*cell);
    if (node.cost + rest >= best_cost_) return;
    std::uint32_t& at = table_[key(*cell, node.pose.heading_rad, node.direction)];
    if (at != PoseTable::kNone && nodes_[at].cost <= node.cost) return;
    at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    open_.push({node.cost + rest, at});
  }

  double toGo(maps::Cell cell) {
    field_.settle(cell, stop_);
    return field_.cost_J(cell).value_or(kInfinity);
  }

  std::uint64_t key(maps::Cell cell, double heading, int direction) const noexcept {
    const double turns = heading / (2.0 * M_PI);
    const auto bin = static_cast<std::uint64_t>((turns - std::floor(turns)) * options_.headings + 0.5) %
                     static_cast<std::uint64_t>(options_.headings);
    const std::uint64_t way = problem_.kinematics.cusp_cost_J > 0.0 && direction < 0 ? 1 : 0;
    return (problem_.map->grid().index(cell) * static_cast<std::uint64_t>(options_.headings) + bin) * 2 + way;
  }

  static int direction(const Node& from, const Arc& arc) noexcept {
    return arc.length_m == 0.0 ? from.direction : arc.length_m > 0.0 ? 1 : -1;
  }

  double cusp(const Node& from, const Arc& arc) const noexcept {
    return from.direction * direction(from, arc) < 0 ? problem_.kinematics.cusp_cost_J : 0.0;
  }

  // A direct curve is tried more often the nearer the goal is.
  bool due(const Node& node) {
    const double cells =
        std::hypot(node.pose.place.x_m - problem_.goal.x_m, node.pose.place.y_m - problem_.goal.y_m) /
        problem_.map->grid().resolution_m;
    const auto every = static_cast<std::uint64_t>(std::clamp(cells / 4.0, 1.0, 64.0));
    return expanded_ % every == 0 || node.parent == PoseTable::kNone;
  }

  void finish(std::uint32_t index) {
    const Node& node = nodes_[index];
    const double facing =
        std::atan2(problem_.goal.y_m - node.pose.place.y_m, problem_.goal.x_m - node.pose.place.x_m);
    const Pose goal{problem_.goal, problem_.goal_heading_rad.value_or(facing)};
    PosePath rest{.start = node.pose, .legs = connection(node.pose, goal, problem_.kinematics)};
    const double cost =
        node.cost + cost_(rest) + (rest.legs.empty() ? 0.0 : cusp(node, rest.legs.front().arc));
    if (cost >= best_cost_) return;
    best_cost_ = cost;
    best_node_ = index;
    best_finish_ = std::move(rest.legs);
  }

  const PoseProblem& problem_;
  const HybridOptions& options_;
  StopCheck stop_{problem_.watch};
  CostToGo& field_;
  MotionCost motion_cost_;
  PoseCost cost_;
  std::vector<PosePath::Leg> motions_;
  std::vector<Node> nodes_;
  PoseTable table_;
  std::priority_queue<Queued> open_;
  std::uint64_t expanded_ = 0;
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

std::string whyNot(RouteStatus status) {
  switch (status) {
    case RouteStatus::Cancelled:
      return "cancelled";
    case RouteStatus::TimedOut:
      return "gave up after the most poses it may try; a smaller map or more headings may help";
    default:
      return "no drive joins start and goal within the turning radius; try another heading, or a tighter "
             "radius";
  }
}

}  // namespace

HybridSearch::HybridSearch(const HybridOptions& options) : options_(options) {
  if (options.headings < 8)
    throw std::invalid_argument("hybrid search: headings = " + std::to_string(options.headings) +
                                ", must be >= 8");
}

bool HybridSearch::prepareField(const PoseProblem& problem) {
  const maps::Cell goal = *problem.map->grid().cellAt(problem.goal);
  const bool same_map = edges_ && edges_->mapPointer() == problem.map;
  if (!same_map)
    edges_ = std::make_shared<const EdgeLayer>(
        problem.map, EdgeUnits(problem.map->cost(), problem.map->grid().resolution_m), 1, problem.watch);
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
  if (!prepareField(problem)) return refused(RouteStatus::Cancelled, "cancelled");
  Search search(problem, options_, *field_);
  PosePlan plan;
  plan.status = search.run();
  plan.expanded = search.expanded();
  if (plan.status != RouteStatus::Found) {
    plan.reason = whyNot(plan.status);
    return plan;
  }
  plan.path = shortened(search.path(), search.cost());
  plan.cost_J = search.cost()(plan.path);
  return plan;
}

}  // namespace talus::planner
