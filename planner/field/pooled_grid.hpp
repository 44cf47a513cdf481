#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Coarse map for finding a rough route: each coarse cell represents factor x factor cells (factor >= 2). A
/// coarse cell has the mean gradient and the most frequent curve of its cells, sampled at every fourth cell.
/// A surcharge on the curve makes the mean cost over all headings equal to the mean of the traversable cells,
/// divided by the share of traversable cells. The coarse cell is blocked if less than a third of the samples
/// are traversable. The result is no bound of the cost. Returns null when stopped.
std::shared_ptr<const costmap::CostGrid> pooled(const costmap::CostGrid& map, int factor, int threads = 1,
                                                const StopCheck& stop = {});

/// Pooled map of a newer version of the same map with the same cost, of which only a box of cells changed.
std::shared_ptr<const costmap::CostGrid> repooled(const costmap::CostGrid& older,
                                                  const costmap::CostGrid& map, int factor, CellBox changed);

}  // namespace talus::planner
