#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// How the shape of the ground is measured.
struct ShapeOptions {
  double footprint_radius_m = 0.0;  ///< disc that slope and roughness are measured over, > 0
  int threads = 1;                  ///< >= 1; the result does not depend on it
};

/// The site of a map and its surface: elevation, terrain classes, levels, cost layers and the hazards of each cell, declared
/// places included. Knows neither evidence nor cost. Const members may be called from several threads while none changes it;
/// only the map changes it.
class MapSurface {
 public:
  /// Throws std::invalid_argument when a layer lies on another grid or holds an impossible value. Hazards are those of no
  /// cell until measure().
  MapSurface(MapLayers layers, std::shared_ptr<const GroundModel> model, const ShapeOptions& options);

  const maps::Grid& grid() const noexcept { return site_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return site_->elevation; }
  const GroundModel& model() const noexcept { return *site_->model; }
  /// Elevation, classes and layers, shared with the evidence.
  std::shared_ptr<const GroundSite> site() const noexcept { return site_; }
  const SurfaceKeys& keys() const noexcept { return site_->keys; }

  const maps::Raster<std::uint8_t>& classes() const noexcept { return site_->classes; }
  /// Class number in the raster, 0 where there is no raster.
  int classNumber(maps::Cell cell) const noexcept {
    return site_->classes.empty() ? 0 : site_->classes[cell];
  }
  /// Position of the cell's class in model().parts().classes, or -1.
  int classIndex(maps::Cell cell) const noexcept { return site_->classIndex(cell); }
  /// The same of the ground at a height there, which is the first class beneath an overhang.
  int classIndex(maps::Cell cell, double z_m) const noexcept {
    return floorAt(cell, z_m) ? 0 : classIndex(cell);
  }
  const std::vector<CostLayer>& costLayers() const noexcept { return site_->costs; }

  /// Ground beneath the top surface. It is no part of the cost grid: a planner drives on top.
  const Floors& floors() const noexcept { return site_->floors; }
  /// The floor that something at this height stands on; nothing where that is the top surface.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return site_->floorAt(cell, z_m);
  }

  const maps::Raster<Hazard>& hazards() const noexcept { return hazards_; }
  Hazard hazards(maps::Cell cell) const noexcept { return hazards_[cell]; }
  const HazardLimits& limits() const noexcept { return limits_; }
  /// Hazards by rocks, keep-out areas and declared places, without the clearance around them; an empty raster if the map has none.
  const maps::Raster<Hazard>& declared() const noexcept { return declared_; }
  /// Places that were declared impassable, in order.
  const std::vector<RefusedPlace>& refused() const noexcept { return refused_; }

  double footprintRadius_m() const noexcept { return options_.footprint_radius_m; }
  int threads() const noexcept { return options_.threads; }
  /// How the shape of the ground is measured, on a number of threads >= 1.
  maps::FootprintOptions footprint(int threads) const noexcept {
    return {
        .radius_m = options_.footprint_radius_m, .step_span_m = limits_.wheel_diameter_m, .threads = threads};
  }

  /// Receives the gradient of a cell, as a code without a curve.
  using TakeShape = std::function<void(maps::Cell, CellCode)>;
  /// Measures all of it: hazards of every cell, and its gradients.
  void measure(const TakeShape& take, const ProgressMonitor& watch);

  /// Gradients of a box, as codes without a curve on a grid of the box's own.
  struct Gradients {
    maps::CellBox box;
    maps::Raster<CellCode> codes;
  };
  /// What a patch changes.
  struct PatchEffect {
    maps::CellBox window;  ///< covered by the patch
    maps::CellBox judged;  ///< in which hazards or gradients may have changed
    Gradients gradients;   ///< of the cells that were measured again
  };
  /// Replaces the surface in a window and measures the cells that it reaches again. Throws std::invalid_argument, in one
  /// line with place and remedy, for a patch that does not fit; the surface stays as it was.
  PatchEffect take(const SurfacePatch& patch);

  /// Marks the cells of a place as obstacles. Returns the box around them.
  maps::CellBox refuse(const RefusedPlace& place);

 private:
  // What a shape is to planners.
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
  maps::Raster<Hazard> declared_;  // by layers other than elevation and classes
  maps::Raster<Hazard> hazards_;
  std::vector<RefusedPlace> refused_;
};

}  // namespace talus::costmap
