#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Slip on one terrain: slip = offset +- gain theta^2 plus a Gaussian error, with theta the slope along the
/// heading in degrees and + for ascent. Curves and parameter ranges are those of Endo et al. 2023
/// [endo_2023].
struct SlipTerrain {
  double gain_deg2 = 0.0;  ///< slip per square degree, 0 to 8e-3
  double offset = 0.0;     ///< slip on level ground, 0 to 0.1 [-]
  double noise = 0.05;     ///< standard deviation of a cell's slip from the curve, 0.05 to 0.2 [-]

  /// Returns the mean slip [-] on a gradient (rise over run) along the heading.
  double slip(double gradient) const noexcept;
};

/// Parameters of a slip world and of the planner's knowledge.
struct SlipWorldOptions {
  int side = 96;                        ///< side length in cells of 1 m, >= 8
  std::uint64_t seed = 1;               ///< equal seeds give equal worlds
  double misclassification_rate = 0.2;  ///< share of the cells assigned to a wrong terrain, 0 to 1
  double relief_m = 4.0;                ///< amplitude of the longest undulation, half the map long, >= 0
  bool risk_aware = true;  ///< the cost is the conditional value at risk of the possible terrains of a cell
  double tail = 0.1;       ///< share of the highest slips averaged if risk_aware, in (0, 1]
};

/// Heterogeneous terrain with known slip curves but misclassified cells [endo_2023]: fractal relief and four
/// of ten terrains, covering 40, 40, 10 and 10 % of the map. The planners' map has the drive time as cost (1
/// W times the time) at a rim speed of 0.1 m/s reduced by slip; headings with a planned slip of 1 or more are
/// blocked. The planned slip is either that of the classified terrain, or the conditional value at risk of
/// the mixture of the terrains that the cell may have [rockafellar_uryasev_2000]. No classifier is trained:
/// its errors are drawn at random, and the error rate is given to the planner.
struct SlipWorld {
  std::vector<SlipTerrain> terrains;
  maps::Raster<std::uint8_t> truth;  ///< true terrain of each cell
  maps::Raster<std::uint8_t> seen;   ///< classified terrain of each cell
  maps::Raster<float> error;         ///< deviation of each cell's slip from its terrain's curve [-]
  std::shared_ptr<const costmap::CostGrid> map;
};

/// Draws a world. Throws std::invalid_argument if an option is out of range.
SlipWorld slipWorld(const SlipWorldOptions& options);

/// Result of driving a route in a slip world.
struct SlipTraverse {
  bool reached = false;   ///< false: the rover was immobilised, spinning or sliding: |slip| >= 1 on some cell
  double time_s = 0.0;    ///< at 0.1 m/s rim speed, to the goal or to the place of immobilisation
  double max_slip = 0.0;  ///< largest magnitude on the route, at most 1 [-]
};

/// Drives a route over the true terrains, cell by cell.
SlipTraverse driven(const SlipWorld& world, const std::vector<maps::Point>& route);

}  // namespace talus::planner
