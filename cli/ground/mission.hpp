#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace talus::cli {

/// Constraints on the motion of the rover, for planners of drives (paths with headings).
struct MotionOptions {
  std::optional<double> start_heading_rad;  ///< heading at the start; empty: any heading
  std::optional<double> goal_heading_rad;   ///< heading at the goal; empty: any heading
  std::optional<double> turning_radius_m;   ///< turning radius; empty: that of the rover
  bool no_reverse = false;
  /// "rigid" or "rocker-bogie": limits clearance and tilt of the rover along the whole motion; empty: no such
  /// limits.
  std::string chassis;

  /// Returns true if an option other than the chassis is set.
  bool any() const { return start_heading_rad || goal_heading_rad || turning_radius_m || no_reverse; }
};

/// Options of `talus plan`, from the command line or a mission file.
struct PlanOptions {
  GroundOptions ground;
  std::string start;
  std::vector<std::string> goals;  ///< positions of the goals; the route leads to the goal of least cost
  std::vector<std::string> via;
  std::string pairs;  ///< CSV table of starts and goals; empty: one route
  std::string part;   ///< K/N: the part of the pairs to plan; empty: all
  double tolerance_m = 0.0;
  std::string planner = "field";
  std::string plugin;  ///< shared library of an external planner; empty: a built-in planner is used
  MotionOptions drive;
  double max_risk = 0.0;  ///< upper bound of the immobilisation probability of the route; 0: no bound [-]
  /// Number of cells up to which a map is kept in memory; larger maps are read window by window.
  std::size_t in_memory = 40'000'000;
  bool no_proof = false;  ///< true if no improved lower bound and no alternative corridors are computed
  double corridor_percent = 0.0;  ///< excess over the cost of the route whose corridor is written; 0: none
  double gap = 0.0;           ///< proven gap at which planning ends; 0: as small as the usual work allows [-]
  double time_limit_s = 0.0;  ///< time limit of planning; 0: no limit
  std::string output;
  std::string html;   ///< file for an HTML page; empty: no page
  std::string png;    ///< file for a PNG picture; empty: no picture
  std::string image;  ///< raster that page and picture show under the route; empty: none
};

/// Declares the options --start-heading, --goal-heading (each also in degrees), --turning-radius,
/// --no-reverse and --chassis.
void addMotionOptions(CLI::App& command, MotionOptions& drive);

/// Declares a heading option `name` in radians and NAME-deg in degrees.
void addHeading(CLI::App& command, const std::string& name, std::optional<double>& heading_rad);

/// Declares the option --chassis.
void addChassisOption(CLI::App& command, std::string& chassis);

/// Returns a check that rejects values that are not terramech::isTurningRadius().
CLI::Validator turningRadius();

/// Returns the kinematics of the map's rover, overridden by the options of the call.
planner::Kinematics kinematicsOf(const MotionOptions& drive, const costmap::TraversabilityMap& map);

/// Returns a chassis of the kind "rigid" or "rocker-bogie"; nullopt if `kind` is empty. The chassis refers to
/// the map, which must outlive the chassis.
std::optional<planner::Chassis> chassisOf(const std::string& kind, const costmap::TraversabilityMap& map);

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Checks that positions and options of a call are consistent with each other. @throws InputError otherwise
void requirePlaces(const PlanOptions& options);

/// Returns true if the extension of the path is that of a mission file, .yaml or .yml.
bool isMission(const std::string& path);

/// Read the mission file `elevation.path`, if it is one, into the options of a site or of `talus plan`. Every option that
/// the call states has precedence, also with its default value; keep-out areas of both apply. Paths in the file are
/// relative to the file. @throws InputError with file and line
void readMission(GroundOptions& ground);
void readMission(PlanOptions& options);

/// Returns the text of a mission file with all keys that the reader accepts. Keys of the file and of its mapping `maps`
/// have the values given here; the others, and those with an empty text, are comments with their meaning.
std::string missionText(const std::map<std::string, nlohmann::json>& values);

/// Returns the content of a truth file. Throws InputError with file, line and field.
planner::Truth readTruth(const std::string& path);

}  // namespace talus::cli
