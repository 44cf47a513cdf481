
#include <CLI/CLI.hpp>

#include <talus/cli/app/help_format.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/motion_options.hpp>
#include <talus/common/constants.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/turning_radius.hpp>

namespace talus::cli {

void addHeading(CLI::App& command, const std::string& name, std::optional<double>& heading_rad,
                const std::string& text) {
  auto* radians = command
                      .add_option_function<double>(
                          name, [&heading_rad](double value) { heading_rad = value; }, text)
                      ->type_name("RAD")
                      ->check(heading());
  command
      .add_option_function<double>(
          name + "-deg", [&heading_rad](double value) { heading_rad = value * kDegree; },
          "the same in degrees")
      ->type_name("DEG")
      ->check(finite())
      ->excludes(radians);
}

void addMotionOptions(CLI::App& command, MotionOptions& drive) {
  constexpr const char* kText = "heading of the rover there, counter-clockwise from east (default: any)";
  addHeading(command, "--start-heading", drive.start_heading_rad, kText);
  addHeading(command, "--goal-heading", drive.goal_heading_rad, kText);
  command
      .add_option_function<double>(
          "--turning-radius", [&drive](double value) { drive.turning_radius_m = value; },
          "minimum turning radius of hybrid; 0: turns in place (default: the rover's)")
      ->type_name("METRES")
      ->check(turningRadius());
  addChassisOption(command, drive.chassis);
  command.add_flag("--no-reverse", drive.no_reverse, "hybrid: do not drive in reverse");
  groupOptions(command, "Motion");
}

CLI::Validator turningRadius() {
  const auto check = [](const std::string& text) -> std::string {
    double radius_m = 0.0;
    const bool allowed = CLI::detail::lexical_cast(text, radius_m) && terramech::isTurningRadius(radius_m);
    return allowed ? "" : text + ", must be 0 or 0.001 to 1000";
  };
  return CLI::Validator(check, "");
}

void addChassisOption(CLI::App& command, std::string& chassis) {
  command
      .add_option("--chassis", chassis,
                  "check clearance, pitch and roll of this chassis along the whole motion (any planner)")
      ->type_name("KIND")
      ->check(CLI::IsMember({"rigid", "rocker-bogie"}));
}

planner::Kinematics kinematicsOf(const MotionOptions& drive, const costmap::TraversabilityMap& map) {
  planner::Kinematics kinematics = planner::kinematicsOn(map.model(), map.published()->cost());
  if (drive.turning_radius_m) kinematics.turning_radius_m = *drive.turning_radius_m;
  kinematics.may_reverse = !drive.no_reverse;
  return kinematics;
}

std::optional<planner::Chassis> chassisOf(const std::string& kind, const costmap::TraversabilityMap& map) {
  if (kind.empty()) return std::nullopt;
  return planner::Chassis(map.elevation().elevation_m, map.model().rover(),
                          kind == "rigid" ? planner::Suspension::Rigid : planner::Suspension::RockerBogie);
}

}  // namespace talus::cli
