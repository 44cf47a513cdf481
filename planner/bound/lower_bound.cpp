#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution.hpp>

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
      const auto row = cost.curves()[k].level();
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
    for (const float value : curve.level()) least = std::min(least, static_cast<double>(value));
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
    if (used[k]) cheapest = std::min(cheapest, *std::ranges::min_element(curves[k].level()));
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

namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kCheapest = 16;  // units of the cheapest edge that an octagon permits

Octagon nothing() noexcept {
  Octagon octagon;
  octagon.fill(kNone);
  return octagon;
}

// Returns the costs of the eight steps into a corner of cells. `below` and `above` point to the western of
// the two cells south and north of the corner.
Octagon stepsInto(const Octagon* below, const Octagon* above) noexcept {
  constexpr float root = 1.4142135F;
  Octagon into{};
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
bool forEachCorner(const maps::Grid& grid, const OctagonOf& octagon_of, RouteSense sense,
                   const StopCheck& stop, Each each) {
  const auto width = static_cast<std::size_t>(grid.width);
  std::vector<Octagon> below(width + 2, nothing()), above = below;
  for (int row = 0; row <= grid.height; ++row) {
    if (stop()) return false;
    for (std::size_t i = 0; i < width; ++i) {
      Octagon& octagon = above[i + 1];
      octagon = row < grid.height ? octagon_of({static_cast<int>(i), row}) : nothing();
      if (sense == RouteSense::FromStart) std::rotate(octagon.begin(), octagon.begin() + 4, octagon.end());
    }
    for (std::size_t column = 0; column <= width; ++column)
      each(maps::Cell{static_cast<int>(column), row}, stepsInto(&below[column], &above[column]));
    std::swap(below, above);
  }
  return true;
}

}  // namespace

std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const OctagonOf& octagon_of, const StopCheck& stop,
                                                 RouteSense sense) {
  const maps::Grid& grid = map->grid();
  const double side_m = grid.resolution_m, cheapest_J = cheapestMetre_J(*map);
  if (!(cheapest_J > 0.0)) return nullptr;
  const double unit_J = FittedOctagons::kLeastShare * cheapest_J * side_m / (kCheapest + 1);
  auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(unit_J, kCheapest),
                                           EdgeLayer::Unfilled{grid.width + 1, grid.height + 1});
  const bool filled =
      forEachCorner(grid, octagon_of, sense, stop, [&](maps::Cell corner, const Octagon& into) {
        std::uint16_t* steps = edges->into(edges->padded().index(corner));
        for (std::size_t k = 0; k < 8; ++k) {
          steps[k] = EdgeLayer::kBlocked;
          if (std::isinf(into[k]))
            continue;  // the step crosses or borders no cell that the heading may enter
          const double units = std::floor(static_cast<double>(into[k]) * side_m / unit_J);
          steps[k] =
              static_cast<std::uint16_t>(std::clamp(units, double{kCheapest}, EdgeUnits::kBlocked - 1.0));
        }
      });
  return filled ? edges : nullptr;
}

std::vector<float> cornerField(const std::shared_ptr<const costmap::CostGrid>& map,
                               const OctagonOf& octagon_of, std::vector<FieldGoal> ends,
                               const StopCheck& stop, RouteSense sense) {
  const auto edges = admissibleEdges(map, octagon_of, stop, sense);
  if (!edges) return {};
  for (FieldGoal& end : ends) end.cost_J = std::max(0.0, end.cost_J - edges->units().unit_J());  // is rounded
  CostToGo field(edges, ends);
  if (!field.settleAll(stop)) return {};
  const PaddedGrid& corners = edges->padded();
  std::vector<float> costs_J;
  costs_J.reserve(static_cast<std::size_t>(corners.width) * static_cast<std::size_t>(corners.height));
  for (int row = 0; row < corners.height; ++row)
    for (int column = 0; column < corners.width; ++column)
      costs_J.push_back(
          static_cast<float>(field.cost_J({column, row}).value_or(std::numeric_limits<double>::infinity())));
  return costs_J;
}

namespace {

constexpr auto kFar = static_cast<float>(kInfinity);
// Of level 2: smallest share of the gap that a round closes for which another one follows, share of the gap above the
// bound up to which a round fits cells, most rounds.
constexpr double kLeastGain = 0.03, kFitShare = 0.35;
constexpr int kFitRounds = 16;
// Of level 3: cells of its first region, cells of the box around it, smallest share of the gap that a division of the
// cells closes for which another one follows.
constexpr std::size_t kMeshCells = 60'000, kBoxCells = 8'000'000;
constexpr double kLeastDivided = 0.1;

// Nodes that level 3 takes and cells that it checks, on a map of `cells` cells.
constexpr std::size_t meshWork(std::size_t cells) noexcept {
  return std::max(std::min<std::size_t>(30 * cells, 6'000'000), std::min<std::size_t>(3 * cells, 12'000'000));
}

// Index of a corner in a cornerField().
std::size_t cornerIndex(const maps::Grid& grid, maps::Cell corner) noexcept {
  return static_cast<std::size_t>(corner.row) * (static_cast<std::size_t>(grid.width) + 1) +
         static_cast<std::size_t>(corner.column);
}

// Indices of the corners of a cell, counter-clockwise from the south-west corner.
std::array<std::size_t, 4> cornersOf(const maps::Grid& grid, maps::Cell cell) noexcept {
  const std::size_t south = cornerIndex(grid, cell), north = cornerIndex(grid, {cell.column, cell.row + 1});
  return {south, south + 1, north + 1, north};
}

// The corners around a place, where routes may begin or end: those of all cells within a distance.
std::vector<FieldGoal> cornersAround(const maps::Grid& grid, maps::Point place, double distance_m) {
  std::vector<FieldGoal> corners;
  for (const maps::Cell cell : cellsWithin(grid, place, distance_m))
    for (const maps::Cell step : {maps::Cell{0, 0}, {1, 0}, {0, 1}, {1, 1}})
      corners.push_back({{cell.column + step.column, cell.row + step.row}, 0.0});
  return corners;
}

// Lowest value [J] at some corners; 0 if none was reached.
double leastAt(const std::vector<float>& field, const maps::Grid& grid,
               const std::vector<FieldGoal>& corners) {
  float least = kFar;
  for (const FieldGoal& corner : corners) least = std::min(least, field[cornerIndex(grid, corner.cell)]);
  return std::isfinite(least) ? static_cast<double>(least) : 0.0;
}

// Increases per metre of a function over corners along the eight headings in a cell, the larger of both sides
// along a heading; empty if a corner has no value.
std::optional<Octagon> risesIn(const std::vector<float>& values, const maps::Grid& grid, maps::Cell cell) {
  std::array<double, 4> v;
  for (std::size_t k = 0; k < 4; ++k) {
    v[k] = static_cast<double>(values[cornersOf(grid, cell)[k]]) / grid.resolution_m;
    if (!std::isfinite(v[k])) return std::nullopt;
  }
  const auto rise = [&v](std::size_t a, std::size_t b) { return v[b] - v[a]; };
  const auto side = [](double a, double b) { return static_cast<float>(std::max(a, b)); };
  const auto across = [](double a) { return static_cast<float>(a / std::numbers::sqrt2); };
  return Octagon{
      side(rise(0, 1), rise(3, 2)), across(rise(0, 2)), side(rise(0, 3), rise(1, 2)), across(rise(1, 3)),
      side(rise(1, 0), rise(2, 3)), across(rise(2, 0)), side(rise(3, 0), rise(2, 1)), across(rise(3, 1))};
}

// Returns the part of a map that contains a region, with each cell divided into `divided` x `divided` equal cells and
// the cells outside of the region closed, and the lower bounds from the start.
SubSolution::Parts dividedPart(const costmap::CostGrid& map, const maps::CellBox& box,
                               const std::vector<bool>& region, const std::vector<float>& from_start,
                               int divided) {
  const maps::Grid& grid = map.grid();
  maps::Grid part{.width = box.width() * divided,
                  .height = box.height() * divided,
                  .resolution_m = grid.resolution_m / divided,
                  .south_west = {grid.south_west.x_m + box.first.column * grid.resolution_m,
                                 grid.south_west.y_m + box.first.row * grid.resolution_m}};
  const auto outer = [&](int column, int row) {
    return Cell{box.first.column + std::min(column / divided, box.width() - 1),
                box.first.row + std::min(row / divided, box.height() - 1)};
  };
  maps::Raster<CellCode> cells(part, CellCode({.curve = CellCode::kBlocked}));
  SubSolution::Parts parts{.most_J = 0.0, .cheapest_J = cheapestMetre_J(map)};
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column)
      if (const Cell of = outer(column, row); region[grid.index(of)]) cells[Cell{column, row}] = map.at(of);
  parts.map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, map.content().cost));
  // At a new corner, the lowest bound of the cell's corners holds: a route enters the cell between two of them.
  for (int row = 0; row <= part.height; ++row)
    for (int column = 0; column <= part.width; ++column) {
      const bool old = row % divided == 0 && column % divided == 0;
      const auto of = cornersOf(grid, outer(column, row));
      const auto at = [&](std::size_t corner) { return from_start[corner]; };
      parts.from_start.push_back(
          old ? at(cornerIndex(grid, {box.first.column + column / divided, box.first.row + row / divided}))
              : std::min({at(of[0]), at(of[1]), at(of[2]), at(of[3])}));
    }
  return parts;
}

// Returns the lower bound [J] on a uniform map whose limit for each heading is the lowest of all cells; on a
// uniform map the optimal function is linear. Returns 0 as soon as the bound is at most `enough_J`.
double planeBound_J(const DirectionalCostBounds& of, const Segment& places, double tolerance_m,
                    double enough_J) {
  constexpr int kHeadings = DirectionalCostBounds::kHeadings;
  const double length_m = std::max(0.0, distance_m(places.from, places.to) - tolerance_m);
  const costmap::Direction way = directionOf(places);
  DirectionalCostBounds::Limits least;
  least.fill(std::numeric_limits<float>::infinity());
  // Returns the cost [J/m] of the direction `way`, composed of the headings i and j; infinite if `way` does
  // not lie between them.
  const auto price = [&](int i, int j) {
    const costmap::Direction a = DirectionalCostBounds::heading(i), b = DirectionalCostBounds::heading(j);
    const double det = a.x * b.y - a.y * b.x, p = way.x * b.y - way.y * b.x, q = a.x * way.y - a.y * way.x;
    if (!(det > 1e-9) || p < 0.0 || q < 0.0) return kInfinity;
    return (p * static_cast<double>(least[static_cast<std::size_t>(i)]) +
            q * static_cast<double>(least[static_cast<std::size_t>(j)])) /
           det;
  };
  const auto over = [&] {
    double all = kInfinity;
    for (int i = 0; i < kHeadings; ++i)
      for (int j = 0; j < kHeadings; ++j) all = std::min(all, price(i, j));
    return all;
  };
  bool enough = true;
  of.forEachRequested([&](const DirectionalCostBounds::Limits& limits) {
    bool lower = false;
    for (std::size_t k = 0; k < limits.size(); ++k) {
      lower = lower || limits[k] < least[k];
      least[k] = std::min(least[k], limits[k]);
    }
    enough = enough && (!lower || over() * length_m > enough_J);
  });
  if (!enough) return 0.0;
  const double metre_J = over();
  return std::isfinite(metre_J) ? metre_J * length_m : 0.0;
}

}  // namespace

double LowerBound::operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                              double goal_tolerance_m, const StopCheck& stop, double known_J, double gap) {
  const double even_J = (1.0 - std::max(kEven, gap)) * known_J,
               enough_J = (1.0 - (gap > 0.0 ? gap : kEnough)) * known_J;
  to_goal_.clear();
  const double straight_J = straightBoundOver_J(*map, places, goal_tolerance_m, known_J, stop);
  if (straight_J >= even_J) return straight_J;
  const auto starts = cornersAround(map->grid(), places.from, 0.0);
  if (!prepare(map, places.to, goal_tolerance_m, stop)) return straight_J;
  double bound_J = std::max(straight_J, leastAt(level_1_, map->grid(), starts));
  bound_J = std::max(bound_J, planeBound_J(octagons_->limits(), places, tolerance_m_, bound_J));
  if (bound_J >= even_J) return std::min(known_J, bound_J);
  return std::min(known_J, std::max(bound_J, narrowed_J(places, starts, known_J, enough_J, stop)));
}

bool LowerBound::prepare(const std::shared_ptr<const costmap::CostGrid>& map, maps::Point goal,
                         double goal_tolerance_m, const StopCheck& stop) {
  if (map != map_) {
    map_ = map;
    level_1_.clear();
    octagons_.emplace(map->cost());
  }
  if (level_1_.empty() || !(goal_ == goal) || tolerance_m_ != goal_tolerance_m) {
    goal_ = goal;
    tolerance_m_ = goal_tolerance_m;
    level_1_ = cornerField(map_, octagonOf(), cornersAround(map->grid(), goal_, tolerance_m_), stop);
  }
  to_goal_ = level_1_;
  return !to_goal_.empty();
}

std::vector<bool> LowerBound::corridor(const std::shared_ptr<const costmap::CostGrid>& map,
                                       const Segment& places, double goal_tolerance_m, double most_J,
                                       const StopCheck& stop) {
  if (!prepare(map, places.to, goal_tolerance_m, stop)) return {};
  narrowed_J(places, cornersAround(map->grid(), places.from, 0.0), most_J, (1.0 - kEnough) * most_J, stop);
  return stop() || from_start_.empty() ? std::vector<bool>{} : inside_;
}

double LowerBound::toGoal_J(maps::Point place) const noexcept {
  const auto cell = map_ ? map_->grid().cellAt(place) : std::nullopt;
  if (to_goal_.empty() || !cell) return 0.0;
  const maps::Grid& grid = map_->grid();
  const auto corners = cornersOf(grid, *cell);
  const double x = (place.x_m - grid.south_west.x_m) / grid.resolution_m - cell->column,
               y = (place.y_m - grid.south_west.y_m) / grid.resolution_m - cell->row;
  const auto part = [&](std::size_t corner, double share) {
    return share > 0.0 ? share * static_cast<double>(to_goal_[corners[corner]]) : 0.0;
  };
  return part(0, (1.0 - x) * (1.0 - y)) + part(1, x * (1.0 - y)) + part(2, x * y) + part(3, (1.0 - x) * y);
}

OctagonOf LowerBound::octagonOf() {
  return [this](maps::Cell cell) { return octagons_->of(map_->at(cell)); };
}

// Returns the lowest cost [J] of a route of level 1 or 2 through a corner of a cell.
double LowerBound::throughCell_J(maps::Cell cell) const {
  float least = kFar;
  for (const std::size_t k : cornersOf(map_->grid(), cell))
    least = std::min(least, from_start_[k] + to_goal_[k]);
  return static_cast<double>(least);
}

template <typename Each>
void LowerBound::forEachInside(Each each) const {
  for (int row = 0; row < map_->grid().height; ++row)
    for (int column = 0; column < map_->grid().width; ++column)
      if (const std::size_t at = map_->grid().index({column, row}); inside_[at])
        each(maps::Cell{column, row}, at);
}

// Returns the largest cost, at most `known_J`, such that at most `cells` cells are on routes of at most this cost.
double LowerBound::costFor(std::size_t cells, double least_J, double known_J) const {
  constexpr std::size_t kBins = 1000;
  const double most_J = std::isfinite(known_J) ? known_J : 2.0 * least_J, bin_J = (most_J - least_J) / kBins;
  std::array<std::size_t, kBins + 1> count{};
  forEachInside([&](maps::Cell cell, std::size_t) {
    ++count[static_cast<std::size_t>(
        std::clamp((throughCell_J(cell) - least_J) / bin_J, 0.0, double{kBins}))];
  });
  std::size_t bins = 0;
  for (std::size_t sum = count[0]; bins < kBins && sum <= cells; sum += count[bins]) ++bins;
  return bins == kBins ? known_J : least_J + static_cast<double>(bins) * bin_J;
}

double LowerBound::narrowed_J(const Segment& places, const std::vector<FieldGoal>& starts, double known_J,
                              double enough_J, const StopCheck& stop) {
  const maps::Grid& grid = map_->grid();
  const auto ends = cornersAround(grid, goal_, tolerance_m_);
  from_start_ = cornerField(map_, octagonOf(), starts, stop, RouteSense::FromStart);
  if (from_start_.empty()) return 0.0;
  inside_.assign(grid.size(), true);
  std::vector<std::uint32_t> fit_of(grid.size(), 0);  // position in `fits`; 0: none
  std::vector<Octagon> fits(1);
  const auto fitted = [&](maps::Cell cell) {
    Octagon octagon;
    octagon.fill(kFar);
    const std::size_t at = grid.index(cell);
    if (!inside_[at]) return octagon;
    return fit_of[at] != 0 ? fits[fit_of[at]] : octagons_->of(map_->at(cell));
  };
  double bound_J = leastAt(from_start_, grid, ends);
  for (int round = 0;; ++round) {
    forEachInside([&](maps::Cell cell, std::size_t at) { inside_[at] = throughCell_J(cell) <= known_J; });
    if (round == kFitRounds || bound_J >= enough_J) break;
    bool stopped = false;
    const double fitted_J = bound_J + kFitShare * (known_J - bound_J);
    forEachInside([&](maps::Cell cell, std::size_t at) {
      if ((at & 0xffffU) == 0) stopped = stopped || stop();
      if (stopped || throughCell_J(cell) > fitted_J) return;
      DirectionalCostBounds::Limits limits;
      if (!octagons_->limits().of(map_->at(cell), limits)) return;
      const auto rises = risesIn(from_start_, grid, cell);
      if (!rises) return;
      if (fit_of[at] == 0) fit_of[at] = static_cast<std::uint32_t>(fits.size());
      fits.resize(std::max<std::size_t>(fits.size(), fit_of[at] + std::size_t{1}));
      fits[fit_of[at]] = fittedOctagon(limits, *rises);
    });
    auto raised = cornerField(map_, fitted, starts, stop, RouteSense::FromStart);
    if (raised.empty()) return bound_J;
    from_start_ = std::move(raised);
    const double gap_J = known_J - bound_J;
    bound_J = std::max(bound_J, leastAt(from_start_, grid, ends));
    const bool last = known_J - bound_J > (1.0 - kLeastGain) * gap_J;
    if (last || round % 2 == 1) {
      raised = cornerField(map_, fitted, ends, stop);
      if (raised.empty()) return bound_J;
      to_goal_ = std::move(raised);
    }
    if (last) break;
  }
  fits = {};
  return std::max(bound_J, certified_J(places, bound_J, known_J, enough_J, stop));
}

double LowerBound::certified_J(const Segment& places, double bound_J, double known_J, double enough_J,
                               const StopCheck& stop) {
  const maps::Grid& grid = map_->grid();
  std::vector<bool> region(grid.size());
  std::size_t cells = kMeshCells, left = meshWork(grid.size()), next = 0;
  for (int divided = 1; bound_J < enough_J && next < left && !stop();) {
    const double most_J = divided == 1 ? costFor(cells, bound_J, known_J) : known_J;
    maps::CellBox box{{grid.width, grid.height}, {-1, -1}};
    forEachInside([&](Cell cell, std::size_t at) {
      region[at] = throughCell_J(cell) <= most_J;
      if (region[at])
        box = {{std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)},
               {std::max(box.last.column, cell.column), std::max(box.last.row, cell.row)}};
    });
    const auto parts_of = [divided](int cells_of) { return static_cast<std::size_t>(cells_of * divided); };
    if (box.width() <= 0 || parts_of(box.width()) * parts_of(box.height()) > kBoxCells) break;
    SubSolution::Parts parts = dividedPart(*map_, box, region, from_start_, divided);
    parts.places = places;
    parts.goal_tolerance_m = tolerance_m_;
    parts.most_J = most_J;
    const SubSolution solution(parts, octagons_->limits(), left, stop);
    const Proof proof = provenBy(solution, parts);
    const double gap_J = known_J - bound_J;
    bound_J = std::max(bound_J, proof.bound_J);
    left -= std::min(left, solution.work());
    if (most_J < known_J) {
      if (proof.bound_J < (1.0 - kEven) * most_J) break;
      cells *= 2;
    } else {
      if (divided > 1 && !(known_J - bound_J < (1.0 - kLeastDivided) * gap_J)) break;
      divided *= 2;
      next = 4 * solution.work();
    }
  }
  return bound_J;
}

}  // namespace talus::planner
