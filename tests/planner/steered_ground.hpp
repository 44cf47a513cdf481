#pragma once

#include <cmath>

#include "drawn_map.hpp"

namespace talus::planner::testing {

/// The test cost in which only gradients along the heading within a band are allowed.
inline std::shared_ptr<const costmap::TravelCost> onlyAlong(double least, double most) {
  const costmap::TravelCurve all = curve({});
  const auto allowed = [&](double along) {
    return along < least || along > most ? std::numeric_limits<float>::infinity() : all.price(along, 0.0);
  };
  return std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curveOf(allowed)});
}

/// Nine by nine cells of one metre that fall southwards overall and may only be driven down: every cell has
/// a cone of headings.
inline std::shared_ptr<const costmap::CostGrid> randomDescent(unsigned seed) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  maps::Raster<costmap::CellCode> cells({.width = 9, .height = 9, .resolution_m = 1.0, .south_west = {}});
  for (auto& cell : cells.values()) {
    const bool blocked = unit() < 0.12;
    cell = costmap::CellCode({.dz_dx = 0.3 * (unit() - 0.5),
                              .dz_dy = 0.05 + 0.15 * unit(),
                              .curve = blocked ? costmap::CellCode::kBlocked : costmap::CellCode::Curve{0}});
  }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, onlyAlong(-1.0, -1.0 / 512.0)));
}

/// Nine by nine cells of one metre, a rough plane of gradient 0.3. The gradient along the heading must lie
/// in a band: two narrow arcs of headings, one on each side of the fall line.
inline std::shared_ptr<const costmap::CostGrid> randomBand(unsigned seed, double least, double most) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  const double up = 6.283185307179586 * unit();
  maps::Raster<costmap::CellCode> cells({.width = 9, .height = 9, .resolution_m = 1.0, .south_west = {}});
  for (auto& cell : cells.values()) {
    const bool blocked = unit() < 0.02;
    const double steep = 0.3 + 0.03 * (unit() - 0.5), at = up + 0.06 * (unit() - 0.5);
    cell = costmap::CellCode({.dz_dx = steep * std::cos(at),
                              .dz_dy = steep * std::sin(at),
                              .curve = blocked ? costmap::CellCode::kBlocked : costmap::CellCode::Curve{0}});
  }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, onlyAlong(least, most)));
}

}  // namespace talus::planner::testing
