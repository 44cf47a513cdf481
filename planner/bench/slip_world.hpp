#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::planner {

/// Slip curve of one terrain: slip = offset +- gain theta^2 plus a Gaussian error, where theta is the slope
/// along the heading in degrees, with + for ascent and - for descent. Curves and parameter ranges are those
/// of Endo et al. 2023 [endo_2023].
struct SlipTerrain {
  double gain_deg2 = 0.0;  ///< increase of slip per square degree of slope, 0 to 8e-3
  double offset = 0.0;     ///< slip on level ground, 0 to 0.1 [-]
  double noise = 0.05;     ///< standard deviation of the slip of a cell from the curve, 0.05 to 0.2 [-]

  /// Returns the mean slip [-] for a gradient (rise over run) along the heading.
  double slip(double gradient) const noexcept;
};

/// Parameters of a slip world and of the knowledge of the planner.
struct SlipWorldOptions {
  int side = 96;                        ///< side length of the map [cells of 1 m], >= 8
  std::uint64_t seed = 1;               ///< equal seeds give equal worlds
  double misclassification_rate = 0.2;  ///< share of the cells that are classified as a wrong terrain, 0 to 1
  /// Amplitude of the longest undulation, whose wavelength is half the side length, >= 0.
  double relief_m = 4.0;
  /// true: the cost uses the conditional value at risk of slip over the possible terrains of a cell.
  bool risk_aware = true;
  /// Share of the highest slips over which the conditional value at risk is the mean, in (0, 1].
  double tail = 0.1;
};

/// Heterogeneous terrain with known slip curves and misclassified cells [endo_2023]: fractal relief, and four
/// of ten terrains, which cover 40, 40, 10 and 10 % of the map. The cost on the map of the planners is the
/// driving time (times 1 W) at a rim speed of 0.1 m/s reduced by slip; headings with a planned slip of 1 or
/// more are blocked. The planned slip is either that of the classified terrain, or the conditional value at
/// risk of the mixture of terrains that the cell may have [rockafellar_uryasev_2000]. No classifier is
/// trained: classification errors are drawn at random, and the planner knows the error rate.
struct SlipWorld {
  std::vector<SlipTerrain> terrains;  ///< slip curves of the terrains
  maps::Raster<std::uint8_t> truth;   ///< index in `terrains` of the true terrain of each cell
  maps::Raster<std::uint8_t> seen;    ///< index in `terrains` of the classified terrain of each cell
  maps::Raster<float> error;  ///< deviation of the slip of each cell from the curve of its terrain [-]
  std::shared_ptr<const costmap::CostGrid> map;  ///< cost map of the planners
};

/// Returns a world drawn at random. Throws std::invalid_argument if an option is out of range.
SlipWorld slipWorld(const SlipWorldOptions& options);

/// Result of driving a route in a slip world.
struct SlipTraverse {
  /// false: the rover was immobilised, because |slip| >= 1 (spinning or sliding) on some cell.
  bool reached = false;
  /// Driving time at a rim speed of 0.1 m/s, to the goal or to the place of immobilisation.
  double time_s = 0.0;
  double max_slip = 0.0;  ///< largest magnitude of slip on the route, at most 1 [-]
};

/// Simulates the drive of a route over the true terrains, cell by cell.
SlipTraverse driven(const SlipWorld& world, const std::vector<maps::Point>& route);

}  // namespace talus::planner
