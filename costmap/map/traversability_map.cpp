#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/local_ground.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/site/surface_patch.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {

namespace {

template <typename T>
void requireGrid(const maps::Raster<T>& layer, const maps::Grid& grid, const char* name) {
  if (!layer.empty() && layer.grid() != grid)
    throw std::invalid_argument(std::string("TraversabilityMap: ") + name +
                                " lies on another grid than the elevation");
}

void requireCosts(const std::vector<CostLayer>& costs, const maps::Grid& grid) {
  if (costs.size() > CostLayer::kMostLayers)
    throw std::invalid_argument("TraversabilityMap: " + std::to_string(costs.size()) +
                                " cost layers, must be <= " + std::to_string(CostLayer::kMostLayers));
  for (const CostLayer& layer : costs) {
    const std::string who = "layer '" + layer.name + "'";
    if (layer.added_J_per_m.empty() || layer.added_J_per_m.grid() != grid)
      throw std::invalid_argument("TraversabilityMap: " + who + " lies on another grid than the elevation");
    const auto possible = [](float v) {
      return v >= 0.0F && (v <= CostLayer::kMost_J_per_m || std::isinf(v));
    };
    for (const float v : layer.added_J_per_m.values())
      if (!std::isnan(v) && !possible(v))
        throw std::invalid_argument("TraversabilityMap: " + who + ": " + std::to_string(v) +
                                    " J/m, must be 0 to 1e6, infinite or NaN");
    if (!(layer.unseen_J_per_m >= 0.0F && layer.unseen_J_per_m <= CostLayer::kMost_J_per_m))
      throw std::invalid_argument("TraversabilityMap: " + who + ": unseen_J_per_m must be 0 to 1e6");
  }
}

std::shared_ptr<GroundSite> siteOf(MapLayers& layers, std::shared_ptr<const GroundModel> model) {
  requireCosts(layers.costs, layers.elevation.grid());
  requirePossible(layers);
  const double base_m = layers.base_elevation_m.value_or(middleElevation(layers.elevation.elevation_m));
  const SurfaceKeys keys(layers.elevation.grid(), base_m);
  return std::make_shared<GroundSite>(GroundSite{.elevation = std::move(layers.elevation),
                                                 .classes = std::move(layers.classes),
                                                 .keys = keys,
                                                 .model = std::move(model),
                                                 .costs = std::move(layers.costs)});
}

Hazard without(Hazard set, Hazard one) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(set) & ~static_cast<unsigned>(one));
}

Hazard with(Hazard set, Hazard one, bool there) noexcept {
  return there ? set | one : without(set, one);
}

CellCode flatCode(const GroundShape& shape) {
  return CellCode({.dz_dx = static_cast<double>(shape.dz_dx), .dz_dy = static_cast<double>(shape.dz_dy)});
}

// Calls take(cell of the map, value of the patch) for each cell of a layer; no call for an empty layer.
template <typename T, typename Take>
void forEachGiven(const maps::Raster<T>& layer, const maps::CellBox& window, const Take& take) {
  if (layer.empty()) return;
  forEachCell(window, [&](maps::Cell cell) {
    take(cell, layer[{cell.column - window.first.column, cell.row - window.first.row}]);
  });
}

}  // namespace

MapSurface::MapSurface(MapLayers layers, std::shared_ptr<const GroundModel> model,
                       const ShapeOptions& options)
    : site_(siteOf(layers, std::move(model))),
      limits_(site_->model->parts().stated ? HazardLimits::ofPoint()
                                           : HazardLimits::of(site_->model->rover())),
      options_(options),
      declared_(std::move(layers.declared)),
      hazards_(grid(), Hazard::None) {
  requireGrid(site_->classes, grid(), "classes");
  requireGrid(layers.rock_abundance, grid(), "rock_abundance");
  requireGrid(layers.keep_out, grid(), "keep_out");
  requireGrid(declared_, grid(), "declared");
  any_height_ =
      std::ranges::any_of(site_->elevation.elevation_m.values(), [](float e) { return !std::isnan(e); });
  takeHazards({.elevation_m = {},
               .rock_abundance = std::move(layers.rock_abundance),
               .classes = {},
               .keep_out = std::move(layers.keep_out)},
              allOf(grid()));
}

void MapSurface::measure(const TakeShape& take, const ProgressMonitor& watch) {
  const SurfaceShape shapes(footprint(options_.threads));
  shapes.measure(
      site_->elevation.elevation_m, allOf(grid()), limits_,
      [&](maps::Cell cell, const GroundShape& shape, Hazard found) {
        const Ground ground = grounded(cell, shape, found);
        hazards_[cell] = ground.hazards | layerHazards(cell);
        take(cell, ground.code);
      },
      watch);
  inflate(hazards_, limits_, spreading());
}

// Makes code and hazards of a cell. If the shape is unknown and the policy allows unknown ground, the slope
// is unseenSlope().
MapSurface::Ground MapSurface::grounded(maps::Cell cell, const GroundShape& shape, Hazard found) const {
  if (!std::isnan(shape.dz_dx) || !site_->model->parts().policy.allow_unknown)
    return {flatCode(shape), found};
  const UnseenSlope slope = unseenSlope(site_->elevation.elevation_m, cell);
  const bool steep = std::hypot(slope.dz_dx, slope.dz_dy) > limits_.max_gradient;
  return {CellCode({.dz_dx = slope.dz_dx, .dz_dy = slope.dz_dy}), steep ? found | Hazard::Slope : found};
}

// A changed cell affects the shape of all cells whose footprint contains the cell, and unseenSlope() up to
// the next height. The affected cells may enter or leave the clearance around hazards. Refused places have no
// clearance; their marks are therefore removed during the update.
MapSurface::PatchEffect MapSurface::take(const SurfacePatch& patch) {
  const maps::CellBox window = placeOf(patch, *site_, any_height_);
  takeHazards(patch, window);
  takeGround(patch, window);
  const SurfaceShape shapes(footprint(options_.threads));
  const bool bounded = site_->model->parts().policy.allow_unknown;
  const maps::CellBox shaped =
      grown(window, std::max(shapes.reach(grid()), bounded ? kUnseenReach : 0), grid());
  const maps::CellBox judged = grown(shaped, inflationReach(limits_, grid().resolution_m) + 1, grid());
  for (const RefusedPlace& place : refused_) mark(place, false);
  forEachCell(judged, [&](maps::Cell cell) {
    hazards_[cell] = without(hazards_[cell], Hazard::Near) | layerHazards(cell);
  });
  maps::Grid part = grid();
  part.width = shaped.width();
  part.height = shaped.height();
  Gradients gradients{.box = shaped, .codes = maps::Raster<CellCode>(part)};
  shapes.measure(
      site_->elevation.elevation_m, shaped, limits_,
      [&](maps::Cell cell, const GroundShape& shape, Hazard found) {
        const Ground ground = grounded(cell, shape, found);
        hazards_[cell] = ground.hazards | layerHazards(cell);
        gradients.codes[{cell.column - shaped.first.column, cell.row - shaped.first.row}] = ground.code;
      },
      {});
  inflate(hazards_, limits_, spreading(), judged);
  for (const RefusedPlace& place : refused_) mark(place, true);
  return {window, judged, std::move(gradients)};
}

void MapSurface::takeGround(const SurfacePatch& patch, const maps::CellBox& window) {
  bool any = any_height_;
  forEachGiven(patch.elevation_m, window, [&](maps::Cell cell, float height_m) {
    if (std::isnan(height_m)) return;
    site_->elevation.elevation_m[cell] = height_m;
    any = true;
  });
  if (any && !any_height_) site_->keys = SurfaceKeys(grid(), middleElevation(patch.elevation_m));
  any_height_ = any;
  forEachGiven(patch.classes, window, [&](maps::Cell cell, std::uint8_t number) {
    if (number != GroundSite::kNoClass) site_->classes[cell] = number;
  });
}

void MapSurface::takeHazards(const SurfacePatch& patch, const maps::CellBox& window) {
  if (patch.rock_abundance.empty() && patch.keep_out.empty()) return;
  if (declared_.empty()) declared_ = maps::Raster<Hazard>(grid(), Hazard::None);
  forEachGiven(patch.rock_abundance, window, [&](maps::Cell cell, float abundance) {
    if (!std::isnan(abundance))
      declared_[cell] = without(declared_[cell], Hazard::Rocks) | rocksOn(abundance);
  });
  forEachGiven(patch.keep_out, window, [&](maps::Cell cell, std::uint8_t keep_out) {
    declared_[cell] = with(declared_[cell], Hazard::KeepOut, keep_out != 0);
  });
}

Hazard MapSurface::rocksOn(float abundance) const {
  const RockCrossing crossing{.diameter_m = limits_.rock_diameter_m, .area_m2 = limits_.rock_area_m2};
  const bool refused = rockHazard(static_cast<double>(abundance), crossing) > limits_.max_rock_probability;
  return refused ? Hazard::Rocks : Hazard::None;
}

Hazard MapSurface::spreading() const noexcept {
  return site_->model->parts().policy.allow_unknown ? Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks
                                                    : kKeptClearOf;
}

Hazard MapSurface::layerHazards(maps::Cell cell) const {
  Hazard found = declared_.empty() ? Hazard::None : declared_[cell];
  if (std::isnan(site_->elevation.elevation_m[cell])) found |= Hazard::Unknown;
  if (!site_->classes.empty()) {
    const std::uint8_t number = site_->classes[cell];
    if (number == GroundSite::kNoClass)
      found |= Hazard::Unknown;
    else if (site_->model->classIndex(number) < 0)
      found |= Hazard::Obstacle;
  }
  for (const CostLayer& layer : site_->costs) {
    const float added = layer.added_J_per_m[cell];
    if (std::isinf(added)) found |= Hazard::KeepOut;
    if (std::isnan(added) && !site_->model->parts().policy.allow_unknown) found |= Hazard::Unknown;
  }
  return found;
}

maps::CellBox MapSurface::refuse(const RefusedPlace& place) {
  refused_.push_back(place);
  return mark(place, true);
}

std::vector<maps::CellBox> MapSurface::leaveOut(std::uint16_t drive) {
  std::vector<maps::CellBox> boxes;
  std::erase_if(refused_, [&](const RefusedPlace& place) {
    if (place.drive == drive) boxes.push_back(mark(place, false));
    return place.drive == drive;
  });
  for (const RefusedPlace& place : refused_) mark(place, true);
  return boxes;
}

// Sets or clears the obstacle mark of the cells of a place. Returns the bounding box of the cells.
maps::CellBox MapSurface::mark(const RefusedPlace& refusal, bool refused) {
  const double cell_m = grid().resolution_m;
  const auto clamped = [](double value, int cells) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(cells - 1)));
  };
  const double x = (refusal.place.x_m - grid().south_west.x_m) / cell_m,
               y = (refusal.place.y_m - grid().south_west.y_m) / cell_m;
  const double reach = refusal.radius_m / cell_m;
  const maps::CellBox range{{clamped(x - reach, grid().width), clamped(y - reach, grid().height)},
                            {clamped(x + reach, grid().width), clamped(y + reach, grid().height)}};
  forEachCell(range, [&](maps::Cell cell) {
    const maps::Point centre = grid().centre(cell);
    if (std::hypot(centre.x_m - refusal.place.x_m, centre.y_m - refusal.place.y_m) > refusal.radius_m) return;
    const bool there = refused || has(layerHazards(cell), Hazard::Obstacle);
    hazards_[cell] = with(hazards_[cell], Hazard::Obstacle, there);
  });
  return range;
}

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
  return curves_->table().categories(code.curve()).at(code);
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
                            : std::ranges::equal(old_curves[from].level(), curves[to].level());
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

namespace {

// Shift of the window in cells.
maps::Cell cellsOf(const maps::Grid& grid, maps::Cell tiles) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        "TraversabilityMap: moved() by " + std::to_string(tiles.column) + ',' + std::to_string(tiles.row) +
        " tiles of 64 cells leaves nothing of the map of " + std::to_string(grid.width) + " x " +
        std::to_string(grid.height) + " cells; build a new one");
  };
  constexpr int kMost = 65536 / CostTile::kSide;
  if (tiles.column > kMost || tiles.column < -kMost || tiles.row > kMost || tiles.row < -kMost) refuse();
  const maps::Cell cells{tiles.column * CostTile::kSide, tiles.row * CostTile::kSide};
  if (std::abs(cells.column) >= grid.width || std::abs(cells.row) >= grid.height) refuse();
  return cells;
}

// Guard of a call that changes a map: a concurrent change throws an error instead of causing a data race.
class MapChange {
 public:
  // Marks the map as changing during the lifetime of the object. Throws std::logic_error, which names the
  // function `call`, if another thread is changing the map.
  MapChange(std::atomic_flag& changing, const char* call) : changing_(changing) {
    if (changing_.test_and_set(std::memory_order_acquire))
      throw std::logic_error(std::string("TraversabilityMap: ") + call +
                             "() while another thread changes the map; let one thread change it");
  }
  MapChange(const MapChange&) = delete;
  MapChange& operator=(const MapChange&) = delete;
  ~MapChange() { changing_.clear(std::memory_order_release); }

 private:
  std::atomic_flag& changing_;
};

ShapeOptions shapeOf(const TraversabilityMap::Options& options, const terramech::Rover& rover) {
  return {.footprint_radius_m = options.footprint_radius_m > 0.0
                                    ? options.footprint_radius_m
                                    : 0.5 * std::hypot(rover.wheelbase_m, rover.track_m),
          .threads = options.threads};
}

std::shared_ptr<MapSurface> surfaceOf(MapLayers layers, std::shared_ptr<const GroundModel> model,
                                      const TraversabilityMap::Options& options) {
  const ShapeOptions shape = shapeOf(options, model->rover());
  return std::make_shared<MapSurface>(std::move(layers), std::move(model), shape);
}

// Returns the disc around the block of an observation. Repeated observations of a spinning wheel have equal
// discs.
RefusedPlace blockAround(const WheelObservation& observation, const maps::Grid& grid, double side_m) {
  const auto middle = [&](double at, double from) {
    return from + (std::floor((at - from) / side_m) + 0.5) * side_m;
  };
  return {{middle(observation.place.x_m, grid.south_west.x_m),
           middle(observation.place.y_m, grid.south_west.y_m)},
          side_m + EvidenceField::kPoseReach * std::max(observation.pose_std_m, 0.0),
          observation.drive};
}

bool reaches(const RefusedPlace& refusal, const maps::Grid& grid) {
  const maps::Point origin = grid.south_west;
  const double x = std::clamp(refusal.place.x_m, origin.x_m, origin.x_m + grid.width * grid.resolution_m),
               y = std::clamp(refusal.place.y_m, origin.y_m, origin.y_m + grid.height * grid.resolution_m);
  return std::hypot(refusal.place.x_m - x, refusal.place.y_m - y) <= refusal.radius_m;
}

}  // namespace

MapShift::MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells)
    : cells_(cellsOf(grid, tiles)), grid_(grid), block_cells_(block_cells) {
  grid_.south_west.x_m += cells_.column * grid.resolution_m;
  grid_.south_west.y_m += cells_.row * grid.resolution_m;
  if (block_cells > CostTile::kSide)
    throw std::invalid_argument(
        "TraversabilityMap: moved() needs cells that keep evidence together by 64 or fewer, "
        "not " +
        std::to_string(block_cells) + "; take larger cells");
}

template <typename T>
maps::Raster<T> MapShift::shifted(const maps::Raster<T>& old, T unseen) const {
  if (old.empty()) return {};
  maps::Raster<T> out(grid_, unseen);
  forEachCell(allOf(grid_), [&](maps::Cell c) {
    const maps::Cell from{c.column + cells_.column, c.row + cells_.row};
    if (grid_.contains(from)) out[c] = old[from];
  });
  return out;
}

MapLayers MapShift::layers(const MapSurface& surface) const {
  constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  const maps::ElevationMap& elevation = surface.elevation();
  MapLayers layers;
  layers.elevation = {.elevation_m = shifted(elevation.elevation_m, kUnseen),
                      .georeference = elevation.georeference,
                      .source = elevation.source,
                      .reading = elevation.reading,
                      .files = elevation.files,
                      .notes = elevation.notes};
  layers.classes = shifted(surface.classes(), GroundSite::kNoClass);
  layers.declared = shifted(surface.declared(), Hazard::None);
  for (const CostLayer& layer : surface.costLayers())
    layers.costs.push_back({layer.name, shifted(layer.added_J_per_m, kUnseen), layer.unseen_J_per_m});
  // Octree keys are relative to the base elevation, so both maps need the same base.
  layers.base_elevation_m = surface.keys().baseElevation_m();
  return layers;
}

SavedBlock MapShift::block(SavedBlock saved) const {
  saved.block.column -= cells_.column / block_cells_;
  saved.block.row -= cells_.row / block_cells_;
  return saved;
}

TraversabilityMap::TraversabilityMap(TraversabilityMap&&) noexcept = default;
TraversabilityMap& TraversabilityMap::operator=(TraversabilityMap&&) noexcept = default;
TraversabilityMap::~TraversabilityMap() = default;

TraversabilityMap::TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model,
                                     const Options& options, const ProgressMonitor& watch)
    : surface_(surfaceOf(std::move(layers), std::move(model), options)),
      field_(surface_->site()),
      costs_(std::make_unique<MapCosts>(surface_, watch)),
      changing_(std::make_unique<std::atomic_flag>()) {}

bool TraversabilityMap::learn(const WheelObservation& observation) {
  const MapChange change(*changing_, "learn");
  const auto range = field_.add(observation);
  if (range) costs_->noteLearned(*range);
  return range.has_value() || (observation.here.any() && refuseUnobserved(observation));
}

void TraversabilityMap::forget(const SavedBlock& readings) {
  const MapChange change(*changing_, "forget");
  if (const auto range = field_.forget(readings)) costs_->noteLearned(*range);
}

bool TraversabilityMap::restore(const SavedBlock& saved) {
  const auto range = field_.restore(saved);
  if (range) costs_->noteLearned(*range);
  return range.has_value();
}

// Refuses the place of a dangerous observation on unobserved ground. Returns false if the place does not
// overlap the map.
bool TraversabilityMap::refuseUnobserved(const WheelObservation& observation) {
  const RefusedPlace refusal = blockAround(observation, grid(), field_.blockCells() * grid().resolution_m);
  if (!reaches(refusal, grid())) return false;
  const bool known = std::ranges::any_of(surface_->refused(), [&](const RefusedPlace& other) {
    return other.place == refusal.place && other.radius_m >= refusal.radius_m && other.drive == refusal.drive;
  });
  if (!known) costs_->noteChanged(surface_->refuse(refusal));
  return true;
}

void TraversabilityMap::leaveOut(const std::string& id) {
  const auto found = drives_.find(id);
  if (found == drives_.end() || found->second.number == 0)
    throw std::invalid_argument("drive '" + id +
                                "' is not one of the map whose readings are stored by drive");
  const MapChange change(*changing_, "leaveOut");
  const std::uint16_t number = found->second.number;
  std::vector<SavedBlock> blocks;
  field_.visit([&](const SavedBlock& saved) { blocks.push_back(saved); });
  for (SavedBlock& block : blocks) {
    std::erase_if(block.evidence.sources, [&](const auto& of) { return of.first.drive != number; });
    if (!block.evidence.sources.empty()) costs_->noteLearned(*field_.forget(block));
  }
  for (const maps::CellBox& box : surface_->leaveOut(number)) costs_->noteChanged(box);
  std::erase_if(drives_, [&](const auto& drive) { return drive.second.number == number; });
}

void TraversabilityMap::refuse(const maps::Point& place, double radius_m, std::uint16_t drive) {
  if (!std::isfinite(place.x_m) || !std::isfinite(place.y_m) || !std::isfinite(radius_m) || radius_m <= 0.0)
    throw std::invalid_argument("refuse: the place must be finite, the radius finite and > 0");
  const MapChange change(*changing_, "refuse");
  costs_->noteChanged(surface_->refuse({place, radius_m, drive}));
}

void TraversabilityMap::patch(const SurfacePatch& patch) {
  const MapChange change(*changing_, "patch");
  costs_->notePatched(surface_->take(patch), !patch.classes.empty());
  costs_->publish(field_);
}

void TraversabilityMap::publish() {
  const MapChange change(*changing_, "publish");
  costs_->publish(field_);
}

void TraversabilityMap::publishAll() {
  const MapChange change(*changing_, "publishAll");
  costs_->publishAll(field_);
}

TraversabilityMap TraversabilityMap::moved(maps::Cell tiles, const ProgressMonitor& watch) const {
  const MapShift shift(grid(), tiles, field_.blockCells());
  TraversabilityMap next(
      shift.layers(*surface_), surface_->site()->model,
      {.footprint_radius_m = surface_->footprintRadius_m(), .threads = surface_->threads()}, watch);
  field_.visit([&](const SavedBlock& saved) { next.field_.restore(shift.block(saved)); });
  next.drives_ = drives_;
  for (const RefusedPlace& refusal : surface_->refused())
    next.refuse(refusal.place, refusal.radius_m, refusal.drive);
  next.publishAll();
  next.costs_->republishAs(published()->version() + 1);
  return next;
}

}  // namespace talus::costmap
