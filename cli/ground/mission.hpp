#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/terramech/io/file_keys.hpp>

namespace talus::cli {

/// How the rover may move, for planners of drives.
struct DriveOptions {
  std::optional<double> start_heading_rad;  ///< none: it may look any way
  std::optional<double> goal_heading_rad;   ///< the same on arrival
  std::optional<double> turning_radius_m;   ///< none: the rover's
  bool no_reverse = false;
  std::string chassis;  ///< "rigid" or "rocker-bogie": clearance and tilt are kept along the whole motion

  bool any() const { return start_heading_rad || goal_heading_rad || turning_radius_m || no_reverse; }
};

/// Everything that `talus plan` needs: on the command line or in a mission file.
struct PlanOptions {
  GroundOptions ground;
  std::string start;
  std::vector<std::string> goals;  ///< the one that costs least is driven to
  std::vector<std::string> via;
  std::string pairs;  ///< CSV of many starts and goals; empty: one route
  double tolerance_m = 0.0;
  std::string planner = "field";
  std::string plugin;  ///< shared library whose planner is asked; empty: the program's own
  DriveOptions drive;
  double max_risk = 0.0;               ///< chance constraint on immobilisation, 0: none
  std::size_t in_memory = 40'000'000;  ///< cells; larger maps are read in windows along an overview's route
  bool whole_field = false;            ///< even on large maps
  bool no_proof = false;               ///< no best lower bound, no other corridors
  std::string pareto;                  ///< chart to draw; empty: none
  double time_limit_s = 0.0;           ///< 0: none
  std::string output;
  std::string html;  ///< page to write; empty: none
  std::string png;   ///< picture to write; empty: none
};

/// The keys of a mission file, of its `maps` and of its `thresholds`.
std::span<const terramech::FileKey> missionKeys();
std::span<const terramech::FileKey> missionMapKeys();
std::span<const terramech::FileKey> thresholdKeys();

/// Whether the path names a mission file by its extension, .yaml or .yml.
bool isMission(const std::string& path);

/// Takes over what the mission file at options.ground.dem.path says; what the command line says holds over
/// it. Paths in it are relative to the file. @throws InputError with file and line
void readMission(PlanOptions& options);

}  // namespace talus::cli
