#include <algorithm>
#include <array>
#include <utility>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/local_ground.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace {

std::size_t mostOf(const CostCurveTable& table) {
  return std::min(CostCurveTable::kMost - 1, 256 + 2 * table.size());
}

std::vector<std::shared_ptr<CostTile>> emptyTiles(const maps::Grid& grid) {
  const auto across = [](int cells) {
    return static_cast<std::size_t>((cells + CostTile::kSide - 1) / CostTile::kSide);
  };
  std::vector<std::shared_ptr<CostTile>> tiles(across(grid.width) * across(grid.height));
  for (auto& tile : tiles) tile = std::make_shared<CostTile>();
  return tiles;
}

// Appends a range. Ranges of a drive overlap: a range is merged into the last if the union is little larger.
std::vector<maps::CellBox> joined(std::vector<maps::CellBox> ranges, const maps::CellBox& range) {
  const auto area = [](const maps::CellBox& r) {
    return static_cast<double>(r.last.column - r.first.column + 1) * (r.last.row - r.first.row + 1);
  };
  if (!ranges.empty()) {
    maps::CellBox& last = ranges.back();
    const maps::CellBox both = around(last, range);
    if (area(both) < 1.3 * std::max(area(last), area(range))) {
      last = both;
      return ranges;
    }
  }
  ranges.push_back(range);
  return ranges;
}

}  // namespace

MapCosts::MapCosts(std::shared_ptr<MapSurface> surface, const ProgressMonitor& watch)
    : surface_(std::move(surface)),
      curves_(std::make_unique<GroundCurves>(surface_->site())),
      published_(std::make_unique<PublishedGrid>()) {
  published_->store(measured(watch));
  most_curves_ = mostOf(curves_->table());
}

MapCosts::~MapCosts() = default;

std::shared_ptr<const CostGrid> MapCosts::measured(const ProgressMonitor& watch) {
  const maps::Grid& grid = surface_->grid();
  const std::vector<std::shared_ptr<CostTile>> tiles = emptyTiles(grid);
  const int tile_columns = (grid.width + CostTile::kSide - 1) / CostTile::kSide;
  const auto slot = [&](maps::Cell c) -> CellCode& {
    auto& tile = *tiles[static_cast<std::size_t>((c.row >> 6) * tile_columns + (c.column >> 6))];
    return tile.cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  };
  surface_->measure([&](maps::Cell cell, CellCode code) { slot(cell) = code; }, watch);
  forEachCell(allOf(grid), [&](maps::Cell cell) { slot(cell) = coded(cell, slot(cell)); });
  return std::make_shared<CostGrid>(
      CostGrid::Content{.grid = grid,
                        .tiles = TileTable(std::vector<TileTable::Shared>(tiles.begin(), tiles.end())),
                        .cost = curves_->table().cost(),
                        .version = 1,
                        .elevation_m = tiled(surface_->site()->elevation.elevation_m)});
}

std::shared_ptr<const CostGrid> MapCosts::published() const noexcept {
  return published_->load();
}

std::optional<GroundBelief> MapCosts::ground(maps::Cell cell) const {
  const CellCode::Curve number = published()->at(cell).curve();
  if (number >= CellCode::kUnknown) return std::nullopt;
  return curves_->table().belief(number);
}

std::optional<CellCategory> MapCosts::ranked(maps::Cell cell) const {
  const CellCode code = published()->at(cell);
  if (code.curve() >= CellCode::kUnknown) return std::nullopt;
  const auto entry = curves_->table().categories(code.curve()).at(code);
  return CellCategory{entry.category, entry.confidence};
}

maps::Raster<std::uint8_t> MapCosts::categories() const {
  maps::Raster<std::uint8_t> all(surface_->grid());
  const auto published = this->published();
  for (int row = 0; row < surface_->grid().height; ++row)
    for (int column = 0; column < surface_->grid().width; ++column)
      all[{column, row}] = categoryOf(*published, {column, row});
  return all;
}

CategoryCounts MapCosts::countCategories() const {
  std::array<std::size_t, 4> counts{};
  const maps::Raster<std::uint8_t> all = categories();
  for (const std::uint8_t category : all.values()) ++counts[category];
  return {counts[0], counts[1], counts[2], counts[3]};
}

std::size_t MapCosts::cellsChanged(const CostGrid& before) const {
  const auto now = published();
  const auto &old_curves = before.cost().curves(), &curves = now->cost().curves();
  std::size_t changed = 0;
  for (int row = 0; row < surface_->grid().height; ++row)
    for (int column = 0; column < surface_->grid().width; ++column) {
      const std::size_t from = before.at({column, row}).curve(), to = now->at({column, row}).curve();
      const bool same = from >= old_curves.size() || to >= curves.size()
                            ? from == to
                            : old_curves[from].cost_J_per_m == curves[to].cost_J_per_m;
      changed += same ? 0U : 1U;
    }
  return changed;
}

std::uint8_t MapCosts::categoryOf(const CostGrid& grid, maps::Cell cell) const noexcept {
  const CellCode code = grid.at(cell);
  if (code.curve() < CellCode::kUnknown) return curves_->table().categories(code.curve()).at(code).category;
  return static_cast<std::uint8_t>(has(surface_->hazards(cell), Hazard::Unknown)
                                       ? terramech::Category::Unknown
                                       : terramech::Category::Dangerous);
}

void MapCosts::noteLearned(const maps::CellBox& box) {
  learned_ = joined(std::move(learned_), box);
}

void MapCosts::notePatched(MapSurface::PatchEffect effect, bool classes) {
  heights_m_ =
      retiled(published()->content().elevation_m, surface_->site()->elevation.elevation_m, effect.window);
  gradients_ = std::move(effect.gradients);
  changed_.push_back(effect.judged);
  if (!classes) return;
  changed_.push_back(curves_->takeClasses(effect.window));
  learned_.push_back(effect.window);
}

void MapCosts::publish(const EvidenceField& field) {
  publish(field, false);
}

void MapCosts::publishAll(const EvidenceField& field) {
  curves_->restart();
  learned_ = changed_ = {allOf(surface_->grid())};
  publish(field, true);
}

void MapCosts::republishAs(std::uint64_t version) {
  CostGrid::Content content = published()->content();
  content.version = version;
  published_->store(std::make_shared<CostGrid>(std::move(content)));
}

void MapCosts::publish(const EvidenceField& field, bool whole) {
  std::vector<maps::CellBox> learned = std::exchange(learned_, {});
  std::vector<maps::CellBox> changed = std::exchange(changed_, {});
  const bool any = !learned.empty() || !changed.empty();
  const auto append = [](std::vector<maps::CellBox>& to, const std::vector<maps::CellBox>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  const GroundCurves::ClassChange moved = curves_->learnClasses(field);
  if (moved.learned && !whole) append(learned, field.reached());
  if (!any && !moved.priors && learned.empty()) return;
  EvidenceBeliefs beliefs(field);
  append(changed, curves_->learn(beliefs, learned));
  if (moved.priors) append(changed, curves_->mixedRanges());
  published_->store(costed(changed));
  gradients_.reset();
  heights_m_.reset();
}

// Each curve depends on its kind alone, so that an incremental version equals a complete one. Curves of former
// versions are discarded when most are such.
std::shared_ptr<const CostGrid> MapCosts::costed(const std::vector<maps::CellBox>& changed) {
  std::shared_ptr<const CostGrid> next = rewritten(changed);
  if (curves_->table().size() <= most_curves_) return next;
  curves_->restart();
  next = rewritten({allOf(surface_->grid())});
  most_curves_ = mostOf(curves_->table());
  return next;
}

// Recomputes the cells of the ranges. The cost is requested after the codes, because new codes may add
// curves.
std::shared_ptr<const CostGrid> MapCosts::rewritten(const std::vector<maps::CellBox>& ranges) {
  return std::make_shared<CostGrid>(
      revised(*published(), {.ranges = ranges,
                             .code = [&](maps::Cell cell, CellCode code) { return coded(cell, code); },
                             .cost = [&] { return curves_->table().cost(); },
                             .elevation_m = heights_m_}));
}

CellCode MapCosts::coded(maps::Cell cell, CellCode code) {
  if (gradients_ && contains(gradients_->box, cell))
    code =
        gradients_->codes[{cell.column - gradients_->box.first.column, cell.row - gradients_->box.first.row}];
  const Hazard found = surface_->hazards(cell);
  if (found == Hazard::None) return code.withCurve(curves_->number(cell));
  if (found != Hazard::Unknown) return code.withCurve(CellCode::kBlocked);
  if (!surface_->model().parts().policy.allow_unknown) return code.withCurve(CellCode::kUnknown);
  // The estimate from telemetry also applies to cells whose shape cannot be measured.
  return code.withCurve(surface_->classIndex(cell) >= 0 ? curves_->number(cell)
                                                        : curves_->numberOfUnseen(cell));
}

}  // namespace talus::costmap
