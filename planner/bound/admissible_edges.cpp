#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/directional_lower_bound.hpp>

namespace talus::planner {
namespace {

using DirectionCosts = DirectionalLowerBounds::DirectionCosts;

// Cost of a heading without an allowed motion.
constexpr float kNone = std::numeric_limits<float>::infinity();

DirectionCosts nothing() noexcept {
  DirectionCosts prices{};
  prices.fill(kNone);
  return prices;
}

// Lowers each cost above (its neighbours' sum) / sqrt(2). Returns true if any cost changed.
bool lowered(DirectionCosts& prices) noexcept {
  bool any = false;
  for (std::size_t k = 0; k < 8; ++k) {
    const float most = (prices[(k + 7) % 8] + prices[(k + 1) % 8]) * 0.70710677F;
    if (!(prices[k] > most * 1.000001F)) continue;
    prices[k] = most;
    any = true;
  }
  return any;
}

DirectionCosts convex(DirectionCosts prices) noexcept {
  for (int pass = 0; pass < 16; ++pass)
    if (!lowered(prices)) return prices;
  prices.fill(*std::min_element(prices.begin(), prices.end()));  // equal costs are convex, too
  return prices;
}

// Fills `cells` with the costs of one cell side in eight headings, for the cells of `row` from column -1 to
// column `width`. Cells outside the map and cells without an allowed heading have infinite costs.
void fillCells(const costmap::CostGrid& map, DirectionalLowerBounds& headings, int row,
               std::vector<DirectionCosts>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const maps::Cell at{static_cast<int>(i) - 1, row};
    cells[i] = nothing();
    if (!map.grid().contains(at)) continue;
    const auto code = map.at(at);
    if (code.curve() < map.cost().curves().size()) cells[i] = convex(headings.of(code));
  }
}

// Returns the costs of the eight steps into a corner of cells. `below` and `above` point to the western of
// the two cells south and north of the corner.
DirectionCosts stepsInto(const DirectionCosts* below, const DirectionCosts* above) noexcept {
  constexpr float root = 1.4142135F;
  DirectionCosts into{};
  into[kEast] = std::min(above[1][kWest], below[1][kWest]);
  into[kWest] = std::min(above[0][kEast], below[0][kEast]);
  into[kNorth] = std::min(above[0][kSouth], above[1][kSouth]);
  into[kSouth] = std::min(below[0][kNorth], below[1][kNorth]);
  into[kNorthEast] = root * above[1][kSouthWest];
  into[kNorthWest] = root * above[0][kSouthEast];
  into[kSouthWest] = root * below[0][kNorthEast];
  into[kSouthEast] = root * below[1][kNorthWest];
  return into;
}

// Calls each(corner, costs of the steps into the corner) for every corner, row by row. Returns false when
// stopped.
template <typename Each>
bool forEachCorner(const costmap::CostGrid& map, DirectionalLowerBounds& headings, const StopCheck& stop,
                   Each each) {
  const auto width = static_cast<std::size_t>(map.grid().width);
  std::vector<DirectionCosts> below(width + 2), above(width + 2);
  fillCells(map, headings, -1, below);
  for (int row = 0; row <= map.grid().height; ++row) {
    if (stop()) return false;
    fillCells(map, headings, row, above);
    for (std::size_t column = 0; column <= width; ++column)
      each(maps::Cell{static_cast<int>(column), row}, stepsInto(&below[column], &above[column]));
    std::swap(below, above);
  }
  return true;
}

}  // namespace

std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const StopCheck& stop) {
  DirectionalLowerBounds headings(map->cost());
  const double side_m = map->grid().resolution_m;
  float least = kNone;
  const bool seen = forEachCorner(*map, headings, stop, [&least](maps::Cell, const DirectionCosts& into) {
    least = std::min(least, *std::min_element(into.begin(), into.end()));
  });
  if (!seen || !(least > 0.0F)) return nullptr;
  constexpr std::uint32_t kCheapest = 64;
  const double unit_J = std::isfinite(least) ? static_cast<double>(least) * side_m / (kCheapest + 1) : 1.0;
  auto edges = std::make_shared<EdgeLayer>(
      map, EdgeUnits(unit_J, kCheapest), EdgeLayer::Unfilled{map->grid().width + 1, map->grid().height + 1});
  const bool filled = forEachCorner(*map, headings, stop, [&](maps::Cell corner, const DirectionCosts& into) {
    std::uint16_t* steps = edges->into(edges->padded().index(corner));
    for (std::size_t k = 0; k < 8; ++k) {
      steps[k] = EdgeLayer::kBlocked;
      if (std::isinf(into[k])) continue;  // the step crosses or borders no cell that the heading may enter
      const double units = std::floor(static_cast<double>(into[k]) * side_m / unit_J);
      steps[k] = static_cast<std::uint16_t>(std::clamp(units, double{kCheapest}, EdgeUnits::kBlocked - 1.0));
    }
  });
  return filled ? edges : nullptr;
}

}  // namespace talus::planner
