#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::planner::testing {

/// Cost curve of the tests: factor (10 + 100 max(g, 0) + 400 g^2) J/m at gradient g along the heading;
/// refused for gradients steeper than `steepest`.
struct Ground {
  double factor = 1.0;
  double steepest = 0.3;
};

inline costmap::TravelCurve curve(const Ground& ground) {
  std::vector<float> costs;
  for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin) {
    const double g = (bin - costmap::TravelCurve::kBins / 2) / 256.0;
    const double cost = ground.factor * (10.0 + 100.0 * std::max(g, 0.0) + 400.0 * g * g);
    costs.push_back(
        static_cast<float>(std::abs(g) <= ground.steepest ? cost : std::numeric_limits<double>::infinity()));
  }
  return costmap::TravelCurve(std::move(costs));
}

/// Curve with the cost at(gradient along the heading) and no effect of gradients across.
template <typename At>
costmap::TravelCurve curveOf(At at) {
  std::vector<float> costs;
  for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin)
    costs.push_back(static_cast<float>(at(costmap::TravelCurve::gradient(bin))));
  return costmap::TravelCurve(std::move(costs));
}

/// Adds a cross slope to a curve: each row of cross slope adds `dearer` times the curve, and rows above
/// `rows` are refused.
inline costmap::TravelCurve crossed(const costmap::TravelCurve& curve, double dearer, int rows) {
  std::vector<float> all;
  for (int row = 0; row <= rows + 1; ++row)
    for (const float level : curve.level())
      all.push_back(row > rows ? std::numeric_limits<float>::infinity()
                               : level * static_cast<float>(1.0 + dearer * row));
  return costmap::TravelCurve(std::move(all));
}

/// Five curves: curve k costs k + 1 times curve 0; crossing a slope adds no cost on curve 0 and an
/// increasing cost on the others.
inline std::shared_ptr<const costmap::TravelCost> driveCost(costmap::TravelCost::Limits limits = {}) {
  std::vector<costmap::TravelCurve> curves;
  for (int k = 0; k < 5; ++k) {
    const costmap::TravelCurve level = curve({.factor = 1.0 + k});
    curves.push_back(k == 0 ? level : crossed(level, 0.02 * k, 20 - 2 * k));
  }
  return std::make_shared<costmap::TravelCost>(limits, curves);
}

/// A map from a drawing, north on top, cells of one metre, south-west corner at 0,0. '.' or a digit: level
/// ground of that curve; '#' blocked; '?' unknown; '^' 'v' '<' '>': rises at 0.2 in that direction.
inline std::shared_ptr<const costmap::CostGrid> drawn(const std::vector<std::string>& rows) {
  const maps::Grid grid{.width = static_cast<int>(rows[0].size()),
                        .height = static_cast<int>(rows.size()),
                        .resolution_m = 1.0,
                        .south_west = {}};
  maps::Raster<costmap::CellCode> cells(grid);
  for (int r = 0; r < grid.height; ++r)
    for (int c = 0; c < grid.width; ++c) {
      const char drawing = rows[static_cast<std::size_t>(grid.height - 1 - r)][static_cast<std::size_t>(c)];
      costmap::CellCode::Parts parts{.curve = 0};
      if (drawing >= '0' && drawing <= '9') parts.curve = static_cast<std::uint8_t>(drawing - '0');
      if (drawing == '#') parts.curve = costmap::CellCode::kBlocked;
      if (drawing == '?') parts.curve = costmap::CellCode::kUnknown;
      if (drawing == '^') parts.dz_dy = 0.2;
      if (drawing == 'v') parts.dz_dy = -0.2;
      if (drawing == '>') parts.dz_dx = 0.2;
      if (drawing == '<') parts.dz_dx = -0.2;
      cells[{c, r}] = costmap::CellCode(parts);
    }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, driveCost()));
}

/// A plane on which a metre costs 10 J and a radian of turning at a vertex turn_J, for a rover with the
/// given stance.
inline std::shared_ptr<const costmap::CostGrid> plane(
    int side, costmap::Direction gradient, double turn_J,
    std::shared_ptr<const terramech::RoverStance> stance = {}) {
  maps::Raster<costmap::CellCode> cells(
      {.width = side, .height = side, .resolution_m = 1.0, .south_west = {}},
      costmap::CellCode({gradient.x, gradient.y, 0}));
  const costmap::GroundCost ground{.curve = curveOf([](double) { return 10.0; }),
                                   .states = {},
                                   .turns = {.on_arc = {}, .in_place = {}, .at_vertex = {turn_J, 0.0}}};
  return std::make_shared<costmap::CostGrid>(costmap::flattened(
      cells,
      std::make_shared<costmap::TravelCost>(
          costmap::TravelCost::Limits{.max_along = 0.9, .max_across = 0.9, .stance = std::move(stance)},
          std::vector{ground})));
}

/// The same map with a cost of turn_J per radian at a vertex.
inline std::shared_ptr<const costmap::CostGrid> withTurns(const std::shared_ptr<const costmap::CostGrid>& map,
                                                          double turn_J) {
  std::vector<costmap::GroundCost> grounds;
  for (const auto& curve : map->cost().curves()) {
    grounds.push_back({.curve = curve, .states = {}});
    grounds.back().turns.at_vertex.energy_J = turn_J;
  }
  costmap::CostGrid::Content content = map->content();
  content.cost = std::make_shared<costmap::TravelCost>(map->cost().limits(), grounds);
  return std::make_shared<const costmap::CostGrid>(std::move(content));
}

/// Parameters of a random map.
struct RandomGround {
  int width = 20;
  int height = 20;
  unsigned seed = 1;
  double blocked = 0.15;   ///< share of blocked cells
  double roughness = 0.2;  ///< gradients are uniform in [-roughness, roughness]
  double resolution_m = 1.0;
};

inline std::shared_ptr<const costmap::CostGrid> randomMap(const RandomGround& ground) {
  std::mt19937 random(ground.seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  maps::Raster<costmap::CellCode> cells({.width = ground.width,
                                         .height = ground.height,
                                         .resolution_m = ground.resolution_m,
                                         .south_west = {}});
  for (auto& cell : cells.values()) {
    costmap::CellCode::Parts parts{.dz_dx = ground.roughness * (2 * unit() - 1),
                                   .dz_dy = ground.roughness * (2 * unit() - 1),
                                   .curve = static_cast<std::uint8_t>(5 * unit())};
    if (unit() < ground.blocked) parts.curve = costmap::CellCode::kBlocked;
    cell = costmap::CellCode(parts);
  }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, driveCost()));
}

}  // namespace talus::planner::testing
