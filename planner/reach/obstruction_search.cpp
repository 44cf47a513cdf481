#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/planner/reach/obstruction_search.hpp>

namespace talus::planner {
namespace {

using costmap::Hazard;
using maps::Cell;
using maps::Point;

// The cells of two sets with the fewest king's moves between them, by a flood fill from the first set over
// the whole map; nothing if a set is empty or after a stop.
std::optional<std::pair<Cell, Cell>> closest(const maps::Grid& grid, const Reach& from, const Reach& to,
                                             const StopCheck& stop) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> origin(grid.size(), kNone);
  std::deque<Cell> open;
  for (int row = 0; row < grid.height; ++row) {
    if ((row & 63) == 0 && stop()) return std::nullopt;
    for (int column = 0; column < grid.width; ++column)
      if (from.holds({column, row})) {
        origin[grid.index({column, row})] = static_cast<std::uint32_t>(grid.index({column, row}));
        open.push_back({column, row});
      }
  }
  for (std::size_t steps = 1; !open.empty(); ++steps) {
    if ((steps & 0xffffU) == 0 && stop()) return std::nullopt;
    const Cell cell = open.front();
    open.pop_front();
    const std::uint32_t begun = origin[grid.index(cell)];
    const auto width = static_cast<std::uint32_t>(grid.width);
    if (to.holds(cell)) return {{{static_cast<int>(begun % width), static_cast<int>(begun / width)}, cell}};
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (grid.contains({column, row}) && origin[grid.index({column, row})] == kNone) {
          origin[grid.index({column, row})] = begun;
          open.push_back({column, row});
        }
  }
  return std::nullopt;
}

std::string text(Point p) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, "%.2f,%.2f", p.x_m, p.y_m);
  return buffer;
}

const char* remedy(Hazard hazard) noexcept {
  switch (hazard) {
    case Hazard::KeepOut:
      return "keep-out areas, or cells that a layer refuses, and their clearance close every way: reduce "
             "them, or choose "
             "another goal";
    case Hazard::Obstacle:
      return "terrain classes declared impassable and their clearance close every way: check the classes, or "
             "choose "
             "another goal";
    case Hazard::Rocks:
      return "rocks (the layer of their abundance) and their clearance close every way: observe them, or "
             "choose another "
             "goal";
    case Hazard::Step:
      return "steps higher than the wheels climb and their clearance close every way: choose another goal";
    default:
      return "ground too rough for the rover's belly and its clearance close every way: choose another goal";
  }
}

const char* remedy(Constraint constraint) noexcept {
  switch (constraint) {
    case Constraint::Pitch:
      return "the pitch limit closes every way: raise max_pitch_rad, or choose another goal";
    case Constraint::Roll:
      return "the roll limit closes every way: raise max_roll_rad, or choose another goal";
    case Constraint::Soil:
      return "soil closes every way: measure the ground there, or choose another goal";
    case Constraint::Hazard:
      return "hazards, keep-out areas and their clearance close every way: reduce them, or choose another "
             "goal";
    case Constraint::Unknown:
      return "unobserved ground closes every way: observe it, or choose another goal";
    case Constraint::Rim:
      return "the rim of the map closes every way, from which the rover keeps half its width: use a larger "
             "map";
    case Constraint::Slope:
      return "slopes close every way, which both the rover's limits and the soil refuse: choose another goal";
  }
  return "";
}

const char* what(Hazard hazard) noexcept {
  switch (hazard) {
    case Hazard::KeepOut:
      return "keep-out areas";
    case Hazard::Obstacle:
      return "impassable classes";
    case Hazard::Rocks:
      return "rocks";
    case Hazard::Step:
      return "steps";
    default:
      return "rough ground";
  }
}

const char* what(Constraint constraint) noexcept {
  constexpr const char* kWhat[] = {"the pitch limit",   "the roll limit",     "soil",  "hazards",
                                   "unobserved ground", "the rim of the map", "slopes"};
  return kWhat[static_cast<std::size_t>(constraint)];
}

}  // namespace

Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, const Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards,
                               const StopCheck& stop) {
  Obstruction found{.last = places.from, .first = places.to};
  found.cells_from_start = from_start.cells();
  const Reach to_goal(map, headings, Reach::Sense::To, places.to, tolerance_m, stop);
  found.cells_to_goal = to_goal.cells();
  const bool backwards = to_goal.cells() < from_start.cells();
  auto gap = backwards ? closest(map.grid(), to_goal, from_start, stop)
                       : closest(map.grid(), from_start, to_goal, stop);
  if (gap) {
    if (backwards) std::swap(gap->first, gap->second);
    found.last = map.grid().centre(gap->first);
    found.first = map.grid().centre(gap->second);
  }
  // Searches from the side with fewer cells, until the search meets the other side.
  const auto opens = [&](const costmap::CostGrid& lifted) {
    HeadingSets free(lifted.cost());
    Reach reach = backwards ? Reach(lifted, free, Reach::Sense::To, places.to, tolerance_m, stop, &from_start)
                            : Reach(lifted, free, Reach::Sense::From, places.from, 0.0, stop, &to_goal);
    if (reach.joined()) return true;
    return reach.complete() &&
           (backwards ? reach.reaches(places.from, 0.0) : reach.reaches(places.to, tolerance_m));
  };
  tryLifting(found, map, hazards, opens, stop);
  return found;
}

void tryLifting(Obstruction& found, const costmap::CostGrid& map, const HazardsOf& hazards,
                const OpensOn& opens, const StopCheck& stop) {
  if (stop() || map.grid().size() > kTriedCells) return;
  const LiftedGround ground(map, hazards, slopesAcross(map, {found.last, found.first}));
  const auto opensWithout = [&](Constraint constraint, Hazard kinds = LiftedGround::kSolid,
                                std::optional<Constraint> also = {}) {
    if (stop()) return false;
    const auto lifted = ground.without(constraint, kinds, also);
    return lifted && opens(*lifted);
  };
  for (const Constraint constraint :
       {Constraint::Unknown, Constraint::Hazard, Constraint::Soil, Constraint::Pitch, Constraint::Roll,
        Constraint::Rim, Constraint::Slope})
    if (!found.lifting && opensWithout(constraint)) found.lifting = constraint;
  // Kinds of hazards, alone or together with another constraint.
  const auto findKind = [&] {
    if (found.lifting != Constraint::Hazard || !hazards) return;
    for (const Hazard kind :
         {Hazard::KeepOut, Hazard::Obstacle, Hazard::Rocks, Hazard::Step, Hazard::Roughness})
      if (!found.hazard && opensWithout(Constraint::Hazard, kind, found.also)) found.hazard = kind;
  };
  findKind();
  // The least set of two: slopes are tried as a whole before their parts.
  for (const Constraint first : {Constraint::Hazard, Constraint::Unknown, Constraint::Rim})
    for (const Constraint second : {Constraint::Slope, Constraint::Unknown, Constraint::Rim}) {
      if (found.lifting || first == second || (first == Constraint::Rim && second == Constraint::Unknown))
        continue;
      if (!opensWithout(first, LiftedGround::kSolid, second)) continue;
      found.lifting = first;
      found.also = second;
      for (const Constraint part : {Constraint::Soil, Constraint::Pitch, Constraint::Roll})
        if (found.also == Constraint::Slope && opensWithout(first, LiftedGround::kSolid, part))
          found.also = part;
      findKind();
    }
  found.tried = !stop();
}

std::string text(const Obstruction& obstruction, const Segment& places) {
  const double apart_m =
      std::hypot(obstruction.last.x_m - obstruction.first.x_m, obstruction.last.y_m - obstruction.first.y_m);
  char apart[64];
  std::snprintf(apart, sizeof apart, " (%.1f m apart)", apart_m);
  const std::string where =
      apart_m > 0.0
          ? "closest at " + text(obstruction.last) + " and " + text(obstruction.first) + apart
          : "both touch the cell at " + text(obstruction.last) + ", through which no heading leads on";
  std::string line = "no route from " + text(places.from) + " to " + text(places.to) +
                     ", whatever the headings: " + std::to_string(obstruction.cells_from_start) +
                     " cells are reachable from the start, " + std::to_string(obstruction.cells_to_goal) +
                     " lead to the goal; " + where;
  if (obstruction.also)
    return line + "; " + (obstruction.hazard ? what(*obstruction.hazard) : what(*obstruction.lifting)) +
           " and " + what(*obstruction.also) +
           " close every way together, neither alone: change both, or choose another goal";
  if (obstruction.hazard) return line + "; " + remedy(*obstruction.hazard);
  if (obstruction.lifting) return line + "; " + remedy(*obstruction.lifting);
  return line + (obstruction.tried ? "; more than two constraints close every way: choose another goal"
                                   : "; choose another goal");
}

}  // namespace talus::planner
