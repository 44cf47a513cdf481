#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <planner/heading_minorant.hpp>
#include <planner/relaxed_edges.hpp>

namespace talus::planner {
namespace {

using Prices = HeadingMinorants::Prices;

constexpr float kNone = std::numeric_limits<float>::infinity();  // no motion there to be bounded
constexpr double kOctagon = 0.92387;  // cos(pi/8), rounded down by more than floats are off

Prices nothing() noexcept {
  Prices prices{};
  prices.fill(kNone);
  return prices;
}

class Relaxation {
 public:
  explicit Relaxation(const costmap::CostGrid& map) : map_(map), lines_(map.cost()), headings_(map.cost()) {}

  // Price of a metre in a cell; none outside the map and where no heading is allowed.
  Prices cell(maps::Cell at) {
    if (!map_.grid().contains(at)) return nothing();
    const auto code = map_.at(at);
    if (code.curve() >= lines_.curves()) return nothing();
    if (!onBorder(at)) return headings_.of(code);
    // In the outer half of border cells the field is continued straight outwards, which allows for no tilt.
    Prices prices{};
    prices.fill(static_cast<float>(kOctagon * lines_.level(code).level_J_per_m));
    return prices;
  }

  // Price in the square whose south-west corner is the centre of a cell.
  static Prices square(const Prices* lower, const Prices* upper) noexcept {
    Prices prices{};
    for (std::size_t k = 0; k < 8; ++k)
      prices[k] = std::min(std::min(lower[0][k], lower[1][k]), std::min(upper[0][k], upper[1][k]));
    for (int pass = 0; pass < 16; ++pass)
      if (!lowered(prices)) return prices;
    prices.fill(*std::min_element(prices.begin(), prices.end()));  // round is convex, too
    return prices;
  }

 private:
  bool onBorder(maps::Cell at) const noexcept {
    return at.column == 0 || at.row == 0 || at.column + 1 == map_.grid().width ||
           at.row + 1 == map_.grid().height;
  }

  // One pass towards a convex norm; whether it changed anything.
  static bool lowered(Prices& prices) noexcept {
    bool any = false;
    for (std::size_t k = 0; k < 8; ++k) {
      const float most = (prices[(k + 7) % 8] + prices[(k + 1) % 8]) * 0.70710677F;
      if (!(prices[k] > most * 1.000001F)) continue;
      prices[k] = most;
      any = true;
    }
    return any;
  }

  const costmap::CostGrid& map_;
  Minorants lines_;
  HeadingMinorants headings_;
};

// Prices of the squares above one row of cells, from the column before the first to the last.
void fillSquares(const std::vector<Prices>& lower, const std::vector<Prices>& upper,
                 std::vector<Prices>& squares) {
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = Relaxation::square(&lower[i], &upper[i]);
}

void fillCells(Relaxation& relaxation, int row, std::vector<Prices>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = relaxation.cell({static_cast<int>(i) - 1, row});
}

// Prices of the steps into a cell: squares below and above it, west one first.
Prices stepsInto(const Prices* below, const Prices* above) noexcept {
  constexpr float root = 1.4142135F;
  Prices into{};
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

// Calls each(cell, prices of the steps into it) for every cell, row by row; false when stopped.
template <typename Each>
bool forEachCell(const costmap::CostGrid& map, Relaxation& relaxation, const StopCheck& stop, Each each) {
  const auto width = static_cast<std::size_t>(map.grid().width);
  std::vector<Prices> cells(width + 2), next(width + 2), below(width + 1), above(width + 1);
  fillCells(relaxation, -1, cells);
  fillCells(relaxation, 0, next);
  fillSquares(cells, next, below);
  for (int row = 0; row < map.grid().height; ++row) {
    if (stop()) return false;
    std::swap(cells, next);
    fillCells(relaxation, row + 1, next);
    fillSquares(cells, next, above);
    for (std::size_t column = 0; column < width; ++column)
      each(maps::Cell{static_cast<int>(column), row}, stepsInto(&below[column], &above[column]));
    std::swap(below, above);
  }
  return true;
}

}  // namespace

std::shared_ptr<const EdgeLayer> relaxedEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                              const StopCheck& stop) {
  Relaxation relaxation(*map);
  const double side_m = map->grid().resolution_m;
  float least = kNone;
  const bool seen = forEachCell(*map, relaxation, stop, [&least](maps::Cell, const Prices& into) {
    least = std::min(least, *std::min_element(into.begin(), into.end()));
  });
  if (!seen || !(least > 0.0F)) return nullptr;
  constexpr std::uint32_t kCheapest = 64;
  const double unit_J = std::isfinite(least) ? static_cast<double>(least) * side_m / (kCheapest + 1) : 1.0;
  auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(unit_J, kCheapest), EdgeLayer::Unfilled{});
  const maps::Grid& grid = map->grid();
  const bool filled = forEachCell(*map, relaxation, stop, [&](maps::Cell cell, const Prices& into) {
    std::uint16_t* steps = edges->into(edges->padded().index(cell));
    for (std::size_t k = 0; k < 8; ++k) {
      const maps::Cell from{cell.column + kStep[k].column, cell.row + kStep[k].row};
      steps[k] = EdgeLayer::kBlocked;
      if (!grid.contains(from) || std::isinf(into[k])) continue;
      const double units = std::floor(static_cast<double>(into[k]) * side_m / unit_J);
      steps[k] = static_cast<std::uint16_t>(std::clamp(units, double{kCheapest}, EdgeUnits::kBlocked - 1.0));
    }
  });
  return filled ? edges : nullptr;
}

}  // namespace talus::planner
