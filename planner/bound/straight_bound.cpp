#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/straight_bound.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCurve;
using maps::Cell;
using maps::Point;

constexpr int kRounds = 6;

// Lowest cost per metre of a cell over all headings, by curve and by the steepest gradient in bins. Rows with
// a gradient across cost no less than row 0 (TravelCurve).
class LowestCosts {
 public:
  explicit LowestCosts(const costmap::TravelCost& cost) : least_(cost.curves().size()) {
    for (std::size_t k = 0; k < least_.size(); ++k) {
      const auto& row = cost.curves()[k].cost_J_per_m;
      double least = kInfinity;
      for (int reach = 0; reach <= kMiddle; ++reach) {
        least =
            std::min({least, static_cast<double>(row[static_cast<std::size_t>(kMiddle - reach)]),
                      reach < kMiddle ? static_cast<double>(row[static_cast<std::size_t>(kMiddle + reach)])
                                      : kInfinity});
        least_[k][static_cast<std::size_t>(reach)] = std::max(least, 0.0);
      }
    }
  }

  // Infinite for a cell without a curve.
  double operator()(CellCode cell) const noexcept {
    if (cell.curve() >= least_.size()) return kInfinity;
    const double steepest = std::hypot(cell.dzDx(), cell.dzDy()) * (1.0 + 1e-9);  // headings are rounded
    const int reach =
        static_cast<int>(std::min(std::ceil(steepest * TravelCurve::kBinsPerUnit), double{kMiddle}));
    return least_[cell.curve()][static_cast<std::size_t>(reach)];
  }

 private:
  static constexpr int kMiddle = TravelCurve::kBins / 2;
  std::vector<std::array<double, kMiddle + 1>> least_;
};

// Lowest cost per metre of the cells that a curve of length `length_m` between the two places can touch.
// Infinite if no such cell has a curve; 0 when stopped.
double cheapestWithin(const costmap::CostGrid& map, const LowestCosts& metres, const Segment& places,
                      double length_m, const StopCheck& stop) {
  const maps::Grid& grid = map.grid();
  // Margin of half a cell diagonal per leg: distances are measured to cell centres.
  const double reach_m = length_m + std::numbers::sqrt2 * 1.001 * grid.resolution_m;
  const auto line = [&](double middle_m, double origin_m, double off_m, int count) {
    const double at = (middle_m + off_m - origin_m) / grid.resolution_m;
    return static_cast<int>(std::clamp(at, 0.0, count - 1.0));
  };
  const Point middle{0.5 * (places.from.x_m + places.to.x_m), 0.5 * (places.from.y_m + places.to.y_m)};
  const double half_m = 0.5 * reach_m;
  const Cell first{line(middle.x_m, grid.south_west.x_m, -half_m, grid.width),
                   line(middle.y_m, grid.south_west.y_m, -half_m, grid.height)};
  const Cell last{line(middle.x_m, grid.south_west.x_m, half_m, grid.width),
                  line(middle.y_m, grid.south_west.y_m, half_m, grid.height)};
  double least = kInfinity;
  for (int row = first.row; row <= last.row; ++row) {
    if ((row & 63) == 0 && stop()) return 0.0;
    for (int column = first.column; column <= last.column; ++column) {
      const double metre = metres(map.at({column, row}));
      if (!(metre < least)) continue;
      const Point centre = grid.centre({column, row});
      if (distance_m(places.from, centre) + distance_m(centre, places.to) <= reach_m) least = metre;
    }
  }
  return least;
}

double cheapestOfAny(const costmap::TravelCost& cost) noexcept {
  double least = kInfinity;
  for (const TravelCurve& curve : cost.curves())
    for (const float value : curve.cost_J_per_m) least = std::min(least, static_cast<double>(value));
  return std::isfinite(least) ? std::max(least, 0.0) : 0.0;
}

}  // namespace

double cheapestMetre_J(const costmap::CostGrid& map) {
  std::vector<bool> used(std::size_t{costmap::CellCode::kBlocked} + 1);
  for (std::size_t i = 0; i < map.content().tiles.size(); ++i)
    for (const costmap::CellCode cell : map.content().tiles.tile(i).cells) used[cell.curve()] = true;
  float cheapest = std::numeric_limits<float>::infinity();
  const auto& curves = map.cost().curves();
  for (std::size_t k = 0; k < curves.size(); ++k)
    if (used[k]) cheapest = std::min(cheapest, *std::ranges::min_element(curves[k].cost_J_per_m));
  return std::isfinite(cheapest) ? static_cast<double>(std::max(cheapest, 0.0F)) : 0.0;
}

double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m) {
  return cheapestOfAny(map.cost()) * std::max(0.0, distance_m(places.from, places.to) - tolerance_m);
}

double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J, const StopCheck& stop) {
  const LowestCosts metres(map.cost());
  const double straight_m = std::max(0.0, distance_m(places.from, places.to) - tolerance_m);
  double cheapest = cheapestOfAny(map.cost());
  for (int round = 0; round < kRounds && std::isfinite(known_J) && cheapest > 0.0; ++round) {
    const double least = cheapestWithin(map, metres, places, known_J / cheapest + tolerance_m, stop);
    if (std::isinf(least) || !(least > cheapest * 1.0001)) break;
    cheapest = least;
  }
  const double twice_m = 2.0 * distance_m(places.from, places.to);
  if (const double least = cheapestWithin(map, metres, places, twice_m, stop); std::isfinite(least))
    cheapest = std::max(cheapest, least);
  return std::min(known_J, cheapest * straight_m);
}

}  // namespace talus::planner
