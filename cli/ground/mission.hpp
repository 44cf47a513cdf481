#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/terramech/io/file_keys.hpp>

namespace talus::cli {

/// Constraints on the motion of the rover, for planners of drives.
struct MotionOptions {
  std::optional<double> start_heading_rad;  ///< empty: any heading
  std::optional<double> goal_heading_rad;   ///< empty: any heading at the goal
  std::optional<double> turning_radius_m;   ///< empty: that of the rover
  bool no_reverse = false;
  std::string chassis;  ///< "rigid" or "rocker-bogie": limits clearance and tilt along the whole motion

  bool any() const { return start_heading_rad || goal_heading_rad || turning_radius_m || no_reverse; }
};

/// Options of `talus plan`, from the command line or a mission file.
struct PlanOptions {
  GroundOptions ground;
  std::string start;
  std::vector<std::string> goals;  ///< the route leads to the goal of least cost
  std::vector<std::string> via;
  std::string pairs;  ///< CSV of starts and goals; empty: one route
  double tolerance_m = 0.0;
  std::string planner = "field";
  std::string plugin;  ///< shared library of an external planner; empty: built-in planners
  MotionOptions drive;
  double max_risk = 0.0;               ///< upper bound of the immobilisation probability; 0: none
  std::size_t in_memory = 40'000'000;  ///< cells; larger maps are read window by window
  bool whole_field = false;            ///< also on large maps
  bool no_proof = false;               ///< computes no improved lower bound and no alternative corridors
  std::string pareto;                  ///< chart file; empty: none
  double time_limit_s = 0.0;           ///< 0: no limit
  std::string output;
  std::string html;  ///< HTML page; empty: none
  std::string png;   ///< PNG picture; empty: none
};

/// The keys of a mission file, of its `maps` and of its `thresholds`.
std::span<const terramech::FileKey> missionKeys();
std::span<const terramech::FileKey> missionMapKeys();
std::span<const terramech::FileKey> thresholdKeys();

/// Returns true if the extension of the path is that of a mission file, .yaml or .yml.
bool isMission(const std::string& path);

/// Reads the mission file at options.ground.dem.path into the options. Values from the command line have
/// precedence. Paths in the file are relative to the file. @throws InputError with file and line
void readMission(PlanOptions& options);

}  // namespace talus::cli
