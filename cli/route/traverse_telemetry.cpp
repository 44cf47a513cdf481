#include <cmath>

#include <fmt/format.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/cli/route/traverse_telemetry.hpp>

namespace talus::cli {
namespace {

// An empty field is a missing value.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string();
}

}  // namespace

void saveTelemetry(const std::filesystem::path& path, const planner::TraverseSimulation& drive,
                   const terramech::Rover& rover) {
  std::string text =
      "run,wheel,pass_index,time_s,x_m,y_m,heading_rad,slope_rad,slip,rim_speed_mps,speed_mps,load_N,torque_"
      "Nm,"
      "sinkage_m,wheel_radius_m,wheel_width_m\n";
  for (const planner::WheelRecord& r : drive.records) {
    const costmap::TelemetryReading& w = r.reading;
    text += fmt::format(
        "simulation,w{},{},{}\n", r.wheel + 1, w.pass,
        fmt::join(std::vector{field(w.time_s), field(w.place.x_m), field(w.place.y_m), field(r.heading_rad),
                              field(std::atan(w.gradient)), field(w.slip), field(rover.max_speed_mps),
                              field(rover.max_speed_mps * (1.0 - w.speed_slip)), field(w.load_N),
                              field(w.torque_Nm), field(w.sinkage_m), field(rover.wheel.radius_m),
                              field(rover.wheel.width_m)},
                  ","));
  }
  writeFile(path, text);
}

}  // namespace talus::cli
