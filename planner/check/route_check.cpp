#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {
namespace {

using costmap::CostGrid;
using costmap::Direction;
using maps::Cell;
using maps::Point;

// A point closer to a corner or side than this share of a cell is treated as a point on the corner or side.
constexpr double kOn = 1e-6;
// Largest spacing of the headings checked along an arc.
constexpr double kApart_rad = 0.01;

class Checker {
 public:
  explicit Checker(const CostGrid& map) : map_(map), side_m_(map.grid().resolution_m) {}
  /// Also reports soil that is weaker than required with a probability above `quantile`.
  Checker(const CostGrid& map, double quantile) : Checker(map) { quantile_ = quantile; }

  void segment(Point from, Point to) {
    const double length_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    if (!std::isfinite(length_m)) return report(std::nullopt, from, "outside the map");
    if (!(length_m > kOn * side_m_)) return place(from);
    heading_ = {(to.x_m - from.x_m) / length_m, (to.y_m - from.y_m) / length_m};
    const std::vector<double>& cuts = crossings(from, to);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if ((cuts[i] - cuts[i - 1]) * length_m > kOn * side_m_)
        stretch(along(from, to, (cuts[i] + cuts[i - 1]) / 2));
      const Point crossing = along(from, to, cuts[i]);
      const double rest = std::min(cuts[i], 1.0 - cuts[i]) * length_m;
      if (rest > kOn * side_m_ && onCorner(crossing)) touch(crossing);
    }
  }

  // Checks all cells that a point touches, for the present heading.
  void touch(Point p) {
    std::optional<Cell> before;
    for (const double dx : {-2 * kOn, 2 * kOn})
      for (const double dy : {-2 * kOn, 2 * kOn}) {
        const auto cell = map_.grid().cellAt({p.x_m + dx * side_m_, p.y_m + dy * side_m_});
        if (cell && cell != before) enter(*cell, p);
        before = cell;
      }
  }

  // Checks the cell of an end of the route.
  void end(Point p) {
    if (map_.grid().cellAt(p)) place(p);
  }

  void place(Point p) {
    const auto cell = map_.grid().cellAt(p);
    if (!cell) return report(std::nullopt, p, "outside the map");
    if (map_.at(*cell).curve() >= map_.cost().curves().size()) enter(*cell, p);
  }

  // An arc; checked as a segment if its change of heading is negligible.
  void arc(const Pose& from, const Arc& arc) {
    const Pose end = after(from, arc);
    if (std::abs(arc.curvature_1_m * arc.length_m) < 1e-9) return segment(from.place, end.place);
    const std::vector<double> cuts = crossings(from, arc);
    const double way = arc.length_m > 0.0 ? 0.0 : std::numbers::pi;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if ((cuts[i] - cuts[i - 1]) * std::abs(arc.length_m) <= kOn * side_m_) continue;
      const double bend = std::abs(arc.curvature_1_m * arc.length_m) * (cuts[i] - cuts[i - 1]);
      const int parts = static_cast<int>(std::ceil(bend / kApart_rad)) + 1;
      const Pose middle = after(from, Arc{arc.length_m * (cuts[i] + cuts[i - 1]) / 2, arc.curvature_1_m});
      const auto cell = map_.grid().cellAt(middle.place);
      if (!cell) {
        report(std::nullopt, middle.place, "outside the map");
        continue;
      }
      for (int k = 0; k < parts; ++k) {
        const double share = cuts[i - 1] + (cuts[i] - cuts[i - 1]) * (k + 0.5) / parts;
        look(from.heading_rad + arc.curvature_1_m * arc.length_m * share + way);
        enter(*cell, middle.place);
      }
    }
  }

  void turn(const Pose& from, double turn_rad) {
    if (!map_.grid().cellAt(from.place)) return report(std::nullopt, from.place, "outside the map");
    const int parts = static_cast<int>(std::ceil(std::abs(turn_rad) / kApart_rad));
    for (int k = 0; k <= parts; ++k) {
      look(from.heading_rad + turn_rad * k / std::max(1, parts));
      touch(from.place);
    }
  }

  // Checks the headings between two legs, the shorter way round: the rover passes these headings without
  // driving, so it must not tip.
  void pivot(Point at, Point before, Point next) {
    const double in_rad = std::atan2(at.y_m - before.y_m, at.x_m - before.x_m),
                 turn_rad = std::remainder(std::atan2(next.y_m - at.y_m, next.x_m - at.x_m) - in_rad,
                                           2.0 * std::numbers::pi);
    const auto cell = map_.grid().cellAt(at);
    if (!cell || at == before || at == next) return;
    const int parts = static_cast<int>(std::ceil(std::abs(turn_rad) / kApart_rad));
    for (int k = 1; k < parts; ++k) {
      look(in_rad + turn_rad * k / parts);
      if (map_.cost().tips(map_.at(*cell), heading_))
        return report(cell, at,
                      std::string("turn through a heading that ") + costmap::toText(costmap::Refusal::Tips));
    }
  }

  void report(std::optional<Cell> cell, Point where, std::string reason, double probability = 1.0) {
    if (!found.empty() && cell == last_ && found.back().reason == reason) return;
    last_ = cell;
    dangers.push_back({where, alongAt(where), probability, reason});
    found.push_back({where, std::move(reason)});
  }

  // Sets the origin of the distances along the route.
  void goOn(Point from, double along_m) noexcept {
    from_ = from;
    along_m_ = along_m;
  }

  std::vector<Violation> found;
  std::vector<Danger> dangers;

 private:
  void look(double heading_rad) noexcept { heading_ = {std::cos(heading_rad), std::sin(heading_rad)}; }

  static Point along(Point from, Point to, double t) noexcept {
    return {from.x_m + t * (to.x_m - from.x_m), from.y_m + t * (to.y_m - from.y_m)};
  }

  static double offLine(double coordinate) noexcept { return std::abs(coordinate - std::round(coordinate)); }

  bool onCorner(Point p) const noexcept {
    const auto& corner = map_.grid().south_west;
    return offLine((p.x_m - corner.x_m) / side_m_) < kOn && offLine((p.y_m - corner.y_m) / side_m_) < kOn;
  }

  // Sorted shares of the segment at which it crosses lines between columns or rows, including both ends.
  const std::vector<double>& crossings(Point from, Point to) {
    std::vector<double>& cuts = cuts_;
    cuts.assign({0.0, 1.0});
    // Lines beyond the map's edge are ignored.
    const auto add = [&cuts](double a, double b, int lines) {
      const double last = std::min(std::max(a, b), static_cast<double>(lines));
      for (double line = std::max(std::ceil(std::min(a, b)), 0.0); line <= last; line += 1.0)
        if (std::abs(b - a) > kOn) cuts.push_back(std::clamp((line - a) / (b - a), 0.0, 1.0));
    };
    const auto& corner = map_.grid().south_west;
    add((from.x_m - corner.x_m) / side_m_, (to.x_m - corner.x_m) / side_m_, map_.grid().width);
    add((from.y_m - corner.y_m) / side_m_, (to.y_m - corner.y_m) / side_m_, map_.grid().height);
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  // Sorted shares of an arc at which it crosses lines between columns or rows, including both ends. With the
  // centre c of the circle, x = c_x + r sin(heading) and y = c_y - r cos(heading).
  std::vector<double> crossings(const Pose& from, const Arc& arc) const {
    const double r = 1.0 / arc.curvature_1_m, turn = arc.length_m * arc.curvature_1_m;
    const Point centre{from.place.x_m - r * std::sin(from.heading_rad),
                       from.place.y_m + r * std::cos(from.heading_rad)};
    std::vector<double> cuts{0.0, 1.0};
    const auto atHeading = [&](double heading) {
      for (double full =
               std::floor((std::min(0.0, turn) - heading + from.heading_rad) / (2 * std::numbers::pi));
           ; ++full) {
        const double turned = heading + 2 * std::numbers::pi * full - from.heading_rad;
        if (turned > std::max(0.0, turn)) return;
        if (turned >= std::min(0.0, turn)) cuts.push_back(turned / turn);
      }
    };
    const auto lines = [&](double middle, double corner, int count, auto headings) {
      const double low = std::max((middle - std::abs(r) - corner) / side_m_, 0.0),
                   high = std::min((middle + std::abs(r) - corner) / side_m_, static_cast<double>(count));
      for (double line = std::ceil(low); line <= high; line += 1.0)
        headings(std::clamp((corner + line * side_m_ - middle) / r, -1.0, 1.0));
    };
    const Point& corner = map_.grid().south_west;
    lines(centre.x_m, corner.x_m, map_.grid().width, [&](double sine) {
      atHeading(std::asin(sine));
      atHeading(std::numbers::pi - std::asin(sine));
    });
    lines(centre.y_m, corner.y_m, map_.grid().height, [&](double minus_cosine) {
      atHeading(std::acos(-minus_cosine));
      atHeading(-std::acos(-minus_cosine));
    });
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  // Checks the inside of a cell, or both cells if the section runs along their common side.
  void stretch(Point middle) {
    const Point left{-heading_.y * 2 * kOn * side_m_, heading_.x * 2 * kOn * side_m_};
    bool inside = false;
    std::optional<Cell> before;
    for (const double side : {-1.0, 1.0}) {
      const auto cell = map_.grid().cellAt({middle.x_m + side * left.x_m, middle.y_m + side * left.y_m});
      inside = inside || cell;
      if (cell && cell != before) enter(*cell, middle);
      before = cell;
    }
    if (!inside) report(std::nullopt, middle, "outside the map");
  }

  void enter(Cell cell, Point where) {
    const auto code = map_.at(cell);
    if (std::isfinite(map_.cost().costPerMetre(code, heading_))) {
      if (quantile_ < 1.0) checkRisk(cell, code, where);
      return;
    }
    const auto refusal = map_.cost().detail(code, heading_).refusal;
    const bool refused = refusal != costmap::Refusal::None;
    report(cell, where, refused ? costmap::toText(refusal) : "this heading is not allowed on this cell");
  }

  void checkRisk(Cell cell, costmap::CellCode code, Point where) {
    const double weak = static_cast<double>(map_.cost().detail(code, heading_).weak);
    if (weak > quantile_) report(cell, where, "the soil may give less drawbar pull than required", weak);
  }

  double alongAt(Point where) const noexcept {
    return along_m_ + std::hypot(where.x_m - from_.x_m, where.y_m - from_.y_m);
  }

  const CostGrid& map_;
  double side_m_;
  double quantile_ = 1.0;  // 1: no check of the soil's strength
  Point from_;
  double along_m_ = 0.0;
  Direction heading_;
  std::optional<Cell> last_;
  std::vector<double> cuts_;  // of the present segment
};

}  // namespace

namespace {

void check(Checker& checker, const std::vector<Point>& route, const ProgressMonitor& watch = {},
           bool turns = true) {
  if (route.empty()) return;
  checker.goOn(route.front(), 0.0);
  checker.end(route.front());
  if (route.size() == 1) checker.place(route.front());
  double along_m = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    if (watch.stopped()) return;
    checker.goOn(route[i - 1], along_m);
    checker.segment(route[i - 1], route[i]);
    if (i > 1) checker.touch(route[i - 1]);
    if (i + 1 < route.size()) checker.touch(route[i]);
    if (turns && i > 1) checker.pivot(route[i - 1], route[i - 2], route[i]);
    along_m += std::hypot(route[i].x_m - route[i - 1].x_m, route[i].y_m - route[i - 1].y_m);
  }
  checker.goOn(route.back(), along_m);
  checker.end(route.back());
}

}  // namespace

std::vector<Violation> violations(const CostGrid& map, const std::vector<Point>& route,
                                  const ProgressMonitor& watch) {
  Checker checker(map);
  check(checker, route, watch);
  return checker.found;
}

std::vector<Violation> violationsOfChords(const CostGrid& map, const std::vector<Point>& chords) {
  Checker checker(map);
  check(checker, chords, {}, false);
  return checker.found;
}

std::vector<Danger> dangers(const CostGrid& map, const std::vector<Point>& route, double quantile) {
  if (!(quantile > 0.0 && quantile < 1.0))
    throw std::invalid_argument("dangers: quantile = " + std::to_string(quantile) +
                                ", must be above 0 and below 1");
  for (std::size_t i = 0; i < route.size(); ++i)
    if (!std::isfinite(route[i].x_m) || !std::isfinite(route[i].y_m))
      throw std::invalid_argument("dangers: point " + std::to_string(i) + " is not finite");
  Checker checker(map, quantile);
  check(checker, route);
  std::ranges::stable_sort(checker.dangers, {}, &Danger::along_m);
  return std::move(checker.dangers);
}

std::vector<Violation> violations(const CostGrid& map, const PosePath& drive, double turning_radius_m) {
  Checker checker(map);
  checker.place(drive.start.place);
  Pose pose = drive.start;
  for (const PosePath::Leg& leg : drive.legs) {
    if (std::abs(leg.arc.curvature_1_m) * turning_radius_m > 1.0 + 1e-9)
      checker.report(std::nullopt, pose.place, "arc radius below the minimum turning radius");
    if (leg.turn_rad != 0.0) {
      if (turning_radius_m > 0.0)
        checker.report(std::nullopt, pose.place, "turn in place by a rover that cannot turn in place");
      checker.turn(pose, leg.turn_rad);
    } else {
      checker.arc(pose, leg.arc);
    }
    pose = after(pose, leg);
  }
  return checker.found;
}

}  // namespace talus::planner
