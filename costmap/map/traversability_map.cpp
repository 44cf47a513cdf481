#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/published_map.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/site/surface_patch.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace {

constexpr double kFull = 0.75;  // share of the curves' numbers from which on there is no room for more

double footprintRadius(const TraversabilityMap::Options& options, const terramech::Rover& rover) {
  return options.footprint_radius_m > 0.0 ? options.footprint_radius_m
                                          : 0.5 * std::hypot(rover.wheelbase_m, rover.track_m);
}

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
  const SurfaceKeys keys(layers.elevation.grid(), middleElevation(layers.elevation.elevation_m));
  return std::make_shared<GroundSite>(GroundSite{.elevation = std::move(layers.elevation),
                                                 .classes = std::move(layers.classes),
                                                 .keys = keys,
                                                 .model = std::move(model),
                                                 .floors = std::move(layers.floors),
                                                 .costs = std::move(layers.costs)});
}

// Ranges of a drive overlap: neighbours in time are joined where that covers little more than both.
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

TraversabilityMap::TraversabilityMap(TraversabilityMap&&) noexcept = default;
TraversabilityMap::~TraversabilityMap() = default;

TraversabilityMap::TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model,
                                     const Options& options, const ProgressMonitor& watch)
    : site_(siteOf(layers, std::move(model))),
      limits_(HazardLimits::of(site_->model->rover())),
      footprint_radius_m_(footprintRadius(options, site_->model->rover())),
      threads_(options.threads),
      hazards_(grid(), Hazard::None),
      curves_(std::make_unique<GroundCurves>(site_)),
      field_(site_),
      published_(std::make_unique<PublishedMap>()) {
  requireGrid(site_->classes, grid(), "classes");
  requireGrid(layers.rock_abundance, grid(), "rock_abundance");
  requireGrid(layers.keep_out, grid(), "keep_out");
  requireGrid(layers.declared, grid(), "declared");
  any_height_ = !site_->floors.empty() || std::ranges::any_of(site_->elevation.elevation_m.values(),
                                                              [](float e) { return !std::isnan(e); });
  published_->grid.store(
      std::make_shared<CostGrid>(CostGrid::Content{.grid = grid(),
                                                   .tiles = measure(layers, watch),
                                                   .cost = curves_->table().cost(),
                                                   .version = 1,
                                                   .elevation_m = tiled(site_->elevation.elevation_m)}));
  if (curves_->table().overflowed()) published_->grid.store(renumbered());
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
  const MapChange change(*published_, "learn");
  const auto range = field_.add(observation);
  if (range) learned_ = joined(std::move(learned_), *range);
  return range.has_value() || (observation.here.any() && refuseUnobserved(observation));
}

void TraversabilityMap::forget(const SavedBlock& heard) {
  const MapChange change(*published_, "forget");
  if (const auto range = field_.forget(heard)) learned_ = joined(std::move(learned_), *range);
}

// In blocks, so that a wheel that spins on the spot is one place.
bool TraversabilityMap::refuseUnobserved(const WheelObservation& observation) {
  const double side_m = field_.blockCells() * grid().resolution_m;
  const maps::Point origin = grid().south_west;
  const auto middle = [&](double at, double from) {
    return from + (std::floor((at - from) / side_m) + 0.5) * side_m;
  };
  const RefusedPlace refusal{
      {middle(observation.place.x_m, origin.x_m), middle(observation.place.y_m, origin.y_m)},
      side_m + EvidenceField::kPoseReach * std::max(observation.pose_std_m, 0.0)};
  const double x = std::clamp(refusal.place.x_m, origin.x_m, origin.x_m + grid().width * grid().resolution_m),
               y = std::clamp(refusal.place.y_m, origin.y_m,
                              origin.y_m + grid().height * grid().resolution_m);
  if (!(std::hypot(refusal.place.x_m - x, refusal.place.y_m - y) <= refusal.radius_m)) return false;
  const bool known = std::ranges::any_of(refusals_, [&](const RefusedPlace& other) {
    return other.place == refusal.place && other.radius_m >= refusal.radius_m;
  });
  if (known) return true;
  refusals_.push_back(refusal);
  changed_.push_back(mark(refusal, true));
  return true;
}

bool TraversabilityMap::restore(const SavedBlock& saved) {
  const auto range = field_.restore(saved);
  if (range) learned_ = joined(std::move(learned_), *range);
  return range.has_value();
}

void TraversabilityMap::publish() {
  const MapChange change(*published_, "publish");
  publish(std::exchange(learned_, {}));
}

void TraversabilityMap::publishAll() {
  const MapChange change(*published_, "publishAll");
  curves_->restart(0);
  learned_.clear();
  changed_ = {allOf(grid())};
  publish({allOf(grid())}, true);
}

void TraversabilityMap::publish(std::vector<maps::CellBox> learned, bool whole) {
  std::vector<maps::CellBox> changed = std::exchange(changed_, {});
  const bool any = !learned.empty() || !changed.empty();
  const auto append = [](std::vector<maps::CellBox>& to, const std::vector<maps::CellBox>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  const GroundCurves::ClassChange moved = curves_->learnClasses(field_);
  if (moved.learned && !whole) append(learned, field_.reached());
  if (!any && !moved.priors && learned.empty()) return;
  EvidenceField::Beliefs beliefs(field_, EvidenceField::Classes::InSteps);
  append(changed, curves_->learn(beliefs, learned));
  if (moved.priors) append(changed, curves_->mixedRanges());
  published_->grid.store(costed(changed));
  measured_.reset();
}

// No cheaper than all of it at once. At the finest level each curve is that of its kind, whatever came before; at a coarser
// one that leaves room, all at once would take that level or a finer one. What is left cannot be compared: all of it anew.
std::shared_ptr<const CostGrid> TraversabilityMap::costed(const std::vector<maps::CellBox>& changed) {
  std::shared_ptr<const CostGrid> next = rewritten(changed);
  const bool extreme = curves_->level() == 0 || curves_->level() == curves_->coarsest();
  const bool room = extreme || curves_->table().used() <= kFull;
  return curves_->table().overflowed() || !room ? renumbered() : next;
}

// In the finest steps that leave room for what is yet to be learned.
std::shared_ptr<const CostGrid> TraversabilityMap::renumbered() {
  for (int level = 0;; ++level) {
    curves_->restart(level);
    auto next = rewritten({allOf(grid())});
    const bool room = !curves_->table().overflowed() && curves_->table().used() <= kFull;
    if (room || level == curves_->coarsest()) return next;
  }
}

// The cost is asked for after the codes are made: they may bring new curves.
std::shared_ptr<const CostGrid> TraversabilityMap::rewritten(const std::vector<maps::CellBox>& ranges) {
  return std::make_shared<CostGrid>(revised(
      *published(), {.ranges = ranges,
                     .code = [&](maps::Cell cell, CellCode code) { return coded(cell, code); },
                     .cost = [&] { return curves_->table().cost(); },
                     .elevation_m = measured_ ? std::optional(measured_->elevation_m) : std::nullopt}));
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
