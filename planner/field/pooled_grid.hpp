#pragma once

#include <memory>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns a coarse map for the search of a rough route. Each coarse cell represents factor x factor cells of
/// `map`, factor >= 2. The coarse cell has the mean gradient and the most frequent cost curve (kind of
/// ground) of its cells, sampled at every fourth cell. A surcharge on the cost curve makes the mean cost over
/// all headings equal to the mean cost of the traversable cells divided by their share. The coarse cell is
/// blocked if less than a third of the samples are traversable. The coarse costs are not bounds of the true
/// costs. Returns null after a stop.
std::shared_ptr<const costmap::CostGrid> pooled(const costmap::CostGrid& map, int factor, int threads = 1,
                                                const StopCheck& stop = {});

/// Returns the coarse map of a newer version `map` with the same cost function, of which only the cells in
/// the box `changed` differ. `older` is the coarse map of the previous version.
std::shared_ptr<const costmap::CostGrid> repooled(const costmap::CostGrid& older,
                                                  const costmap::CostGrid& map, int factor, CellBox changed);

}  // namespace talus::planner
