#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <talus/planner/check/chassis_planner.hpp>

namespace talus::planner {
namespace {

using maps::Cell;

constexpr std::size_t kMostClosed = 2000;  // largest number of cells closed around one violation

std::vector<Violation> along(const Chassis& chassis, const Plan& plan) {
  return plan.drive.legs.empty() ? chassis.violations(plan.points) : chassis.violations(plan.drive);
}

// Returns the heading of the route at the place.
double headingAt(const Plan& plan, maps::Point place) {
  double nearest_m = INFINITY, heading = 0.0;
  for (std::size_t i = 1; i < plan.points.size(); ++i) {
    const maps::Point a = plan.points[i - 1], b = plan.points[i];
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, square = dx * dx + dy * dy;
    if (square == 0.0) continue;
    const double t = std::clamp(((place.x_m - a.x_m) * dx + (place.y_m - a.y_m) * dy) / square, 0.0, 1.0);
    const double off_m = std::hypot(a.x_m + t * dx - place.x_m, a.y_m + t * dy - place.y_m);
    if (off_m >= nearest_m) continue;
    nearest_m = off_m;
    heading = std::atan2(dy, dx);
  }
  return heading;
}

using Cells = std::set<std::pair<int, int>>;  // row, column

// Closes the cell and all cells connected to it at whose centre the chassis refuses the heading.
void close(const maps::Grid& grid, const Chassis& chassis, const Pose& at, Cells& closed) {
  const auto first = grid.cellAt(at.place);
  if (!first || !closed.insert({first->row, first->column}).second) return;
  std::vector<Cell> open{*first};
  for (std::size_t n = 0; n < open.size() && n < kMostClosed; ++n)
    for (const auto& [columns, rows] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const Cell next{open[n].column + columns, open[n].row + rows};
      if (!grid.contains(next) || closed.contains({next.row, next.column})) continue;
      if (chassis.refusal({grid.centre(next), at.heading_rad}).empty()) continue;
      closed.insert({next.row, next.column});
      open.push_back(next);
    }
}

std::shared_ptr<const costmap::CostGrid> without(const costmap::CostGrid& map, const Cells& closed) {
  costmap::Revision revision;
  for (const auto& [row, column] : closed) revision.ranges.push_back({{column, row}, {column, row}});
  revision.code = [](Cell, costmap::CellCode code) { return code.withCurve(costmap::CellCode::kBlocked); };
  revision.cost = [cost = map.content().cost] { return cost; };
  return std::make_shared<const costmap::CostGrid>(costmap::revised(map, revision));
}

Plan refused(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

}  // namespace

Plan planOnChassis(const Problem& problem, const Chassis& chassis,
                   const std::function<Plan(const Problem&)>& planner, int most_rounds) {
  Problem open = problem;
  const auto start = problem.map->grid().cellAt(problem.start);
  std::string reason;
  double proof_s = 0.0;
  for (int round = 0; round < most_rounds; ++round) {
    Plan plan = planner(open);
    plan.proof_s = proof_s += plan.proof_s;
    if (plan.status != RouteStatus::Found) {
      if (round > 0 && plan.status != RouteStatus::Cancelled && plan.status != RouteStatus::TimedOut)
        return refused(RouteStatus::NoneFound, "no detour found where: " + reason + "; " + plan.reason);
      return plan;
    }
    const auto violations = along(chassis, plan);
    if (violations.empty()) return plan;
    if (problem.watch.stopped())
      return refused(RouteStatus::Cancelled,
                     "planning was cancelled before a route for the chassis was found");
    Cells closed;
    for (const Violation& violation : violations) {
      reason = violation.reason;
      if (problem.map->grid().cellAt(violation.place) == start)
        return refused(RouteStatus::StartInvalid,
                       "at the start " + reason + "; choose another place or heading");
      close(open.map->grid(), chassis, {violation.place, headingAt(plan, violation.place)}, closed);
    }
    if (start) closed.erase({start->row, start->column});
    open.map = without(*open.map, closed);
  }
  return refused(RouteStatus::NoneFound, "no feasible route found around places where: " + reason);
}

}  // namespace talus::planner
