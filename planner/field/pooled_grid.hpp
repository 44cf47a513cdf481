#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// A coarse picture of a map to find the rough course of a route on: one cell for each factor x factor cells,
/// with their mean gradient, the curve that most of them have, and a surcharge so that a metre over all
/// headings costs what it costs on average in the cells (in every fourth of them), ground that is blocked in
/// part more expensive by that part. Blocked where less than a third may be entered. Not a bound of anything.
/// Null when stopped. factor >= 2.
std::shared_ptr<const costmap::CostGrid> pooled(const costmap::CostGrid& map, int factor, int threads = 1,
                                                const StopCheck& stop = {});

/// The pooled map of a newer version of the same map under the same cost, of which only a box of cells
/// changed.
std::shared_ptr<const costmap::CostGrid> repooled(const costmap::CostGrid& older,
                                                  const costmap::CostGrid& map, int factor, CellBox changed);

}  // namespace talus::planner
