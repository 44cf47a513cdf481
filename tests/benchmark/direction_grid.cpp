// A planner plugin for comparisons: Dijkstra over the cell centres with edges in 80 directions, each with
// the exact cost of its motion. Simple and slow; it shares no search code with the planners under
// comparison.
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/planner/plugin/plugin_export.hpp>
#include <talus/planner/route/polyline.hpp>

namespace direction_grid {

using talus::maps::Cell;
using talus::maps::Point;

// Steps of up to this many columns and rows without a common divisor: 80 directions.
constexpr int kReach = 5;

std::vector<Cell> steps() {
  std::vector<Cell> all;
  for (int row = -kReach; row <= kReach; ++row)
    for (int column = -kReach; column <= kReach; ++column)
      if (std::gcd(column, row) == 1) all.push_back({column, row});
  return all;
}

class Search {
 public:
  Search(const talus::planner::MotionCost& cost, Point goal)
      : cost_(cost),
        grid_(cost.map().grid()),
        goal_(goal),
        spent_(grid_.size(), std::numeric_limits<double>::infinity()),
        parent_(grid_.size(), kNone) {}

  std::vector<Point> from(Point start) {
    double best = cost_({start, goal_});
    std::size_t last = kNone;
    for (const Cell cell : near(start)) open(grid_.index(cell), kNone, cost_({start, grid_.centre(cell)}));
    const std::vector<Cell> all = steps();
    std::vector<double> rest(grid_.size(), -1.0);  // from centres near the goal to the goal
    for (const Cell cell : near(goal_)) rest[grid_.index(cell)] = cost_({grid_.centre(cell), goal_});
    while (!queue_.empty() && -queue_.top().first < best) {
      const auto [spent, index] = queue_.top();
      queue_.pop();
      if (-spent > spent_[index]) continue;
      if (rest[index] >= 0.0 && rest[index] - spent < best) {
        best = rest[index] - spent;
        last = index;
      }
      const Cell here = cellOf(index);
      for (const Cell& step : all) {
        const Cell next{here.column + step.column, here.row + step.row};
        if (!grid_.contains(next)) continue;
        open(grid_.index(next), index, cost_({grid_.centre(here), grid_.centre(next)}) - spent);
      }
    }
    if (std::isinf(best)) return {};
    std::vector<Point> way{goal_};
    for (; last != kNone; last = parent_[last]) way.push_back(grid_.centre(cellOf(last)));
    way.push_back(start);
    return {way.rbegin(), way.rend()};
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  Cell cellOf(std::size_t index) const {
    const auto width = static_cast<std::size_t>(grid_.width);
    return {static_cast<int>(index % width), static_cast<int>(index / width)};
  }
  std::vector<Cell> near(Point place) const {
    const auto at = [this](double metres) {
      return static_cast<int>(std::floor(metres / grid_.resolution_m));
    };
    const Cell middle{at(place.x_m - grid_.south_west.x_m), at(place.y_m - grid_.south_west.y_m)};
    std::vector<Cell> cells;
    for (int row = middle.row - kReach; row <= middle.row + kReach; ++row)
      for (int column = middle.column - kReach; column <= middle.column + kReach; ++column)
        if (grid_.contains({column, row})) cells.push_back({column, row});
    return cells;
  }
  void open(std::size_t index, std::size_t parent, double spent) {
    if (!(spent < spent_[index])) return;
    spent_[index] = spent;
    parent_[index] = parent;
    queue_.emplace(-spent, index);
  }

  const talus::planner::MotionCost& cost_;
  const talus::maps::Grid& grid_;
  Point goal_;
  std::vector<double> spent_;
  std::vector<std::size_t> parent_;
  std::priority_queue<std::pair<double, std::size_t>> queue_;
};

class Planner final : public talus::GlobalPlanner {
 public:
  talus::PlannerCapabilities capabilities() const override {
    return {.name = "direction_grid",
            .version = "1",
            .planners = {"grid80"},
            .planner = "grid80",
            .heading_dependent = true,
            .deterministic = true};
  }
  void configure(const talus::PlannerSettings&) override {}
  void set_map(std::shared_ptr<const talus::costmap::CostGrid> map) override { map_ = std::move(map); }
  void update(std::shared_ptr<const talus::costmap::CostGrid> newer) override { set_map(std::move(newer)); }
  talus::planner::Route plan(const talus::PlanRequest& request) override {
    if (!map_) throw std::logic_error("direction_grid: plan() before set_map()");
    const talus::planner::MotionCost cost(map_);
    talus::planner::Route route;
    for (const Point at : Search(cost, request.goal).from(request.start)) {
      route.vertices.emplace_back();
      route.vertices.back().x_m = at.x_m;
      route.vertices.back().y_m = at.y_m;
    }
    if (route.vertices.empty())
      route.reason = "no route in 80 directions; choose another goal";
    else
      route.status = talus::planner::RouteStatus::Found;
    return route;
  }
  std::unique_ptr<talus::GlobalPlanner> create() const override { return std::make_unique<Planner>(); }

 private:
  std::shared_ptr<const talus::costmap::CostGrid> map_;
};

}  // namespace direction_grid

TALUS_EXPORT_PLANNER(direction_grid::Planner)
