#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/bound/sub_solution_check.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {
namespace {

constexpr auto kFar = static_cast<float>(kInfinity);
constexpr double kLeastGain =
    0.1;  // smallest share of the gap that a round closes for which another one follows
// Work of level 2: cells fitted in a round, a constant and a share of the cells of the map, and rounds.
constexpr std::size_t kFitted = 100'000, kShare = 10;
constexpr int kFitRounds = 5;
// Work of level 3: cells of its region, and nodes taken and cells checked.
constexpr std::size_t kMeshCells = 60'000, kMeshWork = 3'000'000;

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
    const double most_J = costFor(kFitted + grid.size() / kShare, bound_J, known_J);
    bool stopped = false;
    forEachInside([&](maps::Cell cell, std::size_t at) {
      if ((at & 0xffffU) == 0) stopped = stopped || stop();
      if (stopped) return;
      DirectionalCostBounds::Limits limits;
      if (throughCell_J(cell) > most_J || !octagons_->limits().of(map_->at(cell), limits)) return;
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
  SubSolution::Parts parts{map_, places, tolerance_m_, 0.0, cheapestMetre_J(*map_), from_start_, {}};
  std::size_t work = 0;
  for (std::size_t cells = kMeshCells; bound_J < enough_J && work < kMeshWork; cells *= 2) {
    parts.most_J = costFor(cells, bound_J, known_J);
    parts.region.assign(grid.size(), false);
    forEachInside(
        [&](maps::Cell cell, std::size_t at) { parts.region[at] = throughCell_J(cell) <= parts.most_J; });
    const SubSolution solution(parts, octagons_->limits(), kMeshWork - work, stop);
    work += solution.work();
    const double proven_J = provenBy(solution, parts).bound_J;
    bound_J = std::max(bound_J, proven_J);
    if (parts.most_J >= known_J || proven_J < (1.0 - kEven) * parts.most_J || stop()) break;
  }
  return bound_J;
}

}  // namespace talus::planner
