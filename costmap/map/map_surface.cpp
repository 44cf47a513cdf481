#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/costmap.hpp>
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

}  // namespace talus::costmap
