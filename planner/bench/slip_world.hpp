#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// What a rover slips on one terrain: slip = offset +- gain theta^2 with theta the slope along the heading in
/// degrees, climbing +, plus a Gaussian error. The curves and the ranges that they are drawn from are those
/// of Endo et al. 2023 [endo_2023].
struct SlipTerrain {
  double gain_deg2 = 0.0;  ///< slip per square degree, 0 to 8e-3
  double offset = 0.0;     ///< slip on the level, 0 to 0.1 [-]
  double noise = 0.05;     ///< standard deviation of the slip on a cell about the curve, 0.05 to 0.2 [-]

  /// Mean slip on a gradient along the heading (rise over run) [-].
  double slip(double gradient) const noexcept;
};

/// How a slip world is sampled and what the planner knows of it.
struct SlipWorldOptions {
  int side = 96;                        ///< cells of a metre, >= 8
  std::uint64_t seed = 1;               ///< same seed, same world
  double misclassification_rate = 0.2;  ///< share of the ground that is taken for another terrain, 0 to 1
  double relief_m = 4.0;                ///< amplitude of the longest swells, half the map long, >= 0
  bool risk_aware = true;  ///< the belief mixes the terrains that a cell may be and looks at the tail
  double tail = 0.1;       ///< share of the worst slips that the cost looks at then, in (0, 1]
};

/// Heterogeneous ground whose slip the planner knows by terrain, where it may take one terrain for another
/// [endo_2023]: fractal relief, four of ten terrains in blotches of 40, 40, 10 and 10 % of the map. The map
/// that planners get costs seconds (1 W times the time): at 0.1 m/s less what slips; slopes on which the
/// believed slip reaches 1 are closed. The belief is either the slip of the terrain seen, or the conditional
/// value at risk of the mixture of the terrains that the cell may be [rockafellar_uryasev_2000]. No
/// classifier is trained here: its errors are drawn, and planners are told how common they are.
struct SlipWorld {
  std::vector<SlipTerrain> terrains;
  maps::Raster<std::uint8_t> truth;  ///< terrain of each cell
  maps::Raster<std::uint8_t> seen;   ///< what it is taken for
  maps::Raster<float> error;         ///< slip of each cell about its terrain's curve [-]
  std::shared_ptr<const costmap::CostGrid> map;
};

/// Draws a world. Throws std::invalid_argument for an option out of range.
SlipWorld slipWorld(const SlipWorldOptions& options);

/// How a route over a slip world went.
struct SlipDrive {
  bool reached = false;   ///< false: the rover stood still, spinning or sliding: |slip| >= 1 on some cell
  double time_s = 0.0;    ///< at 0.1 m/s of rim speed, to the goal or to where it stood
  double max_slip = 0.0;  ///< largest magnitude met, at most 1 [-]
};

/// Drives a route over the true terrains, cell by cell.
SlipDrive driven(const SlipWorld& world, const std::vector<maps::Point>& route);

}  // namespace talus::planner
