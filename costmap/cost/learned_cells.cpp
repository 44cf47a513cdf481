#include <stdexcept>

#include <talus/costmap/cost/learned_cells.hpp>

namespace talus::costmap {

std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights) {
  if (!(weights.energy >= 0 && weights.time_W >= 0 && weights.risk_J >= 0))
    throw std::invalid_argument("cost weights: energy, time_W and risk_J must be >= 0");
  std::vector<GroundCost> grounds;
  for (std::size_t i = 0; i < map.cost().states().size(); ++i) {
    const auto& states = map.cost().states()[i];
    if (!states)
      throw std::domain_error("cost weights: the map's cost holds no energy, time and risk to weigh");
    grounds.push_back({states->curve(weights), states, map.cost().turns()[i]});
  }
  CostGrid::Content content = map.content();
  content.cost =
      std::make_shared<const TravelCost>(map.cost().limits(), grounds, map.cost().uncertainty(), weights);
  return std::make_shared<const CostGrid>(std::move(content));
}

LearnedCells::LearnedCells(const maps::Grid& grid)
    : tile_columns_((grid.width + CostTile::kSide - 1) / CostTile::kSide),
      tiles_(static_cast<std::size_t>(tile_columns_) *
             static_cast<std::size_t>((grid.height + CostTile::kSide - 1) / CostTile::kSide)) {}

bool LearnedCells::set(maps::Cell cell, std::uint32_t word) {
  std::unique_ptr<Tile>& tile = tiles_[slot(cell)];
  if (!tile) {
    if (word == 0) return false;
    tile = std::make_unique<Tile>();
    tile->box = {cell, cell};
  }
  std::uint32_t& old = tile->words[inside(cell)];
  if (old == word) return false;
  old = word;
  maps::CellBox& box = tile->box;
  box = {{std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)},
         {std::max(box.last.column, cell.column), std::max(box.last.row, cell.row)}};
  return true;
}

std::vector<maps::CellBox> LearnedCells::boxes() const {
  std::vector<maps::CellBox> boxes;
  for (const auto& tile : tiles_)
    if (tile) boxes.push_back(tile->box);
  return boxes;
}

}  // namespace talus::costmap
