#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/costmap/ground_curves.hpp>
#include <talus/costmap/rock_hazard.hpp>
#include <talus/costmap/surface_tree.hpp>
#include <talus/costmap/traversability_map.hpp>

namespace talus::costmap {
namespace {

constexpr int kBandRows = 4 * CostTile::kSide;

double footprintRadius(const TraversabilityMap::Options& options, const terramech::Rover& rover) {
  return options.footprint_radius_m > 0.0 ? options.footprint_radius_m
                                          : 0.5 * std::hypot(rover.wheelbase_m, rover.track_m);
}

// Median would be steadier; the middle of the range keeps every height inside the tree.
double middleElevation(const maps::Raster<float>& elevation_m) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float e : elevation_m.values())
    if (!std::isnan(e)) {
      low = std::min(low, e);
      high = std::max(high, e);
    }
  return low <= high ? 0.5 * (static_cast<double>(low) + static_cast<double>(high)) : 0.0;
}

template <typename T>
void requireGrid(const maps::Raster<T>& layer, const maps::Grid& grid, const char* name) {
  if (!layer.empty() && layer.grid() != grid)
    throw std::invalid_argument(std::string("TraversabilityMap: ") + name +
                                " lies on another grid than the elevation");
}

// A band of rows with a margin, measured by itself: equal to measuring the whole map, in a sixteenth of the
// memory.
struct Band {
  int first_row = 0;
  int margin_rows = 0;  // below first_row
  maps::TerrainMetrics metrics;

  std::size_t index(maps::Cell cell) const {
    return metrics.dz_dx.grid().index({cell.column, cell.row - first_row + margin_rows});
  }
};

struct BandRequest {
  int first_row;
  maps::FootprintOptions footprint;
};

Band measureBand(const maps::Raster<float>& elevation_m, const BandRequest& request) {
  const maps::Grid& grid = elevation_m.grid();
  const int halo = static_cast<int>(std::ceil(request.footprint.radius_m / grid.resolution_m)) + 2;
  const int from = std::max(0, request.first_row - halo);
  const int to = std::min(grid.height, request.first_row + kBandRows + halo);
  maps::Grid part = grid;
  part.height = to - from;
  maps::Raster<float> rows(part);
  std::copy(elevation_m.row(from), elevation_m.row(from) + part.size(), rows.values().begin());
  return {.first_row = request.first_row,
          .margin_rows = request.first_row - from,
          .metrics = maps::terrainMetrics(rows, request.footprint)};
}

double footprintWidth(const maps::TerrainMetrics& metrics, double resolution_m, double radius_m) {
  return metrics.fell_back ? 2.0 * resolution_m : 2.0 * radius_m;
}

std::shared_ptr<const GroundSite> siteOf(MapLayers& layers, std::shared_ptr<const GroundModel> model) {
  const SurfaceKeys keys(layers.elevation.grid(), middleElevation(layers.elevation.elevation_m));
  return std::make_shared<GroundSite>(GroundSite{.elevation = std::move(layers.elevation),
                                                 .classes = std::move(layers.classes),
                                                 .keys = keys,
                                                 .model = std::move(model),
                                                 .floors = std::move(layers.floors)});
}

std::vector<std::shared_ptr<CostTile>> emptyTiles(const maps::Grid& grid) {
  const auto across = [](int cells) {
    return static_cast<std::size_t>((cells + CostTile::kSide - 1) / CostTile::kSide);
  };
  std::vector<std::shared_ptr<CostTile>> tiles(across(grid.width) * across(grid.height));
  for (auto& tile : tiles) tile = std::make_shared<CostTile>();
  return tiles;
}

// Ranges of a drive overlap: neighbours in time are joined where that covers little more than both.
std::vector<maps::CellBox> joined(std::vector<maps::CellBox> ranges, const maps::CellBox& range) {
  const auto area = [](const maps::CellBox& r) {
    return static_cast<double>(r.last.column - r.first.column + 1) * (r.last.row - r.first.row + 1);
  };
  if (!ranges.empty()) {
    maps::CellBox& last = ranges.back();
    const maps::CellBox both{
        {std::min(last.first.column, range.first.column), std::min(last.first.row, range.first.row)},
        {std::max(last.last.column, range.last.column), std::max(last.last.row, range.last.row)}};
    if (area(both) < 1.3 * std::max(area(last), area(range))) {
      last = both;
      return ranges;
    }
  }
  ranges.push_back(range);
  return ranges;
}

void tell(const GroundBelief& strength, CellBelief& belief) {
  belief.pull_mean = static_cast<float>(strength.pull.value);
  belief.pull_std = static_cast<float>(strength.pull.std);
  belief.sinkage_mean = static_cast<float>(strength.sinkage.value);
  belief.sinkage_std = static_cast<float>(strength.sinkage.std);
}

void tell(const BlockEvidence& own, double samples, CellBelief& belief) {
  belief.evidence = static_cast<float>(samples);
  const float weakest = std::fmin(own.weak_pull, own.most_pull);
  belief.evidence_pull = std::isnan(weakest) ? 0.0F : weakest;
  belief.evidence_sinkage = std::fmax(0.0F, std::fmax(own.sinkage, own.least_sinkage));
  belief.updated_s = own.updated_s;
}

}  // namespace

struct TraversabilityMap::Published {
  std::atomic<std::shared_ptr<const CostGrid>> grid;
};

TraversabilityMap::TraversabilityMap(TraversabilityMap&&) noexcept = default;
TraversabilityMap::~TraversabilityMap() = default;

TraversabilityMap::TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model,
                                     const Options& options, const ProgressMonitor& watch)
    : site_(siteOf(layers, std::move(model))),
      limits_(HazardLimits::of(site_->model->rover())),
      footprint_radius_m_(footprintRadius(options, site_->model->rover())),
      hazards_(grid(), Hazard::None),
      curves_(std::make_unique<GroundCurves>(site_)),
      field_(site_),
      published_(std::make_unique<Published>()) {
  requireGrid(site_->classes, grid(), "classes");
  requireGrid(layers.rock_abundance, grid(), "rock_abundance");
  requireGrid(layers.keep_out, grid(), "keep_out");
  requireGrid(layers.declared, grid(), "declared");
  published_->grid = std::make_shared<CostGrid>(CostGrid::Content{.grid = grid(),
                                                                  .tiles = measure(layers, options, watch),
                                                                  .cost = curves_->table().cost(),
                                                                  .version = 1});
  if (curves_->table().overflowed()) published_->grid = renumbered();
}

Hazard TraversabilityMap::layerHazards(const MapLayers& layers, std::size_t i) const {
  Hazard found = layers.declared.empty() ? Hazard::None : layers.declared.values()[i];
  if (std::isnan(site_->elevation.elevation_m.values()[i])) found |= Hazard::Unknown;
  if (!layers.keep_out.empty() && layers.keep_out.values()[i] != 0) found |= Hazard::KeepOut;
  if (!layers.rock_abundance.empty()) {
    const RockCrossing crossing{.diameter_m = limits_.rock_diameter_m, .area_m2 = limits_.rock_area_m2};
    const double rocks = rockHazard(static_cast<double>(layers.rock_abundance.values()[i]), crossing);
    if (rocks > limits_.max_rock_probability) found |= Hazard::Rocks;
  }
  if (!site_->classes.empty()) {
    const std::uint8_t number = site_->classes.values()[i];
    if (number == GroundSite::kNoClass)
      found |= Hazard::Unknown;
    else if (site_->model->classIndex(number) < 0)
      found |= Hazard::Obstacle;
  }
  return found;
}

TileTable TraversabilityMap::measure(const MapLayers& layers, const Options& options,
                                     const ProgressMonitor& watch) {
  const std::vector<std::shared_ptr<CostTile>> tiles = emptyTiles(grid());
  const int tile_columns = (grid().width + CostTile::kSide - 1) / CostTile::kSide;
  const auto slot = [&](maps::Cell c) -> CellCode& {
    auto& tile = *tiles[static_cast<std::size_t>((c.row >> 6) * tile_columns + (c.column >> 6))];
    return tile.cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  };
  for (int first = 0; first < grid().height && !watch.stopped(); first += kBandRows) {
    const Band band = measureBand(site_->elevation.elevation_m,
                                  {first, {.radius_m = footprint_radius_m_, .threads = options.threads}});
    const maps::TerrainMetrics& m = band.metrics;
    const ShapeJudge judge(limits_, footprintWidth(m, grid().resolution_m, footprint_radius_m_));
    for (int row = first; row < std::min(first + kBandRows, grid().height); ++row)
      for (int column = 0; column < grid().width; ++column) {
        const maps::Cell cell{column, row};
        const std::size_t i = band.index(cell);
        const GroundShape shape{m.dz_dx.values()[i], m.dz_dy.values()[i], m.roughness_m.values()[i],
                                m.step_m.values()[i]};
        hazards_[cell] = judge(shape) | layerHazards(layers, grid().index(cell));
        slot(cell) =
            CellCode({.dz_dx = static_cast<double>(shape.dz_dx), .dz_dy = static_cast<double>(shape.dz_dy)});
      }
    watch.report(static_cast<double>(first + kBandRows) / grid().height);
  }
  const bool unknown_opens = site_->model->parts().policy.allow_unknown;
  inflate(hazards_, limits_, unknown_opens ? Hazard::KeepOut | Hazard::Obstacle : kKeptClearOf);
  for (int row = 0; row < grid().height; ++row)
    for (int column = 0; column < grid().width; ++column) {
      CellCode& code = slot({column, row});
      code = coded({column, row}, code);
    }
  return TileTable(std::vector<TileTable::Shared>(tiles.begin(), tiles.end()));
}

CellCode TraversabilityMap::coded(maps::Cell cell, CellCode code) {
  const Hazard found = hazards_[cell];
  if (found == Hazard::None) return code.withCurve(curves_->number(cell));
  if (found != Hazard::Unknown) return code.withCurve(CellCode::kBlocked);
  const bool open = model().parts().policy.allow_unknown;
  return code.withCurve(open ? curves_->table().prior(0) : CellCode::kUnknown);
}

std::shared_ptr<const CostGrid> TraversabilityMap::published() const noexcept {
  return published_->grid.load();
}

int TraversabilityMap::classNumber(maps::Cell cell) const noexcept {
  return site_->classes.empty() ? 0 : site_->classes[cell];
}

int TraversabilityMap::classIndex(maps::Cell cell) const noexcept {
  return site_->classIndex(cell);
}

std::optional<GroundBelief> TraversabilityMap::ground(maps::Cell cell) const {
  const int index = classIndex(cell);
  if (index < 0) return std::nullopt;
  return EvidenceField::Beliefs(field_).at(cell, index).ground;
}

std::optional<GroundBelief> TraversabilityMap::publishedGround(maps::Cell cell) const {
  const std::uint8_t number = code(cell).curve();
  if (number >= CellCode::kUnknown) return std::nullopt;
  return curves_->table().belief(number);
}

CellBelief TraversabilityMap::belief(maps::Cell cell) const {
  EvidenceField::Beliefs beliefs(field_);
  return belief(cell, beliefs);
}

CellBelief TraversabilityMap::belief(maps::Cell cell, EvidenceField::Beliefs& beliefs) const {
  CellBelief belief;
  belief.terrain_class = static_cast<std::uint8_t>(classNumber(cell));
  belief.hazards = hazards_[cell];
  const int index = classIndex(cell);
  if (index < 0) return belief;
  belief.terrain_class =
      static_cast<std::uint8_t>(model().parts().classes[static_cast<std::size_t>(index)].number);
  tell(beliefs.at(cell, index).ground, belief);
  if (const BlockEvidence* own = field_.evidence(cell)) tell(*own, field_.samplesOf(cell), belief);
  const CellCode code = this->code(cell);
  if (code.curve() < CellCode::kUnknown) {
    const auto entry = curves_->table().categories(code.curve()).at(code);
    belief.category = entry.category;
    belief.confidence = entry.confidence;
  } else if (!has(belief.hazards, Hazard::Unknown)) {
    belief.category = static_cast<std::uint8_t>(terramech::Category::Dangerous);
    belief.confidence = 16;
  }
  return belief;
}

CellBelief TraversabilityMap::belief(maps::Cell cell, const Floor& floor) const {
  CellBelief belief;
  belief.terrain_class = static_cast<std::uint8_t>(model().parts().classes[0].number);
  belief.hazards = Hazard::Unknown;
  tell(field_.floorBelief(cell, floor), belief);
  if (const BlockEvidence* own = field_.evidence(cell, floor))
    tell(*own, field_.samplesOf(cell, floor), belief);
  return belief;
}

CategoryCounts TraversabilityMap::countCategories() const {
  std::array<std::size_t, 4> counts{};
  const auto published = this->published();
  for (int row = 0; row < grid().height; ++row)
    for (int column = 0; column < grid().width; ++column) ++counts[categoryOf(*published, {column, row})];
  return {counts[0], counts[1], counts[2], counts[3]};
}

std::uint8_t TraversabilityMap::categoryOf(const CostGrid& grid, maps::Cell cell) const noexcept {
  const CellCode code = grid.at(cell);
  if (code.curve() < CellCode::kUnknown) return curves_->table().categories(code.curve()).at(code).category;
  return static_cast<std::uint8_t>(has(hazards_[cell], Hazard::Unknown) ? terramech::Category::Unknown
                                                                        : terramech::Category::Dangerous);
}

bool TraversabilityMap::learn(const WheelObservation& observation) {
  const auto range = field_.add(observation);
  if (range) learned_ = joined(std::move(learned_), *range);
  return range.has_value();
}

void TraversabilityMap::refuse(const maps::Point& place, double radius_m) {
  const double cell_m = grid().resolution_m;
  const auto clamped = [](double value, int cells) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(cells - 1)));
  };
  const double x = (place.x_m - grid().south_west.x_m) / cell_m,
               y = (place.y_m - grid().south_west.y_m) / cell_m;
  const double reach = radius_m / cell_m;
  const maps::CellBox range{{clamped(x - reach, grid().width), clamped(y - reach, grid().height)},
                            {clamped(x + reach, grid().width), clamped(y + reach, grid().height)}};
  for (int row = range.first.row; row <= range.last.row; ++row)
    for (int column = range.first.column; column <= range.last.column; ++column) {
      const maps::Point centre = grid().centre({column, row});
      if (std::hypot(centre.x_m - place.x_m, centre.y_m - place.y_m) <= radius_m)
        hazards_[{column, row}] |= Hazard::Obstacle;
    }
  refused_.push_back(range);
}

void TraversabilityMap::publish() {
  publish(std::exchange(learned_, {}));
}

void TraversabilityMap::publishAll() {
  curves_->restart(0);
  learned_.clear();
  refused_ = {everywhere()};
  publish({everywhere()});
}

void TraversabilityMap::publish(std::vector<maps::CellBox> learned) {
  std::vector<maps::CellBox> changed = std::exchange(refused_, {});
  const bool any = !learned.empty() || !changed.empty();
  const auto append = [](std::vector<maps::CellBox>& to, const std::vector<maps::CellBox>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  const bool classes_moved = curves_->learnClasses(field_);
  if (!any && !classes_moved) return;
  if (classes_moved) append(learned, curves_->learnedBoxes());
  EvidenceField::Beliefs beliefs(field_);
  append(changed, curves_->learn(beliefs, learned));
  if (classes_moved) append(changed, curves_->mixedRanges());
  std::shared_ptr<const CostGrid> next = rewritten(changed);
  const bool coarser_exists = curves_->table().level() < GroundKind::kCoarsest;
  published_->grid = curves_->table().overflowed() && coarser_exists ? renumbered() : std::move(next);
}

// In the finest steps that leave room for what is yet to be learned.
std::shared_ptr<const CostGrid> TraversabilityMap::renumbered() {
  constexpr double kFull = 0.75;
  for (int level = 0;; ++level) {
    curves_->restart(level);
    auto next = rewritten({everywhere()});
    const bool room = !curves_->table().overflowed() && curves_->table().used() <= kFull;
    if (room || level == GroundKind::kCoarsest) return next;
  }
}

// The cost is asked for after the codes are made: they may bring new curves.
std::shared_ptr<const CostGrid> TraversabilityMap::rewritten(const std::vector<maps::CellBox>& ranges) {
  return std::make_shared<CostGrid>(
      revised(*published(), {.ranges = ranges,
                             .code = [&](maps::Cell cell, CellCode code) { return coded(cell, code); },
                             .cost = [&] { return curves_->table().cost(); }}));
}

std::vector<FloorLeaf> TraversabilityMap::floorLeaves() const {
  std::vector<FloorLeaf> leaves;
  for (const auto& [cell, own] : field_.floorEvidence()) {
    octomap::OcTreeKey key = keys().key(cell, keys().baseElevation_m());
    key[2] = own.level;
    leaves.push_back(
        {key, belief(cell, Floor{.cell = static_cast<std::uint32_t>(grid().index(cell)),
                                 .height_m = static_cast<float>(keys().heightOf_m(own.level))})});
  }
  return leaves;
}

TraversabilityTree TraversabilityMap::tree() const {
  EvidenceField::Beliefs beliefs(field_);
  return surfaceTree({site_->elevation.elevation_m, site_->keys, floorLeaves()},
                     [&](maps::Cell cell) { return belief(cell, beliefs); });
}

void TraversabilityMap::writeTree(std::ostream& stream) const {
  EvidenceField::Beliefs beliefs(field_);
  writeSurfaceTree(
      {site_->elevation.elevation_m, site_->keys, floorLeaves()},
      [&](maps::Cell cell) { return belief(cell, beliefs); }, stream);
}

}  // namespace talus::costmap
