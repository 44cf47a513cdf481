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

/// Soil knowledge of the planner.
enum class SoilKnowledge {
  Geometry,          ///< slopes and hazards only, the same firm soil everywhere; telemetry is not used
  AlongOnly,         ///< as Prior, but without the costs of cross-slope driving; for comparison
  Prior,             ///< the soils of the map; telemetry is not used
  OnLine,            ///< the soils of the map, updated by the telemetry of the drive
  PerfectKnowledge,  ///< the true soils, including all patches
};

/// All values of SoilKnowledge in order.
inline constexpr std::array kBeliefs{SoilKnowledge::Geometry, SoilKnowledge::AlongOnly, SoilKnowledge::Prior,
                                     SoilKnowledge::OnLine, SoilKnowledge::PerfectKnowledge};

/// Names in calls and JSON: "geometry", "along-only", "prior", "online", `"clairvoyant"`.
std::string_view name(SoilKnowledge belief) noexcept;

/// Result of one world.
struct WorldResult {
  TraverseSimulation drive;            ///< the simulated drive
  std::size_t categories_changed = 0;  ///< cells whose category differs after the drive
};

/// Range of world indices for one soil knowledge.
struct WorldRange {
  SoilKnowledge belief = SoilKnowledge::OnLine;  ///< soil knowledge of the planner
  std::size_t first = 0;                         ///< number of the first world
  std::size_t count = 1;                         ///< number of worlds
};

/// A site as mapped, its true soils, and a drive across the site; draws any number of random worlds.
/// Immutable; safe to share between threads.
class SimulationSite {
 public:
  /// Input common to all worlds.
  struct Parts {
    Truth truth;              ///< true soils
    maps::Point start;        ///< map coordinates [m]
    maps::Point goal;         ///< map coordinates [m]
    terramech::Soil firm;     ///< soil of all ground with SoilKnowledge::Geometry
    std::uint64_t seed = 1;   ///< world i is drawn with seed + i
    SensorOptions sensors{};  ///< sensors of the rover; their seed is replaced by that of the world
    std::function<Plan(const Problem&)> planner{};  ///< called for every route; empty: FieldPlanner
  };

  /// Keeps a reference to the map.
  SimulationSite(const costmap::TraversabilityMap& map, Parts parts);

  /// Simulates the world of index i with the given soil knowledge; the result depends on nothing else.
  WorldResult world(SoilKnowledge belief, std::size_t i, const ProgressMonitor& watch = {}) const;

  /// Results of worlds first to first + count - 1 in order, independent of their division into ranges. Fewer
  /// when stopped.
  std::vector<WorldResult> worlds(const WorldRange& range, const ProgressMonitor& watch = {}) const;

  /// Returns the true soils of the world of index i.
  TrueWorld trueWorld(std::size_t i) const;
  /// The planner's map before the drive.
  costmap::TraversabilityMap estimatedMap(SoilKnowledge belief, const TrueWorld& world) const;
  /// Returns the options of the traverse simulation in the world of index i.
  SimulationOptions options(SoilKnowledge belief, std::size_t i) const;

 private:
  const costmap::TraversabilityMap& map_;
  Parts parts_;
};

/// Category of every cell, row by row from the south-west.
std::vector<std::uint8_t> categoriesOf(const costmap::TraversabilityMap& map);

}  // namespace talus::planner
