#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/terramech/mobility/rover_stance.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::DriveCost;
using costmap::DriveCurve;
using costmap::Hazard;
using maps::Cell;

constexpr double kNone = std::numeric_limits<double>::max();
constexpr float kBlocked = std::numeric_limits<float>::infinity();

// Floods from all cells of a queue over their eight neighbours; next(from, to) says whether to go on.
template <typename Next>
void flood(const maps::Grid& grid, std::deque<Cell> open, Next next) {
  for (; !open.empty(); open.pop_front()) {
    const Cell cell = open.front();
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row}) && next(cell, Cell{column, row})) open.push_back({column, row});
  }
}

// A row that ends where the limit along the heading ends it goes on as it ends, uphill and downhill; one that the soil ends does not.
void levelBeyond(float* row, double limit) {
  constexpr int kMiddle = DriveCurve::kBins / 2, kCut = 4;  // nodes: tables end so near to their limit
  const int at_limit = static_cast<int>(limit * DriveCurve::kBinsPerUnit);
  for (const int way : {-1, 1}) {
    int last = 0;
    const auto inside = [&](int k) {
      return kMiddle + way * k >= 0 && kMiddle + way * k < DriveCurve::kBins;
    };
    while (inside(last + 1) && row[kMiddle + way * (last + 1)] < kBlocked) ++last;
    if (last < at_limit || last > at_limit + kCut || !(row[kMiddle] < kBlocked)) continue;
    for (int k = last + 1; inside(k); ++k) row[kMiddle + way * k] = row[kMiddle + way * last];
  }
}

DriveCurve withoutPitch(DriveCurve curve, double limit) {
  levelBeyond(curve.cost_J_per_m.data(), limit);
  if (!curve.crossing) return curve;
  auto rows = std::make_shared<std::vector<float>>(*curve.crossing);
  for (std::size_t row = 0; row < rows->size(); row += DriveCurve::kBins)
    levelBeyond(rows->data() + row, limit);
  curve.crossing = std::move(rows);
  return curve;
}

DriveCurve withoutRoll(DriveCurve curve, double limit) {
  if (!curve.crossing) return curve;
  const auto kept = static_cast<std::size_t>(
      std::min(limit * DriveCurve::kRowsPerUnit, static_cast<double>(curve.lastRow())));
  curve.crossing = std::make_shared<std::vector<float>>(
      curve.crossing->begin(),
      curve.crossing->begin() + static_cast<std::ptrdiff_t>((kept + 1) * DriveCurve::kBins));
  return curve;
}

// Ground of any strength: every node costs as much, but those at which the rover tips.
DriveCurve withoutSoil(const DriveCost::Limits& limits) {
  const int rows =
      limits.stance ? static_cast<int>(std::min(limits.max_across, 1.0) * DriveCurve::kRowsPerUnit) + 2 : 1;
  auto costs = std::make_shared<std::vector<float>>();
  for (int row = 0; row < rows; ++row)
    for (int bin = 0; bin < DriveCurve::kBins; ++bin) {
      const terramech::Gradient gradient{DriveCurve::gradient(bin),
                                         static_cast<double>(row) / DriveCurve::kRowsPerUnit};
      const bool tips = limits.stance && limits.stance->stabilityMargin_rad(demandOf(gradient)) < 0.0;
      costs->push_back(tips ? kBlocked : 1.0F);
    }
  DriveCurve curve;
  std::copy_n(costs->begin(), DriveCurve::kBins, curve.cost_J_per_m.begin());
  if (rows > 1) curve.crossing = std::move(costs);
  return curve;
}

std::shared_ptr<const DriveCost> costWithout(Constraint constraint, const DriveCost& cost) {
  DriveCost::Limits limits = cost.limits();
  std::vector<DriveCurve> curves = cost.curves();
  for (DriveCurve& curve : curves) {
    if (constraint == Constraint::Pitch) curve = withoutPitch(std::move(curve), limits.max_along);
    if (constraint == Constraint::Roll) curve = withoutRoll(std::move(curve), limits.max_across);
    if (constraint == Constraint::Soil) curve = withoutSoil(limits);
  }
  if (constraint == Constraint::Pitch) limits.max_along = kNone;
  if (constraint == Constraint::Roll) limits.max_across = kNone;
  return std::make_shared<const DriveCost>(limits, std::move(curves));
}

}  // namespace

LiftedGround::LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards)
    : map_(map), kinds_(map.grid().size()), ground_(map.grid().size()) {
  for (std::size_t i = 0; i < kinds_.size(); ++i)
    kinds_[i] =
        kindOf({static_cast<int>(i) % map.grid().width, static_cast<int>(i) / map.grid().width}, hazards);
  settleNear();
  findGround();
}

LiftedGround::Kind LiftedGround::kindOf(Cell cell, const HazardsOf& hazards) const {
  const std::uint8_t curve = map_.at(cell).curve();
  if (curve < map_.cost().curves().size()) return Kind::Open;
  if (curve != CellCode::kBlocked) return Kind::Unseen;
  if (!hazards) return Kind::Fixed;
  const Hazard found = hazards(cell);
  if (has(found, Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks)) return Kind::Fixed;
  if (has(found, Hazard::Slope)) return Kind::Steep;
  if (has(found, Hazard::Step | Hazard::Roughness)) return Kind::Fixed;
  return has(found, Hazard::Unknown) ? Kind::Unseen : Kind::Near;
}

// A cell that is kept clear counts to what is nearest: what stands there, unseen ground, or the rim of the map.
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
      if (kinds_[i] != Kind::Open) continue;
      ground_[i] = map_.at({column, row}).curve();
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

bool LiftedGround::isFreed(Constraint constraint, Kind kind) noexcept {
  return (constraint == Constraint::Pitch && kind == Kind::Steep) ||
         (constraint == Constraint::Hazard && (kind == Kind::Fixed || kind == Kind::Near)) ||
         (constraint == Constraint::Unknown && kind == Kind::Unseen);
}

std::shared_ptr<const costmap::CostGrid> LiftedGround::without(Constraint constraint) const {
  const maps::Grid& grid = map_.grid();
  const bool of_cells = constraint == Constraint::Hazard || constraint == Constraint::Unknown;
  if (of_cells && std::ranges::none_of(kinds_, [&](Kind kind) { return isFreed(constraint, kind); }))
    return nullptr;
  return std::make_shared<const costmap::CostGrid>(
      revised(map_, {.ranges = {{{0, 0}, {grid.width - 1, grid.height - 1}}},
                     .code =
                         [&](Cell cell, CellCode code) {
                           const std::size_t i = grid.index(cell);
                           return isFreed(constraint, kinds_[i]) ? code.withCurve(ground_[i]) : code;
                         },
                     .cost = [&] { return costWithout(constraint, map_.cost()); }}));
}

}  // namespace talus::planner
