#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/drive/traverse_simulation.hpp>
#include <talus/planner/simulation/worlds/world_draw.hpp>

namespace talus::planner {

/// What the planner knows of the soil.
enum class Belief {
  Geometry,          ///< slopes and hazards only, all ground as firm as rock; telemetry is not used
  AlongOnly,         ///< as Prior, but crossing a slope costs what level ground does; for comparison
  Prior,             ///< the soils of the map; telemetry is not used
  OnLine,            ///< the soils of the map, updated by the telemetry of the drive
  PerfectKnowledge,  ///< the true soils, with all patches
};

/// All of them, in this order.
inline constexpr std::array kBeliefs{Belief::Geometry, Belief::AlongOnly, Belief::Prior, Belief::OnLine,
                                     Belief::PerfectKnowledge};

/// The names in calls and in JSON: "geometry", "along-only", "prior", "online", "clairvoyant".
std::string_view name(Belief belief) noexcept;

/// What came of one world.
struct WorldResult {
  TraverseSimulation drive;
  std::size_t categories_changed = 0;  ///< cells whose category for people is another after the drive
};

/// Worlds to simulateTraverse in, by their numbers.
struct WorldRange {
  Belief belief = Belief::OnLine;
  std::size_t first = 0;
  std::size_t count = 1;
};

/// A site as it is known, what is true of it, and a drive across it: makes as many random worlds as one asks
/// for. Immutable; safe to share between threads.
class SimulationSite {
 public:
  /// What every world shares.
  struct Parts {
    Truth truth;
    maps::Point start;
    maps::Point goal;
    terramech::Soil firm;     ///< what Belief::Geometry takes all ground for
    std::uint64_t seed = 1;   ///< world i is drawn with seed + i
    SensorOptions sensors{};  ///< of a rover that goes by its sensors; their seed is that of the world
    std::function<Plan(const Problem&)> planner{};  ///< asked for every route; none: the field's
  };

  /// The map is kept by reference.
  SimulationSite(const costmap::TraversabilityMap& map, Parts parts);

  /// World number i under a belief: depends on nothing else.
  WorldResult world(Belief belief, std::size_t i, const ProgressMonitor& watch = {}) const;

  /// Worlds first .. first + count - 1, in that order; the same results however they are divided.
  std::vector<WorldResult> worlds(const WorldRange& range, const ProgressMonitor& watch = {}) const;

  /// The true soils of world number i.
  TrueWorld trueWorld(std::size_t i) const;
  /// What the rover believes before it drives there.
  costmap::TraversabilityMap believed(Belief belief, const TrueWorld& world) const;
  /// The options that a traverse simulation in world number i is run with.
  SimulationOptions options(Belief belief, std::size_t i) const;

 private:
  const costmap::TraversabilityMap& map_;
  Parts parts_;
};

/// Category for people of every cell, row by row from the south-west.
std::vector<std::uint8_t> categoriesOf(const costmap::TraversabilityMap& map);

}  // namespace talus::planner
