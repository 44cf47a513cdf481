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

/// Soil knowledge of the planner at the start of a drive.
enum class SoilKnowledge {
  Geometry,          ///< slopes and hazards only, with the same firm soil everywhere; telemetry is not used
  AlongOnly,         ///< the soils of the map, but no cost of driving across a slope; telemetry is not used
  Prior,             ///< the soils of the map; telemetry is not used
  OnLine,            ///< the soils of the map, updated by the telemetry of the drive
  PerfectKnowledge,  ///< the true soils, including all patches, and the true position; telemetry is not used
};

/// All values of SoilKnowledge in the order of the enumeration.
inline constexpr std::array kBeliefs{SoilKnowledge::Geometry, SoilKnowledge::AlongOnly, SoilKnowledge::Prior,
                                     SoilKnowledge::OnLine, SoilKnowledge::PerfectKnowledge};

/// Returns the name in function calls and JSON: "geometry", "along-only", "prior", "online", `"clairvoyant"`
/// (PerfectKnowledge).
std::string_view name(SoilKnowledge belief) noexcept;

/// Result of the drive in one world, that is, one random draw of the soils.
struct WorldResult {
  TraverseSimulation drive;            ///< the simulated drive
  std::size_t categories_changed = 0;  ///< number of cells with another category after the drive than before
};

/// Consecutive range of worlds for one soil knowledge.
struct WorldRange {
  SoilKnowledge belief = SoilKnowledge::OnLine;  ///< soil knowledge of the planner
  std::size_t first = 0;                         ///< index of the first world
  std::size_t count = 1;                         ///< number of worlds
};

/// Site of a simulation: a map, the true soils, and start and goal of a drive. The true soils are drawn at
/// random in any number of worlds. Immutable; safe to share between threads.
class SimulationSite {
 public:
  /// Input common to all worlds.
  struct Parts {
    Truth truth;              ///< true soils and their variation between worlds
    maps::Point start;        ///< start of the drive, map coordinates [m]
    maps::Point goal;         ///< goal of the drive, map coordinates [m]
    terramech::Soil firm;     ///< soil of all ground for SoilKnowledge::Geometry
    std::uint64_t seed = 1;   ///< the world with index i is drawn with the seed `seed` + i
    SensorOptions sensors{};  ///< sensors of the rover; their seed is replaced by the seed of the world
    std::function<Plan(const Problem&)> planner{};  ///< planner of every route; empty: FieldPlanner
  };

  /// `map` is the map of the site; it must outlive the object.
  SimulationSite(const costmap::TraversabilityMap& map, Parts parts);

  /// Simulates the drive in the world with index i for the soil knowledge `belief`. The result depends only
  /// on i and `belief`.
  WorldResult world(SoilKnowledge belief, std::size_t i, const ProgressMonitor& watch = {}) const;

  /// Returns the results of the worlds of `range` in order. The results do not depend on the division of the
  /// worlds into ranges. After a stop by `watch` the vector has fewer results.
  std::vector<WorldResult> worlds(const WorldRange& range, const ProgressMonitor& watch = {}) const;

  /// Returns the true soils of the world with index i.
  TrueWorld trueWorld(std::size_t i) const;
  /// Returns the map of the planner before the drive.
  costmap::TraversabilityMap estimatedMap(SoilKnowledge belief, const TrueWorld& world) const;
  /// Returns the parameters of the traverse simulation in the world with index i.
  SimulationOptions options(SoilKnowledge belief, std::size_t i) const;

 private:
  const costmap::TraversabilityMap& map_;
  Parts parts_;
};

}  // namespace talus::planner
