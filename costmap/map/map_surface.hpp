#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// Options for measuring the terrain shape.
struct ShapeOptions {
  double footprint_radius_m = 0.0;  ///< radius of the disc for slope and roughness, > 0
  int threads = 1;                  ///< >= 1; the result does not depend on the number of threads
};

/// Site and surface of a map: elevation, terrain classes, floors, cost layers, and the hazards of each cell
/// including refused places. Independent of evidence and cost. Concurrent const calls are safe while no
/// thread changes the surface; only the map changes the surface.
class MapSurface {
 public:
  /// Throws std::invalid_argument if a layer has another grid or an invalid value. Hazards are computed by
  /// measure().
  MapSurface(MapLayers layers, std::shared_ptr<const GroundModel> model, const ShapeOptions& options);

  const maps::Grid& grid() const noexcept { return site_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return site_->elevation; }
  const GroundModel& model() const noexcept { return *site_->model; }
  /// Elevation, classes and layers, shared with the evidence.
  std::shared_ptr<const GroundSite> site() const noexcept { return site_; }
  const SurfaceKeys& keys() const noexcept { return site_->keys; }

  const maps::Raster<std::uint8_t>& classes() const noexcept { return site_->classes; }
  /// Class number in the raster; 0 without a raster.
  int classNumber(maps::Cell cell) const noexcept {
    return site_->classes.empty() ? 0 : site_->classes[cell];
  }
  /// Returns the index of the cell's class in model().parts().classes; -1 without a class.
  int classIndex(maps::Cell cell) const noexcept { return site_->classIndex(cell); }
  /// Class index of the ground at a height; the first class for a floor beneath the surface.
  int classIndex(maps::Cell cell, double z_m) const noexcept {
    return floorAt(cell, z_m) ? 0 : classIndex(cell);
  }
  const std::vector<CostLayer>& costLayers() const noexcept { return site_->costs; }

  /// Ground beneath the top surface. The cost grid covers the top surface only.
  const Floors& floors() const noexcept { return site_->floors; }
  /// Floor at a height; nullopt if the height belongs to the top surface.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return site_->floorAt(cell, z_m);
  }

  const maps::Raster<Hazard>& hazards() const noexcept { return hazards_; }
  Hazard hazards(maps::Cell cell) const noexcept { return hazards_[cell]; }
  const HazardLimits& limits() const noexcept { return limits_; }
  /// Hazards by rocks, keep-out areas and refused places, without clearance; empty if the map contains none
  /// of these hazards.
  const maps::Raster<Hazard>& declared() const noexcept { return declared_; }
  /// Returns the places declared impassable, in order.
  const std::vector<RefusedPlace>& refused() const noexcept { return refused_; }

  double footprintRadius_m() const noexcept { return options_.footprint_radius_m; }
  int threads() const noexcept { return options_.threads; }
  /// Options of maps::terrainMetrics() for `threads` threads (>= 1).
  maps::FootprintOptions footprint(int threads) const noexcept {
    return {
        .radius_m = options_.footprint_radius_m, .step_span_m = limits_.wheel_diameter_m, .threads = threads};
  }

  /// Callback with the gradient of a cell, as a code without a curve.
  using TakeShape = std::function<void(maps::Cell, CellCode)>;
  /// Measures the whole surface: hazards and gradients of all cells.
  void measure(const TakeShape& take, const ProgressMonitor& watch);

  /// Gradients of the cells of `box`: `codes` has one code for each cell of the box; the codes have no curve.
  struct Gradients {
    maps::CellBox box;
    maps::Raster<CellCode> codes;
  };
  /// Cells changed by a patch.
  struct PatchEffect {
    maps::CellBox window;  ///< cells covered by the patch
    maps::CellBox judged;  ///< cells whose hazards or gradients may have changed
    Gradients gradients;   ///< gradients of the cells measured again
  };
  /// Replaces the surface in a window and measures all affected cells again. Throws std::invalid_argument
  /// with place and remedy for an invalid patch; the surface is then unchanged.
  PatchEffect take(const SurfacePatch& patch);

  /// Marks the cells of a place as obstacles. Returns the bounding box of the cells.
  maps::CellBox refuse(const RefusedPlace& place);

 private:
  // Cell code (gradients and index of the cost curve) and hazards of a measured cell.
  struct Ground {
    CellCode code;
    Hazard hazards;
  };
  Ground grounded(maps::Cell cell, const GroundShape& shape, Hazard found) const;
  maps::CellBox mark(const RefusedPlace& refusal, bool refused);
  void takeHazards(const SurfacePatch& patch, const maps::CellBox& window);
  void takeGround(const SurfacePatch& patch, const maps::CellBox& window);
  Hazard layerHazards(maps::Cell cell) const;
  Hazard rocksOn(float abundance) const;
  Hazard spreading() const noexcept;

  std::shared_ptr<GroundSite> site_;
  HazardLimits limits_;
  ShapeOptions options_;
  bool any_height_ = false;
  maps::Raster<Hazard> declared_;  // hazards by layers other than elevation and classes
  maps::Raster<Hazard> hazards_;
  std::vector<RefusedPlace> refused_;
};

}  // namespace talus::costmap
