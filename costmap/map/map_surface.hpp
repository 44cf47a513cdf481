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

/// Options for measuring the terrain shape of cells.
struct ShapeOptions {
  /// Radius of the disc of cells over which slope and roughness are measured, > 0.
  double footprint_radius_m = 0.0;
  int threads = 1;  ///< number of threads, >= 1; the result does not depend on this number
};

/// Surface of a map: elevation, terrain classes, cost layers, and the hazards of each cell, including ground
/// declared impassable. The surface is independent of evidence and cost. Concurrent const calls are safe
/// while no thread changes the surface; only the map changes the surface.
class MapSurface {
 public:
  /// Makes the surface from `layers`. Hazards are computed later, by measure(). Throws std::invalid_argument
  /// if a layer has another grid than the elevation, or an invalid value.
  MapSurface(MapLayers layers, std::shared_ptr<const GroundModel> model, const ShapeOptions& options);

  const maps::Grid& grid() const noexcept { return site_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return site_->elevation; }
  const GroundModel& model() const noexcept { return *site_->model; }
  /// Returns elevation, terrain classes and layers, which the map shares with its evidence.
  std::shared_ptr<const GroundSite> site() const noexcept { return site_; }
  const SurfaceKeys& keys() const noexcept { return site_->keys; }

  const maps::Raster<std::uint8_t>& classes() const noexcept { return site_->classes; }
  /// Returns the terrain-class number of a cell; 0 without a class raster.
  int classNumber(maps::Cell cell) const noexcept {
    return site_->classes.empty() ? 0 : site_->classes[cell];
  }
  /// Returns the index of the cell's terrain class in model().parts().classes; -1 for a class without a soil.
  int classIndex(maps::Cell cell) const noexcept { return site_->classIndex(cell); }
  const std::vector<CostLayer>& costLayers() const noexcept { return site_->costs; }

  const maps::Raster<Hazard>& hazards() const noexcept { return hazards_; }
  Hazard hazards(maps::Cell cell) const noexcept { return hazards_[cell]; }
  const HazardLimits& limits() const noexcept { return limits_; }
  /// Returns the hazards by rocks, keep-out areas and ground declared impassable, without the clearance
  /// around them (Hazard::Near); empty if the map contains none of these hazards.
  const maps::Raster<Hazard>& declared() const noexcept { return declared_; }
  /// Returns the places declared impassable, in the order of their declaration.
  const std::vector<RefusedPlace>& refused() const noexcept { return refused_; }

  double footprintRadius_m() const noexcept { return options_.footprint_radius_m; }
  int threads() const noexcept { return options_.threads; }
  /// Returns the options of maps::terrainMetrics() for `threads` threads (>= 1).
  maps::FootprintOptions footprint(int threads) const noexcept {
    return {
        .radius_m = options_.footprint_radius_m, .step_span_m = limits_.wheel_diameter_m, .threads = threads};
  }

  /// Callback with a cell and its code. The code has the gradients of the fitted plane, and no cost curve.
  using TakeShape = std::function<void(maps::Cell, CellCode)>;
  /// Measures the whole surface: computes the hazards of all cells, and calls `take` with the gradients of
  /// each cell.
  void measure(const TakeShape& take, const ProgressMonitor& watch);

  /// Gradients of the cells of `box`: `codes` has one cell code for each cell of the box. The codes have no
  /// cost curve.
  struct Gradients {
    maps::CellBox box;
    maps::Raster<CellCode> codes;
  };
  /// Cells that a patch (new observation of a window of the ground) changed.
  struct PatchEffect {
    maps::CellBox window;  ///< box of cells that the patch covers
    maps::CellBox judged;  ///< box of cells whose hazards or gradients may have changed
    Gradients gradients;   ///< gradients of the cells that were measured again
  };
  /// Replaces the surface in the window of a patch, and measures all affected cells again. Throws
  /// std::invalid_argument, with location and remedy, for an invalid patch; the surface is then unchanged.
  PatchEffect take(const SurfacePatch& patch);

  /// Marks the cells of a place as obstacles (impassable), and returns the bounding box of these cells.
  maps::CellBox refuse(const RefusedPlace& place);
  /// Removes the places that the wheels of a drive declared, and returns their bounding boxes.
  std::vector<maps::CellBox> leaveOut(std::uint16_t drive);

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
  maps::Raster<Hazard> declared_;  // hazards by layers other than elevation and terrain classes
  maps::Raster<Hazard> hazards_;
  std::vector<RefusedPlace> refused_;
};

}  // namespace talus::costmap
