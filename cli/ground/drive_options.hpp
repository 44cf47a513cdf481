#pragma once

#include <optional>
#include <string>

#include <talus/cli/ground/mission.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/check/chassis.hpp>
#include <talus/planner/route/kinematics.hpp>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace talus::cli {

/// Declares --start-heading, --goal-heading (each also in degrees), --turning-radius, --no-reverse and
/// --chassis.
void addDriveOptions(CLI::App& command, DriveOptions& drive);

/// Declares --chassis.
void addChassisOption(CLI::App& command, std::string& chassis);

/// Refuses a turning radius that no rover may have (terramech::isTurningRadius()).
CLI::Validator turningRadius();

/// What the rover keeps on the map, unless the call overrides it.
planner::Kinematics kinematicsOf(const DriveOptions& drive, const costmap::TraversabilityMap& map);

/// The chassis of that kind, "rigid" or "rocker-bogie"; none for an empty one. Keeps the map by reference.
std::optional<planner::Chassis> chassisOf(const std::string& kind, const costmap::TraversabilityMap& map);

}  // namespace talus::cli
