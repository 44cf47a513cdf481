#include <algorithm>
#include <cmath>
#include <optional>

#include <costmap/drive_state.hpp>
#include <planner/route_check.hpp>

namespace talus::planner {
namespace {

using costmap::CostGrid;
using costmap::Direction;
using maps::Cell;
using maps::Point;

// Nearer to a corner or an edge than this share of a cell counts as on it.
constexpr double kOn = 1e-6;

class Checker {
 public:
  explicit Checker(const CostGrid& map) : map_(map), side_m_(map.grid().resolution_m) {}

  void segment(Point from, Point to) {
    const double length_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    if (!(length_m > kOn * side_m_)) return place(from);
    heading_ = {(to.x_m - from.x_m) / length_m, (to.y_m - from.y_m) / length_m};
    const std::vector<double> cuts = crossings(from, to);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if ((cuts[i] - cuts[i - 1]) * length_m > kOn * side_m_)
        stretch(along(from, to, (cuts[i] + cuts[i - 1]) / 2));
      const Point crossing = along(from, to, cuts[i]);
      if (i + 1 < cuts.size() && onCorner(crossing)) touch(crossing);
    }
  }

  // All cells that a point touches, in the present heading.
  void touch(Point p) {
    for (const double dx : {-2 * kOn, 2 * kOn})
      for (const double dy : {-2 * kOn, 2 * kOn}) {
        const auto cell = map_.grid().cellAt({p.x_m + dx * side_m_, p.y_m + dy * side_m_});
        if (cell) enter(*cell, p);
      }
  }

  void place(Point p) {
    const auto cell = map_.grid().cellAt(p);
    if (!cell) return report(std::nullopt, p, "outside the map");
    if (map_.at(*cell).curve() >= map_.cost().curves().size()) enter(*cell, p);
  }

  std::vector<Violation> found;

 private:
  static Point along(Point from, Point to, double t) noexcept {
    return {from.x_m + t * (to.x_m - from.x_m), from.y_m + t * (to.y_m - from.y_m)};
  }

  static double offLine(double coordinate) noexcept { return std::abs(coordinate - std::round(coordinate)); }

  bool onCorner(Point p) const noexcept {
    const auto& corner = map_.grid().south_west;
    return offLine((p.x_m - corner.x_m) / side_m_) < kOn && offLine((p.y_m - corner.y_m) / side_m_) < kOn;
  }

  // Shares of the segment at which it crosses a line between columns or rows, with both ends, sorted.
  std::vector<double> crossings(Point from, Point to) const {
    std::vector<double> cuts{0.0, 1.0};
    const auto add = [&cuts](double a, double b) {
      for (double line = std::ceil(std::min(a, b)); line <= std::max(a, b); line += 1.0)
        if (std::abs(b - a) > kOn) cuts.push_back(std::clamp((line - a) / (b - a), 0.0, 1.0));
    };
    const auto& corner = map_.grid().south_west;
    add((from.x_m - corner.x_m) / side_m_, (to.x_m - corner.x_m) / side_m_);
    add((from.y_m - corner.y_m) / side_m_, (to.y_m - corner.y_m) / side_m_);
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  // The inside of a cell, or the line between two cells, both of which then count.
  void stretch(Point middle) {
    const Point left{-heading_.y * 2 * kOn * side_m_, heading_.x * 2 * kOn * side_m_};
    bool inside = false;
    for (const double side : {-1.0, 1.0}) {
      const auto cell = map_.grid().cellAt({middle.x_m + side * left.x_m, middle.y_m + side * left.y_m});
      inside = inside || cell;
      if (cell) enter(*cell, middle);
    }
    if (!inside) report(std::nullopt, middle, "outside the map");
  }

  void enter(Cell cell, Point where) {
    const auto code = map_.at(cell);
    if (std::isfinite(map_.cost().costPerMetre(code, heading_))) return;
    const auto refusal = map_.cost().detail(code, heading_).refusal;
    const bool said = refusal != costmap::Refusal::None;
    report(cell, where, said ? costmap::toText(refusal) : "the ground refuses this heading");
  }

  void report(std::optional<Cell> cell, Point where, std::string reason) {
    if (!found.empty() && cell == last_ && found.back().reason == reason) return;
    last_ = cell;
    found.push_back({where, std::move(reason)});
  }

  const CostGrid& map_;
  double side_m_;
  Direction heading_;
  std::optional<Cell> last_;
};

}  // namespace

std::vector<Violation> violations(const CostGrid& map, const std::vector<Point>& route) {
  Checker checker(map);
  if (route.size() == 1) checker.place(route.front());
  for (std::size_t i = 1; i < route.size(); ++i) {
    checker.segment(route[i - 1], route[i]);
    if (i > 1) checker.touch(route[i - 1]);
    if (i + 1 < route.size()) checker.touch(route[i]);
  }
  return checker.found;
}

}  // namespace talus::planner
