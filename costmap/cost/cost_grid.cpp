#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::costmap {

namespace {

int tilesAcross(int cells) {
  return (cells + CostTile::kSide - 1) / CostTile::kSide;
}

template <typename T>
std::shared_ptr<const Tile<T>> cutTile(const maps::Raster<T>& cells, maps::Cell first) {
  auto tile = std::make_shared<Tile<T>>();
  for (int r = 0; r < CostTile::kSide; ++r)
    for (int c = 0; c < CostTile::kSide; ++c) {
      const maps::Cell cell{first.column + c, first.row + r};
      if (cells.grid().contains(cell))
        tile->cells[static_cast<std::size_t>(r * CostTile::kSide + c)] = cells[cell];
    }
  return tile;
}

template <typename T>
SharedTiles<T> cut(const maps::Raster<T>& cells) {
  std::vector<typename SharedTiles<T>::Shared> tiles;
  for (int row = 0; row < cells.grid().height; row += CostTile::kSide)
    for (int column = 0; column < cells.grid().width; column += CostTile::kSide)
      tiles.push_back(cutTile(cells, {column, row}));
  return SharedTiles<T>(tiles);
}

}  // namespace

template <typename T>
SharedTiles<T>::SharedTiles(std::size_t tiles, const Shared& each)
    : SharedTiles(std::vector<Shared>(tiles, each)) {}

template <typename T>
SharedTiles<T>::SharedTiles(const std::vector<Shared>& tiles) {
  for (std::size_t first = 0; first < tiles.size(); first += kPage) {
    auto page = std::make_shared<Page>();
    for (std::size_t i = first; i < std::min(first + kPage, tiles.size()); ++i) {
      (*page)[i - first] = tiles[i];
      raw_.push_back(tiles[i].get());
    }
    pages_.push_back(std::move(page));
  }
}

template <typename T>
void SharedTiles<T>::set(std::size_t i, Shared tile) {
  auto page = std::make_shared<Page>(*pages_[i / kPage]);
  raw_[i] = tile.get();
  (*page)[i % kPage] = std::move(tile);
  pages_[i / kPage] = std::move(page);
}

template class SharedTiles<CellCode>;
template class SharedTiles<float>;

HeightTable tiled(const maps::Raster<float>& elevation_m) {
  return cut(elevation_m);
}

HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box) {
  const int columns = tilesAcross(elevation_m.grid().width);
  for (int row = box.first.row >> 6; row <= box.last.row >> 6; ++row)
    for (int column = box.first.column >> 6; column <= box.last.column >> 6; ++column)
      table.set(static_cast<std::size_t>(row * columns + column),
                cutTile(elevation_m, {column << 6, row << 6}));
  return table;
}

CostGrid::CostGrid(Content content)
    : content_(std::move(content)), tile_columns_(tilesAcross(content_.grid.width)) {
  const auto expected =
      static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tilesAcross(content_.grid.height));
  if (content_.tiles.size() != expected)
    throw std::invalid_argument("CostGrid: " + std::to_string(content_.tiles.size()) + " tiles, must be " +
                                std::to_string(expected));
  if (!content_.cost) throw std::invalid_argument("CostGrid: no cost function");
  if (const std::size_t heights = content_.elevation_m.size(); heights != 0 && heights != expected)
    throw std::invalid_argument("CostGrid: " + std::to_string(heights) +
                                " tiles of elevation, must be 0 or " + std::to_string(expected));
}

std::optional<double> CostGrid::elevation_m(maps::Point point) const {
  if (content_.elevation_m.size() == 0) return std::nullopt;
  return maps::elevationAt(content_.grid, point, [&](maps::Cell c) {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.elevation_m.tile(tile)
        .cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  });
}

CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const TravelCost> cost) {
  return CostGrid({.grid = cells.grid(), .tiles = cut(cells), .cost = std::move(cost), .version = 1});
}

CostGrid revised(const CostGrid& grid, const Revision& revision) {
  CostGrid::Content next = grid.content();
  std::vector<std::pair<std::size_t, std::shared_ptr<CostTile>>> copies;
  const auto writable = [&](std::size_t slot) -> CostTile& {
    const auto known =
        std::find_if(copies.begin(), copies.end(), [&](const auto& copy) { return copy.first == slot; });
    if (known != copies.end()) return *known->second;
    copies.emplace_back(slot, std::make_shared<CostTile>(*next.tiles[slot]));
    next.tiles.set(slot, copies.back().second);
    return *copies.back().second;
  };
  for (const maps::CellBox& range : revision.ranges)
    for (int tile_row = range.first.row >> 6; tile_row <= range.last.row >> 6; ++tile_row)
      for (int tile_column = range.first.column >> 6; tile_column <= range.last.column >> 6; ++tile_column) {
        CostTile& tile = writable(static_cast<std::size_t>(tile_row * grid.tileColumns() + tile_column));
        for (int row = std::max(range.first.row, tile_row << 6);
             row <= std::min(range.last.row, tile_row << 6 | 63); ++row)
          for (int column = std::max(range.first.column, tile_column << 6);
               column <= std::min(range.last.column, tile_column << 6 | 63); ++column) {
            CellCode& code = tile.cells[static_cast<std::size_t>((row & 63) << 6 | (column & 63))];
            code = revision.code({column, row}, code);
          }
      }
  next.cost = revision.cost();
  if (revision.elevation_m) next.elevation_m = *revision.elevation_m;
  ++next.version;
  return CostGrid(std::move(next));
}

std::int16_t CellCode::quantised(double gradient) noexcept {
  const double steps = std::clamp(std::round(gradient / kStep), -2048.0, 2047.0);
  return static_cast<std::int16_t>(std::isnan(steps) ? 0.0 : steps);
}

int TravelCurve::bin(double gradient) noexcept {
  return static_cast<int>(std::lround(gradient * kBinsPerUnit)) + kBins / 2;
}

namespace {

std::vector<TravelCurve> curvesOf(const std::vector<GroundCost>& grounds) {
  std::vector<TravelCurve> curves;
  for (const GroundCost& ground : grounds) curves.push_back(ground.curve);
  return curves;
}

// Gradient up to which no heading tips: tan(stability margin on level ground).
double steadyGradient(const terramech::RoverStance* stance) {
  const double margin_rad = stance ? stance->stabilityMargin_rad({}) : kInfinity;
  return margin_rad < 0.5 * std::numbers::pi ? std::tan(margin_rad) : kInfinity;
}

}  // namespace

TravelCost::TravelCost(const Limits& limits, std::vector<TravelCurve> curves)
    : limits_(limits),
      curves_(std::move(curves)),
      states_(curves_.size()),
      turns_(curves_.size()),
      steady_gradient_(steadyGradient(limits.stance.get())) {
  if (curves_.size() > CellCode::kUnknown)
    throw std::invalid_argument("DriveCost: " + std::to_string(curves_.size()) +
                                " drive curves, must be <= 65534");
}

TravelCost::TravelCost(const Limits& limits, const std::vector<GroundCost>& grounds,
                       SoilUncertainty uncertainty, const CostWeights& weights)
    : TravelCost(limits, curvesOf(grounds)) {
  uncertainty_ = std::move(uncertainty);
  weights_ = weights;
  for (std::size_t i = 0; i < grounds.size(); ++i) {
    states_[i] = grounds[i].states;
    turns_[i] = grounds[i].turns;
  }
}

float TravelCost::costPerMetre(CellCode cell, Direction heading) const noexcept {
  constexpr float blocked = std::numeric_limits<float>::infinity();
  if (cell.curve() >= curves_.size()) return blocked;
  const terramech::Gradient d = gradientOf(cell, heading);
  if (std::abs(d.along) > limits_.max_along || std::abs(d.across) > limits_.max_across) return blocked;
  return curves_[cell.curve()].price(d.along, d.across);
}

bool TravelCost::tips(CellCode cell, Direction heading) const noexcept {
  return mayTip(cell) && limits_.stance->stabilityMargin_rad(demandOf(gradientOf(cell, heading))) < 0.0;
}

bool TravelCost::mayTip(CellCode cell) const noexcept {
  return cell.dzDx() * cell.dzDx() + cell.dzDy() * cell.dzDy() > steady_gradient_ * steady_gradient_;
}

namespace {

TravelState refused(Refusal reason) noexcept {
  TravelState state;
  state.refusal = reason;
  return state;
}

}  // namespace

TravelState TravelCost::detail(CellCode cell, Direction heading) const noexcept {
  if (cell.curve() == CellCode::kBlocked) return refused(Refusal::Blocked);
  if (cell.curve() >= curves_.size()) return refused(Refusal::Unknown);
  const terramech::Gradient d = gradientOf(cell, heading);
  const double place = d.along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2;
  const TravelStates* states = statesOf(cell);
  TravelState state = states ? states->state(d) : TravelState{};
  if (std::abs(d.across) > limits_.max_across)
    state.refusal = limits_.stated ? Refusal::Stated : Refusal::Roll;
  if (std::abs(d.along) > limits_.max_along || !(place >= 0.0 && place < TravelCurve::kLastPlace))
    state.refusal = limits_.stated ? Refusal::Stated : Refusal::Pitch;
  return state;
}

TravelForecast TravelCost::forecast(CellCode cell, Direction heading) const noexcept {
  const TravelStates* states = statesOf(cell);
  return states ? states->forecast(gradientOf(cell, heading)) : TravelForecast{};
}

double TravelCost::climb(CellCode cell, Direction heading) const noexcept {
  const terramech::Gradient d = gradientOf(cell, heading);
  const TravelStates* states = statesOf(cell);
  return states ? states->climb(d) : d.along;
}

const char* toText(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::None:
      return "allowed";
    case Refusal::Unknown:
      return "unobserved cell";
    case Refusal::Blocked:
      return "blocked for any heading";
    case Refusal::Pitch:
      return "slope along the heading above the pitch limit";
    case Refusal::Roll:
      return "slope across the heading above the roll limit";
    case Refusal::Pull:
      return "required drawbar pull above the available drawbar pull";
    case Refusal::SideForce:
      return "required side force above the available side force";
    case Refusal::Torque:
      return "required torque above the motor limit";
    case Refusal::Sinkage:
      return "sinkage above the ground clearance";
    case Refusal::Category:
      return "category at this slope excluded by the policy";
    case Refusal::Tips:
      return "tips: centre of mass past the wheels";
    case Refusal::Stated:
      return "no finite cost is stated for this gradient";
  }
  return "";
}

TravelState worse(const TravelState& a, const TravelState& b) noexcept {
  TravelState out = a;
  for (float TravelState::*const of : {&TravelState::slip, &TravelState::torque_Nm})
    if (std::abs(a.*of) < std::abs(b.*of)) out.*of = b.*of;
  for (float TravelState::*const of :
       {&TravelState::sinkage_m, &TravelState::energy_J_per_m, &TravelState::time_s_per_m,
        &TravelState::risk_per_m, &TravelState::weak})
    out.*of = std::max(a.*of, b.*of);
  out.pull_margin = std::min(a.pull_margin, b.pull_margin);
  out.category = std::max(a.category, b.category);
  if (a.refusal == Refusal::None) out.refusal = b.refusal;
  return out;
}

TravelState TravelStates::state(const terramech::Gradient& gradient) const {
  constexpr std::array kNumbers{&TravelState::slip,
                                &TravelState::sinkage_m,
                                &TravelState::torque_Nm,
                                &TravelState::energy_J_per_m,
                                &TravelState::time_s_per_m,
                                &TravelState::risk_per_m,
                                &TravelState::weak,
                                &TravelState::pull_margin,
                                &TravelState::slip_angle_rad,
                                &TravelState::side_force_over_load,
                                &TravelState::stability_margin_rad};
  std::optional<TravelState> out;
  TravelCurve::forNodesAround(gradient, [&](int row, int bin, double weight) {
    const TravelState node = at(row, bin);
    if (!out) {
      out = node;
      for (const auto number : kNumbers) (*out).*number = 0.0F;
    }
    for (const auto number : kNumbers) (*out).*number += static_cast<float>(weight) * node.*number;
    out->category = std::max(out->category, node.category);
    if (out->refusal == Refusal::None || node.refusal == Refusal::Tips) out->refusal = node.refusal;
  });
  out->slip_angle_rad = std::copysign(out->slip_angle_rad, static_cast<float>(0.0 - gradient.across));
  return *out;
}

// A quantity without a weight may be unknown.
TravelCurve TravelStates::curve(const CostWeights& weights) const {
  const std::array<double, 3> weight{weights.energy, weights.time_W, weights.risk_J};
  std::vector<float> costs;
  for (const Terms& terms : this->terms()) {
    double cost = terms[0] < std::numeric_limits<float>::infinity() ? 0.0 : kInfinity;
    for (std::size_t k = 0; k < terms.size(); ++k)
      if (weight[k] > 0.0) cost += weight[k] * static_cast<double>(terms[k]);
    costs.push_back(static_cast<float>(cost));
  }
  return TravelCurve(std::move(costs));
}

}  // namespace talus::costmap
