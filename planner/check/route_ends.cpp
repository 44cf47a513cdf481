#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/surface/surface.hpp>
#include <talus/planner/check/route_ends.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {

class CellJudge::Headings {
 public:
  explicit Headings(const costmap::TravelCost& cost) : allowed(cost) {
    constexpr int kHeadings = 64;
    for (int k = 0; k < kHeadings; ++k) {
      const double heading_rad = k * HeadingSet::kTurn / kHeadings;
      costs.emplace_back(cost, costmap::Direction{std::cos(heading_rad), std::sin(heading_rad)});
    }
  }

  HeadingSets allowed;
  std::vector<HeadingCost> costs;
};

CellJudge::CellJudge(std::shared_ptr<const costmap::TravelCost> cost)
    : cost_(std::move(cost)), level_J_per_m_(std::numeric_limits<float>::infinity()) {
  if (!cost_) throw std::invalid_argument("CellJudge: needs a drive cost");
  for (const costmap::TravelCurve& curve : cost_->curves())
    level_J_per_m_ = std::min(level_J_per_m_, curve.price(0.0, 0.0));
  headings_ = std::make_unique<Headings>(*cost_);
}

CellJudge::~CellJudge() = default;

CellJudgement CellJudge::of(costmap::CellCode cell) {
  using Kind = CellJudgement::Kind;
  if (cell.curve() == costmap::CellCode::kUnknown) return {.kind = Kind::Unknown};
  const HeadingSet& allowed = headings_->allowed.of(cell);
  if (allowed.empty()) return {.kind = Kind::Refused};
  if (!allowed.all()) return {.kind = Kind::Restricted};
  float highest = 0.0F;
  for (const HeadingCost& cost : headings_->costs) highest = std::max(highest, cost(cell));
  // A single refused heading, within the rounding by which allowed arcs are widened.
  if (!std::isfinite(highest)) return {.kind = Kind::Restricted};
  return {.kind = Kind::Open, .highest_J_per_m = highest};
}

namespace {

using maps::Point;

bool refused(const costmap::CostGrid& map, maps::Cell cell) {
  return map.at(cell).curve() >= map.cost().curves().size();
}

// True if the border of the map near a place outside of the map is refused, as it is unless unknown ground is
// permitted: all cells closer than half the width of the rover to the nearest cell of a ring around the map.
bool borderRefused(const costmap::CostGrid& map, Point place, double half_width_m) {
  const maps::Grid& grid = map.grid();
  const auto cellOf = [&grid](double along_m, int count) {
    return static_cast<int>(std::clamp(std::floor(along_m / grid.resolution_m), -1.0, 1.0 * count));
  };
  const maps::Cell at{cellOf(place.x_m - grid.south_west.x_m, grid.width),
                      cellOf(place.y_m - grid.south_west.y_m, grid.height)};
  const int reach = static_cast<int>(std::ceil(half_width_m / grid.resolution_m));
  for (int row = std::max(at.row - reach, 0); row <= std::min(at.row + reach, grid.height - 1); ++row)
    for (int column = std::max(at.column - reach, 0); column <= std::min(at.column + reach, grid.width - 1);
         ++column) {
      const double gap =
          std::hypot(std::max(std::abs(column - at.column) - 1, 0), std::max(std::abs(row - at.row) - 1, 0));
      if (gap * grid.resolution_m < half_width_m && !refused(map, {column, row})) return false;
    }
  return true;
}

// Reason why a wheel may not stand at a place; empty if it may.
std::string whyNot(const costmap::CostGrid& map, Point wheel, const HazardsOf& hazards) {
  const auto cell = map.grid().cellAt(wheel);
  if (!cell)
    return borderRefused(map, wheel, 0.5 * map.cost().limits().outline.width_m)
               ? "a wheel would stand outside the map"
               : "";
  const bool avoided = hazards ? has(hazards(*cell), costmap::kKeptClearOf)
                               : map.at(*cell).curve() == costmap::CellCode::kUnknown;
  return avoided && refused(map, *cell) ? "a wheel would stand on ground to avoid" : "";
}

}  // namespace

std::vector<Pose> endPoses(const std::vector<Point>& route) {
  std::vector<Pose> legs;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double east_m = route[i].x_m - route[i - 1].x_m, north_m = route[i].y_m - route[i - 1].y_m;
    if (east_m != 0.0 || north_m != 0.0) legs.push_back({route[i - 1], std::atan2(north_m, east_m)});
  }
  if (legs.empty()) return {};
  return {legs.front(), {route.back(), legs.back().heading_rad}};
}

std::vector<Pose> endPoses(const PosePath& drive) {
  constexpr double kApart_rad = 0.1;
  std::vector<Pose> found{drive.start};
  Pose pose = drive.start;
  bool moved = false;
  std::size_t at_start = 0;  // number of poses before the first arc
  for (const PosePath::Leg& leg : drive.legs) {
    const int parts = static_cast<int>(std::ceil(std::abs(leg.turn_rad) / kApart_rad));
    for (int k = 1; k < parts; ++k)
      found.push_back({pose.place, pose.heading_rad + leg.turn_rad * k / parts});
    pose = after(pose, leg);
    if (leg.turn_rad == 0.0) {
      if (!moved) at_start = found.size();
      found.resize(at_start);
      moved = true;
    }
    found.push_back(pose);
  }
  return found;
}

std::vector<Violation> violationsAtEnds(const costmap::CostGrid& map, const std::vector<Pose>& ends,
                                        const HazardsOf& hazards) {
  const auto& outline = map.cost().limits().outline;
  std::vector<Violation> found;
  if (!(outline.width_m > 0.0)) return found;
  for (const Pose& end : ends) {
    const double c = std::cos(end.heading_rad), s = std::sin(end.heading_rad);
    for (const auto& [axle, side] : {std::pair{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
      const double ahead_m = 0.5 * axle * outline.wheelbase_m, left_m = 0.5 * side * outline.track_m;
      std::string reason = whyNot(
          map, {end.place.x_m + ahead_m * c - left_m * s, end.place.y_m + ahead_m * s + left_m * c}, hazards);
      if (reason.empty()) continue;
      found.push_back({end.place, std::move(reason)});
      break;
    }
  }
  return found;
}

}  // namespace talus::planner
