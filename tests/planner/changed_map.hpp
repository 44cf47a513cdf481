#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include <drawn_map.hpp>

#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner::testing {

/// Random integers from 0 to a limit, excluding the limit.
class Below {
 public:
  explicit Below(unsigned seed) : random_(seed) {}
  int operator()(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }

 private:
  std::mt19937 random_;
};

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

/// Change of a patch: new random cells, or cells with a cheaper soil, a more expensive soil, or either.
enum class Change { Anew, Cheaper, Dearer, Either };

inline MapPointer changed(const MapPointer& map, CellBox box, Change change, Below& below) {
  maps::Raster<costmap::CellCode> cells(map->grid());
  for (int row = 0; row < map->grid().height; ++row)
    for (int column = 0; column < map->grid().width; ++column) {
      costmap::CellCode& cell = cells[{column, row}];
      cell = map->at({column, row});
      if (column < box.first.column || column > box.last.column || row < box.first.row || row > box.last.row)
        continue;
      costmap::CellCode::Parts parts{.dz_dx = cell.dzDx(), .dz_dy = cell.dzDy(), .curve = cell.curve()};
      const int step = change == Change::Cheaper ? -1 : change == Change::Dearer ? 1 : below(3) - 1;
      if (parts.curve < 5) parts.curve = static_cast<std::uint8_t>(std::clamp(parts.curve + step, 0, 4));
      if (change == Change::Anew)
        parts = {0.004 * below(100) - 0.2, 0.1, static_cast<std::uint8_t>(below(4) == 0 ? 255 : below(5))};
      cell = costmap::CellCode(parts);
    }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, map->content().cost));
}

/// The field before a patch of the map changed, its updated edge layer, and the recomputed field.
struct Trial {
  std::shared_ptr<EdgeLayer> edges;
  CostToGo before;
  CostToGo anew;
  CellBox box;
  maps::Cell start;

  Trial(const MapPointer& map, const MapPointer& newer, CellBox changed_box,
        const std::vector<FieldGoal>& goals, maps::Cell from, bool whole)
      : edges(std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0))),
        before(edges, goals),
        anew(std::make_shared<EdgeLayer>(newer, edges->units()), goals),
        box(changed_box),
        start(from) {
    whole ? before.settleAll() : before.settle(from);
    edges->update(newer, edges->units(), box);
    anew.settleAll();
  }
};

inline Trial randomTrial(unsigned seed, Change change) {
  Below below(seed);
  const auto map = randomMap(
      {.width = 70, .height = 60, .seed = seed, .blocked = 0.02 * below(10), .roughness = 0.05 * below(5)});
  const maps::Cell first{below(40), below(30)};
  const CellBox box{first, {first.column + below(30), first.row + below(30)}};
  std::vector<FieldGoal> goals{{.cell = {below(70), below(60)}}};
  for (int k = below(3); k > 0; --k)
    goals.push_back({.cell = {below(70), below(60)}, .cost_J = 3.0 * below(9)});
  const maps::Cell start{below(70), below(60)};
  return Trial(map, changed(map, box, change, below), box, goals, start, below(2) == 0);
}

}  // namespace talus::planner::testing
