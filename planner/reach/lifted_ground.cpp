#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <utility>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::planner {

namespace {

using costmap::Hazard;
using maps::Cell;

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameStep_m = 1e-3;  // heights are floats: smaller differences of steps are rounding
constexpr int kAround = 2;            // cells on each side whose rises determine a gradient

Cell operator+(Cell a, Cell b) noexcept {
  return {a.column + b.column, a.row + b.row};
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using costmap::CellCode;
using costmap::TravelCost;
using costmap::TravelCurve;

constexpr double kNone = std::numeric_limits<double>::max();
constexpr float kBlocked = std::numeric_limits<float>::infinity();

// Flood fill from all cells of a queue over eight neighbours; next(from, to) decides on each step.
template <typename Next>
void flood(const maps::Grid& grid, std::deque<Cell> open, Next next) {
  for (; !open.empty(); open.pop_front()) {
    const Cell cell = open.front();
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row}) && next(cell, Cell{column, row})) open.push_back({column, row});
  }
}

// Extends a row beyond the limit along the heading with its last values, uphill and downhill, if the limit
// ends the row; a row that ends earlier because of the soil is not extended.
void levelBeyond(float* row, double limit, double most) {
  constexpr int kMiddle = TravelCurve::kBins / 2, kCut = 4;  // nodes: tables end so near to their limit
  const int at_limit = static_cast<int>(limit * TravelCurve::kBinsPerUnit);
  for (const int way : {-1, 1}) {
    int last = 0;
    const auto inside = [&](int k) {
      return kMiddle + way * k >= 0 && kMiddle + way * k < TravelCurve::kBins &&
             k <= most * TravelCurve::kBinsPerUnit;
    };
    while (inside(last + 1) && row[kMiddle + way * (last + 1)] < kBlocked) ++last;
    if (last < at_limit || last > at_limit + kCut || !(row[kMiddle] < kBlocked)) continue;
    for (int k = last + 1; inside(k); ++k) row[kMiddle + way * k] = row[kMiddle + way * last];
  }
}

TravelCurve withoutPitch(const TravelCurve& curve, double limit, double most) {
  std::vector<float> costs = *curve.costs;
  for (std::size_t row = 0; row < costs.size(); row += TravelCurve::kBins)
    levelBeyond(costs.data() + row, limit, most);
  return TravelCurve(std::move(costs));
}

TravelCurve withoutRoll(const TravelCurve& curve, double limit) {
  const auto kept =
      static_cast<int>(std::min(limit * TravelCurve::kRowsPerUnit, static_cast<double>(curve.lastRow())));
  return TravelCurve({curve.rows(), curve.rows() + (kept + 1) * TravelCurve::kBins});
}

// Curve of ground with unlimited strength: equal cost at all nodes except those at which the rover tips.
TravelCurve withoutSoil(const TravelCost::Limits& limits) {
  const int rows =
      limits.stance ? static_cast<int>(std::min(limits.max_across, 1.0) * TravelCurve::kRowsPerUnit) + 2 : 1;
  std::vector<float> costs;
  for (int row = 0; row < rows; ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      const terramech::Gradient gradient{TravelCurve::gradient(bin),
                                         static_cast<double>(row) / TravelCurve::kRowsPerUnit};
      const bool tips = limits.stance && limits.stance->stabilityMargin_rad(demandOf(gradient)) < 0.0;
      costs.push_back(tips ? kBlocked : 1.0F);
    }
  return TravelCurve(std::move(costs));
}

// Returns the gradient at which the slope requires the complete pull that the soil provides at the limit;
// unlimited if the cost has no states.
double soilHoldsTo(const TravelCost& cost, std::size_t curve) {
  if (curve >= cost.states().size() || !cost.states()[curve]) return kNone;
  const int at = std::clamp(
      TravelCurve::kBins / 2 + static_cast<int>(cost.limits().max_along * TravelCurve::kBinsPerUnit), 0,
      TravelCurve::kBins - 1);
  const auto margin = static_cast<double>(cost.states()[curve]->at(0, at).pull_margin);
  return std::isfinite(margin) ? cost.limits().max_along + std::max(margin, 0.0) : kNone;
}

std::shared_ptr<const TravelCost> costWithout(Constraint constraint, const TravelCost& cost) {
  TravelCost::Limits limits = cost.limits();
  std::vector<TravelCurve> curves = cost.curves();
  for (std::size_t k = 0; k < curves.size(); ++k) {
    TravelCurve& curve = curves[k];
    if (constraint == Constraint::Pitch) curve = withoutPitch(curve, limits.max_along, soilHoldsTo(cost, k));
    if (constraint == Constraint::Roll) curve = withoutRoll(curve, limits.max_across);
    if (constraint == Constraint::Soil) curve = withoutSoil(limits);
    if (constraint == Constraint::Slope) curve = withoutSoil({.stance = limits.stance});
  }
  if (constraint == Constraint::Pitch || constraint == Constraint::Slope) limits.max_along = kNone;
  if (constraint == Constraint::Roll || constraint == Constraint::Slope) limits.max_across = kNone;
  return std::make_shared<const TravelCost>(limits, std::move(curves));
}

}  // namespace

StepEdges::StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses)
    : map_(map), kinds_(map.grid().size(), Kind::None) {
  if (!hazards || map.content().elevation_m.size() == 0) return;
  const double allowed_m = highestAllowed_m(hazards) + kSameStep_m;
  std::vector<Cell> sheer, of_slopes;
  forEachPair([&](const Pair& pair) {
    const double step_m = pair.step_m();
    if (!(step_m > allowed_m)) return;
    const double steepest_m = std::max({std::abs(pair.before), std::abs(pair.between), std::abs(pair.after)});
    const bool is_sheer = pair.excess_m() > std::max(allowed_m, 0.5 * step_m);
    if (!is_sheer && !refuses(pair.first, steepest_m / map.grid().resolution_m)) return;
    std::vector<Cell>& ends = is_sheer ? sheer : of_slopes;
    ends.push_back(pair.first);
    ends.push_back(pair.second);
  });
  spread(hazards, sheer, of_slopes);
}

double StepEdges::highestAllowed_m(const HazardsOf& hazards) const {
  double allowed_m = 0.0;
  forEachPair([&](const Pair& pair) {
    const double step_m = pair.step_m();
    if (!(step_m > allowed_m)) return;
    const Hazard first = hazards(pair.first), second = hazards(pair.second);
    if (has(first | second, Hazard::Unknown)) return;
    if (!has(first, Hazard::Step) || !has(second, Hazard::Step)) allowed_m = step_m;
  });
  return allowed_m;
}

double StepEdges::Pair::step_m() const noexcept {
  const double shared =
      before * after > 0.0 ? std::copysign(std::min(std::abs(before), std::abs(after)), before) : 0.0;
  return std::abs(between - shared);
}

double StepEdges::Pair::excess_m() const noexcept {
  const double way = std::copysign(1.0, between);
  return std::abs(between) - std::max({way * before, way * after, 0.0});
}

double StepEdges::height_m(Cell cell) const noexcept {
  if (!map_.grid().contains(cell)) return kNoHeight;
  const auto tile = static_cast<std::size_t>((cell.row >> 6) * map_.tileColumns() + (cell.column >> 6));
  return static_cast<double>(map_.content().elevation_m.tile(tile).cells[static_cast<std::size_t>(
      (cell.row & 63) << 6 | (cell.column & 63))]);
}

// A missing height on one side is replaced by the rise on the other side.
std::optional<StepEdges::Pair> StepEdges::pair(Cell cell, Cell step) const noexcept {
  const Cell next = cell + step, back{-step.column, -step.row};
  const double here_m = height_m(cell), there_m = height_m(next);
  if (std::isnan(here_m) || std::isnan(there_m)) return std::nullopt;
  double before = here_m - height_m(cell + back), after = height_m(next + step) - there_m;
  if (std::isnan(before)) before = std::isnan(after) ? 0.0 : after;
  if (std::isnan(after)) after = before;
  return Pair{cell, next, before, there_m - here_m, after};
}

template <typename Take>
void StepEdges::forEachPair(Take take) const {
  for (int row = 0; row < map_.grid().height; ++row)
    for (int column = 0; column < map_.grid().width; ++column)
      for (const Cell step : {Cell{1, 0}, Cell{0, 1}})
        if (const auto found = pair({column, row}, step)) take(*found);
}

void StepEdges::spread(const HazardsOf& hazards, const std::vector<Cell>& sheer,
                       const std::vector<Cell>& of_slopes) {
  const maps::Grid& grid = map_.grid();
  std::deque<Cell> open;
  const auto take = [&](Cell cell, Kind kind) {
    Kind& own = kinds_[grid.index(cell)];
    if (own != Kind::None || !has(hazards(cell), Hazard::Step | Hazard::Roughness)) return;
    own = kind;
    open.push_back(cell);
  };
  for (const Cell cell : sheer) take(cell, Kind::Sheer);
  for (const Cell cell : of_slopes) take(cell, Kind::Slope);
  for (; !open.empty(); open.pop_front()) {
    const Cell cell = open.front();
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row})) take({column, row}, kinds_[grid.index(cell)]);
  }
}

costmap::CellCode StepEdges::settled(Cell cell) const {
  std::vector<double> east, north;
  for (int row = -kAround; row <= kAround; ++row)
    for (int column = -kAround; column <= kAround; ++column) {
      const Cell from = cell + Cell{column, row};
      const double here_m = height_m(from);
      const double east_m = column < kAround ? height_m(from + Cell{1, 0}) - here_m : kNoHeight;
      const double north_m = row < kAround ? height_m(from + Cell{0, 1}) - here_m : kNoHeight;
      if (!std::isnan(east_m)) east.push_back(east_m);
      if (!std::isnan(north_m)) north.push_back(north_m);
    }
  if (east.empty() || north.empty()) return map_.at(cell);
  return costmap::CellCode({.dz_dx = median(east) / map_.grid().resolution_m,
                            .dz_dy = median(north) / map_.grid().resolution_m,
                            .curve = map_.at(cell).curve()});
}

LiftedGround::LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards, bool across)
    : map_(map),
      across_(across),
      kinds_(map.grid().size()),
      solid_(map.grid().size(), Hazard::None),
      ground_(map.grid().size()) {
  findGround();
  edges_.emplace(map, hazards, [this](Cell cell, double gradient) { return refuses(cell, gradient); });
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const Cell cell{static_cast<int>(i) % map.grid().width, static_cast<int>(i) / map.grid().width};
    kinds_[i] = kindOf(cell, hazards);
    if (kinds_[i] == Kind::Fixed && hazards) solid_[i] = solidOf(cell, hazards);
  }
  settleNear();
}

LiftedGround::Kind LiftedGround::kindOf(Cell cell, const HazardsOf& hazards) const {
  const CellCode::Curve curve = map_.at(cell).curve();
  if (curve < map_.cost().curves().size()) return Kind::Open;
  if (curve != CellCode::kBlocked) return Kind::Unseen;
  if (!hazards) return Kind::Fixed;
  const Hazard found = hazards(cell);
  if (has(found, Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks)) return Kind::Fixed;
  if (edges_->at(cell) == StepEdges::Kind::Sheer) return Kind::Fixed;
  if (has(found, Hazard::Slope) || edges_->at(cell) == StepEdges::Kind::Slope) return Kind::Steep;
  if (has(found, Hazard::Step | Hazard::Roughness)) return Kind::Fixed;
  return has(found, Hazard::Unknown) ? Kind::Unseen : Kind::Near;
}

// The roughness at a sheer step is attributed to the step.
Hazard LiftedGround::solidOf(Cell cell, const HazardsOf& hazards) const {
  const auto found =
      static_cast<Hazard>(static_cast<std::uint8_t>(hazards(cell)) & static_cast<std::uint8_t>(kSolid));
  if (edges_->at(cell) != StepEdges::Kind::Sheer) return found;
  constexpr Hazard kDeclared = Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks;
  return static_cast<Hazard>(static_cast<std::uint8_t>(found) & static_cast<std::uint8_t>(kDeclared)) |
         Hazard::Step;
}

bool LiftedGround::isSteep(CellCode code) const noexcept {
  const TravelCost::Limits& limits = map_.cost().limits();
  return std::hypot(code.dzDx(), code.dzDy()) > std::hypot(limits.max_along, limits.max_across);
}

bool LiftedGround::refuses(Cell cell, double gradient) const noexcept {
  const TravelCost::Limits& limits = map_.cost().limits();
  if (gradient > std::min(limits.max_along, limits.max_across)) return true;
  const CellCode::Curve ground = ground_[map_.grid().index(cell)];
  if (ground >= map_.cost().curves().size()) return false;
  const TravelCurve& curve = map_.cost().curves()[ground];
  return !(curve.price(gradient, 0.0) < kBlocked) || !(curve.price(-gradient, 0.0) < kBlocked);
}

// Assigns each cell of a clearance to the nearest cause: an obstacle, unobserved ground, or the rim of the
// map.
void LiftedGround::settleNear() {
  const maps::Grid& grid = map_.grid();
  std::deque<Cell> sources;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      Kind& kind = kinds_[grid.index({column, row})];
      const bool rim = row == 0 || column == 0 || row == grid.height - 1 || column == grid.width - 1;
      if (kind == Kind::Near && rim) kind = Kind::Rim;
      if (kind != Kind::Open && kind != Kind::Near && kind != Kind::Steep) sources.push_back({column, row});
    }
  flood(grid, std::move(sources), [&](Cell from, Cell to) {
    Kind& kind = kinds_[grid.index(to)];
    if (kind != Kind::Near) return false;
    kind = kinds_[grid.index(from)];
    solid_[grid.index(to)] = solid_[grid.index(from)];
    return true;
  });
}

void LiftedGround::findGround() {
  const maps::Grid& grid = map_.grid();
  std::deque<Cell> sources;
  std::vector<bool> known(grid.size());
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const std::size_t i = grid.index({column, row});
      const CellCode::Curve curve = map_.at({column, row}).curve();
      if (curve >= map_.cost().curves().size()) continue;
      ground_[i] = curve;
      known[i] = true;
      sources.push_back({column, row});
    }
  flood(grid, std::move(sources), [&](Cell from, Cell to) {
    const std::size_t i = grid.index(to);
    if (known[i]) return false;
    known[i] = true;
    ground_[i] = ground_[grid.index(from)];
    return true;
  });
}

bool LiftedGround::isFreed(Constraint constraint, Hazard kinds, std::size_t cell) const noexcept {
  const Kind kind = kinds_[cell];
  switch (constraint) {
    case Constraint::Roll:
      return across_ && kind == Kind::Steep;
    case Constraint::Pitch:
    case Constraint::Slope:
      return kind == Kind::Steep;
    case Constraint::Hazard:
      return (kind == Kind::Fixed || kind == Kind::Near) &&
             (static_cast<std::uint8_t>(solid_[cell]) & ~static_cast<unsigned>(kinds)) == 0U;
    case Constraint::Unknown:
      return kind == Kind::Unseen;
    case Constraint::Rim:
      return kind == Kind::Rim;
    case Constraint::Soil:
      return false;
  }
  return false;
}

std::shared_ptr<const costmap::CostGrid> LiftedGround::without(Constraint constraint, Hazard kinds,
                                                               std::optional<Constraint> also) const {
  const maps::Grid& grid = map_.grid();
  const auto ofCells = [](Constraint c) {
    return c == Constraint::Hazard || c == Constraint::Unknown || c == Constraint::Rim;
  };
  for (const Constraint each : {constraint, also.value_or(constraint)}) {
    bool any = !ofCells(each);
    for (std::size_t i = 0; i < kinds_.size() && !any; ++i) any = isFreed(each, kinds, i);
    if (!any) return nullptr;
  }
  const auto freed = [&](Cell cell, CellCode code) {
    const std::size_t i = grid.index(cell);
    if (!isFreed(constraint, kinds, i) && !(also && isFreed(*also, kinds, i))) return code;
    if (edges_->at(cell) == StepEdges::Kind::Sheer) code = edges_->settled(cell);
    const bool climbs = also == Constraint::Slope || also == Constraint::Pitch;
    const bool stays =
        constraint == Constraint::Hazard && !climbs && has(solid_[i], Hazard::Step) && isSteep(code);
    return stays ? code : code.withCurve(ground_[i]);
  };
  return std::make_shared<const costmap::CostGrid>(
      revised(map_, {.ranges = {{{0, 0}, {grid.width - 1, grid.height - 1}}}, .code = freed, .cost = [&] {
                       return costWithout(also && !ofCells(*also) ? *also : constraint, map_.cost());
                     }}));
}

bool slopesAcross(const costmap::CostGrid& map, const Segment& line) {
  const double dx = line.to.x_m - line.from.x_m, dy = line.to.y_m - line.from.y_m,
               length_m = std::hypot(dx, dy);
  if (!(length_m > 0.0)) return false;
  const int pieces = 1 + static_cast<int>(length_m / map.grid().resolution_m);
  double along = 0.0, across = 0.0;
  for (int k = 0; k <= pieces; ++k) {
    const double share = static_cast<double>(k) / pieces;
    const auto cell = map.grid().cellAt({line.from.x_m + share * dx, line.from.y_m + share * dy});
    if (!cell) continue;
    const CellCode code = map.at(*cell);
    along += std::abs(code.dzDx() * dx + code.dzDy() * dy);
    across += std::abs(code.dzDy() * dx - code.dzDx() * dy);
  }
  return across > along;
}

namespace {

using maps::Point;

// The cells of two sets with the fewest king's moves between them, by a flood fill from the first set over
// the whole map; nothing if a set is empty or after a stop.
std::optional<std::pair<Cell, Cell>> closest(const maps::Grid& grid, const Reach& from, const Reach& to,
                                             const StopCheck& stop) {
  constexpr std::uint32_t kNoOrigin = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> origin(grid.size(), kNoOrigin);
  std::deque<Cell> open;
  for (int row = 0; row < grid.height; ++row) {
    if ((row & 63) == 0 && stop()) return std::nullopt;
    for (int column = 0; column < grid.width; ++column)
      if (from.holds({column, row})) {
        origin[grid.index({column, row})] = static_cast<std::uint32_t>(grid.index({column, row}));
        open.push_back({column, row});
      }
  }
  for (std::size_t steps = 1; !open.empty(); ++steps) {
    if ((steps & 0xffffU) == 0 && stop()) return std::nullopt;
    const Cell cell = open.front();
    open.pop_front();
    const std::uint32_t begun = origin[grid.index(cell)];
    const auto width = static_cast<std::uint32_t>(grid.width);
    if (to.holds(cell)) return {{{static_cast<int>(begun % width), static_cast<int>(begun / width)}, cell}};
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row}) && origin[grid.index({column, row})] == kNoOrigin) {
          origin[grid.index({column, row})] = begun;
          open.push_back({column, row});
        }
  }
  return std::nullopt;
}

std::string text(Point p) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, "%.2f,%.2f", p.x_m, p.y_m);
  return buffer;
}

const char* remedy(Hazard hazard, bool stated) noexcept {
  if (stated && hazard == Hazard::Obstacle)
    return "cells of infinite cost close every way: choose another goal";
  switch (hazard) {
    case Hazard::KeepOut:
      return "keep-out areas, or cells that a layer refuses, and their clearance close every way: reduce "
             "them, or choose "
             "another goal";
    case Hazard::Obstacle:
      return "terrain classes declared impassable and their clearance close every way: check the classes, or "
             "choose "
             "another goal";
    case Hazard::Rocks:
      return "rocks (the layer of their abundance) and their clearance close every way: observe them, or "
             "choose another "
             "goal";
    case Hazard::Step:
      return "steps higher than the wheels climb and their clearance close every way: choose another goal";
    default:
      return "ground too rough for the rover's belly and its clearance close every way: choose another goal";
  }
}

bool ofSlope(Constraint constraint) noexcept {
  return constraint == Constraint::Pitch || constraint == Constraint::Roll ||
         constraint == Constraint::Slope || constraint == Constraint::Soil;
}

const char* remedy(Constraint constraint, bool stated) noexcept {
  if (stated && ofSlope(constraint))
    return "gradients without a finite stated cost close every way: state their costs, or choose another "
           "goal";
  switch (constraint) {
    case Constraint::Pitch:
      return "the pitch limit closes every way: raise max_pitch_rad, or choose another goal";
    case Constraint::Roll:
      return "the roll limit closes every way: raise max_roll_rad, or choose another goal";
    case Constraint::Soil:
      return "soil closes every way: measure the ground there, or choose another goal";
    case Constraint::Hazard:
      return "hazards, keep-out areas and their clearance close every way: reduce them, or choose another "
             "goal";
    case Constraint::Unknown:
      return "unobserved ground closes every way: observe it, or choose another goal";
    case Constraint::Rim:
      return "the rim of the map closes every way, from which the rover keeps half its width: use a larger "
             "map";
    case Constraint::Slope:
      return "slopes close every way, which both the rover's limits and the soil refuse: choose another goal";
  }
  return "";
}

const char* what(Hazard hazard, bool stated) noexcept {
  if (stated && hazard == Hazard::Obstacle) return "cells of infinite cost";
  switch (hazard) {
    case Hazard::KeepOut:
      return "keep-out areas";
    case Hazard::Obstacle:
      return "impassable classes";
    case Hazard::Rocks:
      return "rocks";
    case Hazard::Step:
      return "steps";
    default:
      return "rough ground";
  }
}

const char* what(Constraint constraint, bool stated) noexcept {
  if (stated && ofSlope(constraint)) return "gradients without a finite stated cost";
  constexpr const char* kWhat[] = {"the pitch limit",   "the roll limit",     "soil",  "hazards",
                                   "unobserved ground", "the rim of the map", "slopes"};
  return kWhat[static_cast<std::size_t>(constraint)];
}

// Function that returns true if `map` connects start and goal.
using OpensOn = std::function<bool(const costmap::CostGrid& map)>;

// Tests which constraint causes the obstruction `found`, and stores it in `found`. The two sets of cells of
// `found` must be known. After a stop, or on maps with more than kTriedCells cells, no constraint is tested.
void tryLifting(Obstruction& found, const costmap::CostGrid& map, const HazardsOf& hazards,
                const OpensOn& opens, const StopCheck& stop) {
  found.stated = map.cost().limits().stated;
  if (stop() || map.grid().size() > kTriedCells) return;
  const LiftedGround ground(map, hazards, slopesAcross(map, {found.last, found.first}));
  const auto opensWithout = [&](Constraint constraint, Hazard kinds = LiftedGround::kSolid,
                                std::optional<Constraint> also = {}) {
    if (stop()) return false;
    const auto lifted = ground.without(constraint, kinds, also);
    return lifted && opens(*lifted);
  };
  for (const Constraint constraint :
       {Constraint::Unknown, Constraint::Hazard, Constraint::Soil, Constraint::Pitch, Constraint::Roll,
        Constraint::Rim, Constraint::Slope})
    if (!found.lifting && opensWithout(constraint)) found.lifting = constraint;
  // Kinds of hazards, alone or together with another constraint.
  const auto findKind = [&] {
    if (found.lifting != Constraint::Hazard || !hazards) return;
    for (const Hazard kind :
         {Hazard::KeepOut, Hazard::Obstacle, Hazard::Rocks, Hazard::Step, Hazard::Roughness})
      if (!found.hazard && opensWithout(Constraint::Hazard, kind, found.also)) found.hazard = kind;
  };
  findKind();
  // The least set of two: slopes are tried as a whole before their parts.
  for (const Constraint first : {Constraint::Hazard, Constraint::Unknown, Constraint::Rim})
    for (const Constraint second : {Constraint::Slope, Constraint::Unknown, Constraint::Rim}) {
      if (found.lifting || first == second || (first == Constraint::Rim && second == Constraint::Unknown))
        continue;
      if (!opensWithout(first, LiftedGround::kSolid, second)) continue;
      found.lifting = first;
      found.also = second;
      for (const Constraint part : {Constraint::Soil, Constraint::Pitch, Constraint::Roll})
        if (found.also == Constraint::Slope && opensWithout(first, LiftedGround::kSolid, part))
          found.also = part;
      findKind();
    }
  found.tried = !stop();
}

}  // namespace

Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards,
                               const StopCheck& stop) {
  Obstruction found{.last = places.from, .first = places.to};
  found.cells_from_start = from_start.cells();
  const Reach to_goal(map, headings, Reach::Sense::To, places.to, tolerance_m, stop);
  found.cells_to_goal = to_goal.cells();
  // Each reach may be too wide, so that one alone decides.
  const bool apart = !from_start.reaches(places.to, tolerance_m);
  const bool backwards = !apart || to_goal.cells() < from_start.cells();
  auto gap = backwards ? closest(map.grid(), to_goal, from_start, stop)
                       : closest(map.grid(), from_start, to_goal, stop);
  if (gap) {
    if (backwards) std::swap(gap->first, gap->second);
    found.last = map.grid().centre(gap->first);
    found.first = map.grid().centre(gap->second);
  }
  // Searches from the side with fewer cells, until the search meets the other side.
  const auto opens = [&](const costmap::CostGrid& lifted) {
    HeadingSets free(lifted.cost());
    Reach reach = backwards ? Reach(lifted, free, Reach::Sense::To, places.to, tolerance_m, stop,
                                    apart ? &from_start : nullptr)
                            : Reach(lifted, free, Reach::Sense::From, places.from, 0.0, stop, &to_goal);
    if (reach.joined()) return true;
    return reach.complete() &&
           (backwards ? reach.reaches(places.from, 0.0) : reach.reaches(places.to, tolerance_m));
  };
  tryLifting(found, map, hazards, opens, stop);
  return found;
}

std::string text(const Obstruction& obstruction, const Segment& places) {
  const double apart_m =
      std::hypot(obstruction.last.x_m - obstruction.first.x_m, obstruction.last.y_m - obstruction.first.y_m);
  char apart[64];
  std::snprintf(apart, sizeof apart, " (%.1f m apart)", apart_m);
  const std::string where =
      apart_m > 0.0
          ? "closest at " + text(obstruction.last) + " and " + text(obstruction.first) + apart
          : "both touch the cell at " + text(obstruction.last) + ", through which no heading leads on";
  std::string line = "no route from " + text(places.from) + " to " + text(places.to) +
                     ", whatever the headings: " + std::to_string(obstruction.cells_from_start) +
                     " cells are reachable from the start, " + std::to_string(obstruction.cells_to_goal) +
                     " lead to the goal; " + where;
  const bool stated = obstruction.stated;
  if (obstruction.also)
    return line + "; " +
           (obstruction.hazard ? what(*obstruction.hazard, stated) : what(*obstruction.lifting, stated)) +
           " and " + what(*obstruction.also, stated) +
           " close every way together, neither alone: change both, or choose another goal";
  if (obstruction.hazard) return line + "; " + remedy(*obstruction.hazard, stated);
  if (obstruction.lifting) return line + "; " + remedy(*obstruction.lifting, stated);
  return line + (obstruction.tried ? "; more than two constraints close every way: choose another goal"
                                   : "; choose another goal");
}

}  // namespace talus::planner
