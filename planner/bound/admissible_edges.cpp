#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/straight_bound.hpp>

namespace talus::planner {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kCheapest = 16;  // units of the cheapest edge that an octagon permits

Octagon nothing() noexcept {
  Octagon octagon;
  octagon.fill(kNone);
  return octagon;
}

// Returns the costs of the eight steps into a corner of cells. `below` and `above` point to the western of
// the two cells south and north of the corner.
Octagon stepsInto(const Octagon* below, const Octagon* above) noexcept {
  constexpr float root = 1.4142135F;
  Octagon into{};
  into[kEast] = std::min(above[1][kWest], below[1][kWest]);
  into[kWest] = std::min(above[0][kEast], below[0][kEast]);
  into[kNorth] = std::min(above[0][kSouth], above[1][kSouth]);
  into[kSouth] = std::min(below[0][kNorth], below[1][kNorth]);
  into[kNorthEast] = root * above[1][kSouthWest];
  into[kNorthWest] = root * above[0][kSouthEast];
  into[kSouthWest] = root * below[0][kNorthEast];
  into[kSouthEast] = root * below[1][kNorthWest];
  return into;
}

// Calls each(corner, costs of the steps into the corner) for every corner, row by row. Returns false when
// stopped.
template <typename Each>
bool forEachCorner(const maps::Grid& grid, const OctagonOf& octagon_of, RouteSense sense,
                   const StopCheck& stop, Each each) {
  const auto width = static_cast<std::size_t>(grid.width);
  std::vector<Octagon> below(width + 2, nothing()), above = below;
  for (int row = 0; row <= grid.height; ++row) {
    if (stop()) return false;
    for (std::size_t i = 0; i < width; ++i) {
      Octagon& octagon = above[i + 1];
      octagon = row < grid.height ? octagon_of({static_cast<int>(i), row}) : nothing();
      if (sense == RouteSense::FromStart) std::rotate(octagon.begin(), octagon.begin() + 4, octagon.end());
    }
    for (std::size_t column = 0; column <= width; ++column)
      each(maps::Cell{static_cast<int>(column), row}, stepsInto(&below[column], &above[column]));
    std::swap(below, above);
  }
  return true;
}

}  // namespace

std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const OctagonOf& octagon_of, const StopCheck& stop,
                                                 RouteSense sense) {
  const maps::Grid& grid = map->grid();
  const double side_m = grid.resolution_m, cheapest_J = cheapestMetre_J(*map);
  if (!(cheapest_J > 0.0)) return nullptr;
  const double unit_J = FittedOctagons::kLeastShare * cheapest_J * side_m / (kCheapest + 1);
  auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(unit_J, kCheapest),
                                           EdgeLayer::Unfilled{grid.width + 1, grid.height + 1});
  const bool filled =
      forEachCorner(grid, octagon_of, sense, stop, [&](maps::Cell corner, const Octagon& into) {
        std::uint16_t* steps = edges->into(edges->padded().index(corner));
        for (std::size_t k = 0; k < 8; ++k) {
          steps[k] = EdgeLayer::kBlocked;
          if (std::isinf(into[k]))
            continue;  // the step crosses or borders no cell that the heading may enter
          const double units = std::floor(static_cast<double>(into[k]) * side_m / unit_J);
          steps[k] =
              static_cast<std::uint16_t>(std::clamp(units, double{kCheapest}, EdgeUnits::kBlocked - 1.0));
        }
      });
  return filled ? edges : nullptr;
}

std::vector<float> cornerField(const std::shared_ptr<const costmap::CostGrid>& map,
                               const OctagonOf& octagon_of, std::vector<FieldGoal> ends,
                               const StopCheck& stop, RouteSense sense) {
  const auto edges = admissibleEdges(map, octagon_of, stop, sense);
  if (!edges) return {};
  for (FieldGoal& end : ends) end.cost_J = std::max(0.0, end.cost_J - edges->units().unit_J());  // is rounded
  CostToGo field(edges, ends);
  if (!field.settleAll(stop)) return {};
  const PaddedGrid& corners = edges->padded();
  std::vector<float> costs_J;
  costs_J.reserve(static_cast<std::size_t>(corners.width) * static_cast<std::size_t>(corners.height));
  for (int row = 0; row < corners.height; ++row)
    for (int column = 0; column < corners.width; ++column)
      costs_J.push_back(
          static_cast<float>(field.cost_J({column, row}).value_or(std::numeric_limits<double>::infinity())));
  return costs_J;
}

}  // namespace talus::planner
