#pragma once

#include <optional>
#include <string>

#include <talus/cli/ground/mission.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/route.hpp>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace talus::cli {

/// Declares the options --start-heading, --goal-heading (each also in degrees), --turning-radius,
/// --no-reverse and --chassis.
void addMotionOptions(CLI::App& command, MotionOptions& drive);

/// Declares a heading option `name` in radians and NAME-deg in degrees.
void addHeading(CLI::App& command, const std::string& name, std::optional<double>& heading_rad,
                const std::string& text);

/// Declares the option --chassis.
void addChassisOption(CLI::App& command, std::string& chassis);

/// Returns a check that rejects values that are not terramech::isTurningRadius().
CLI::Validator turningRadius();

/// Returns the kinematics of the map's rover, overridden by the options of the call.
planner::Kinematics kinematicsOf(const MotionOptions& drive, const costmap::TraversabilityMap& map);

/// Returns a chassis of the kind "rigid" or "rocker-bogie"; nullopt if `kind` is empty. The chassis refers to
/// the map, which must outlive the chassis.
std::optional<planner::Chassis> chassisOf(const std::string& kind, const costmap::TraversabilityMap& map);

/// Declares the option --plugin.
void addPluginOption(CLI::App& command, std::string& plugin);

/// Declares the option --time, the time limit of a plugin, for calls without another time limit.
void addPluginTime(CLI::App& command, double& time_limit_s);

/// Declares the option --image.
void addImageOption(CLI::App& command, std::string& image);

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Checks that positions and options of a call are consistent with each other. @throws InputError otherwise
void requirePlaces(const PlanOptions& options);

}  // namespace talus::cli
