#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <talus/common/input_error.hpp>
#include <talus/costmap/map/explanation.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>

namespace talus {

using terramech::Telemetry;
/// Counts and findings of the telemetry that a map learned from.
using LearnReport = costmap::DriveReport;

/// What is known of a site before any wheel drove on it: readSite() reads it from files.
struct Site {
  costmap::MapLayers layers;    ///< elevation, terrain classes, rocks, keep-out areas, costs
  costmap::GroundModel ground;  ///< rover, soil of each terrain class, policy
  costmap::TraversabilityMap::Options options{};
};

/// Computes hazards and costs of each cell. Throws std::invalid_argument if a layer has another grid than the
/// elevation or an invalid value.
costmap::TraversabilityMap traversabilityMap(Site site, const ProgressMonitor& watch = {});

/// Traversability map of a site that learns from the rover's wheels. Only one thread may change or plan on a map at a
/// time; ground().published() may be called from any thread.
class Map {
 public:
  /// Builds the map with traversabilityMap().
  explicit Map(Site site, const ProgressMonitor& watch = {});
  explicit Map(costmap::TraversabilityMap map);
  /// Reads a file of save(), `talus costmap` or `talus update`, with rover, soils, policy and evidence; `threads` >= 1.
  /// @throws InputError
  static Map read(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});
  Map(Map&&) noexcept;
  Map& operator=(Map&&) noexcept;
  ~Map();

  /// Writes the map to a file, completely or not at all. @throws InputError
  void save(const std::string& path) const;

  /// Adds the telemetry of one whole drive (costmap::addDrive()). @throws InputError if a required column is missing
  LearnReport learn(const Telemetry& drive);
  /// Adds the next part of the drive that is under way, in order of time; a part contains all rows of a time.
  /// Returns the number of its rows that the map uses.
  std::size_t learnPart(const Telemetry& part);
  /// Evaluates all parts again together (costmap::DriveIntake::settle()). Recommended at each stop of the rover.
  LearnReport settle();

  /// Replaces the ground of a window by a new observation (costmap::TraversabilityMap::patch()).
  void patch(const costmap::SurfacePatch& seen);
  /// Returns the map of a window moved by whole tiles of 64 cells; parts of a drive cannot be settled across a move.
  Map moved(maps::Cell tiles) const;

  /// Returns category and causes at a place for driving in one heading [rad]; without, in the worst heading. Throws
  /// std::invalid_argument if the place lies outside the map.
  costmap::Explanation explain(maps::Point place, std::optional<double> heading_rad = std::nullopt) const;

  const costmap::TraversabilityMap& ground() const noexcept { return *map_; }
  costmap::TraversabilityMap& ground() noexcept { return *map_; }

 private:
  std::unique_ptr<costmap::TraversabilityMap> map_;
  std::unique_ptr<costmap::DriveIntake> intake_;
};

}  // namespace talus
