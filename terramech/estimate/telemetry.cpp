#include <algorithm>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {
namespace {

template <class Columns>
auto findIn(const Columns& columns, std::string_view name) noexcept -> decltype(&columns.front().values) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &found->values;
}

}  // namespace

const std::vector<double>* Telemetry::find(std::string_view name) const noexcept {
  return findIn(numbers, name);
}

const std::vector<std::string>* Telemetry::findWords(std::string_view name) const noexcept {
  return findIn(words, name);
}

const std::vector<double>& Telemetry::at(std::string_view name) const {
  if (const auto* column = find(name)) return *column;
  throw InputError({.where = source,
                    .reason = "no column " + std::string(name),
                    .remedy = "add it to the header row with its values"});
}

const std::vector<std::string>& knownTelemetryColumns() {
  static const std::vector<std::string> columns{"pass_index",
                                                "time_s",
                                                "x_m",
                                                "y_m",
                                                "z_m",
                                                "heading_rad",
                                                "pitch_rad",
                                                "roll_rad",
                                                "slope_rad",
                                                "slip",
                                                "slip_angle_rad",
                                                "speed_mps",
                                                "rim_speed_mps",
                                                "load_N",
                                                "torque_Nm",
                                                "sinkage_m",
                                                "drawbar_pull_N",
                                                "side_force_N",
                                                "wheel_radius_m",
                                                "wheel_width_m",
                                                "grouser_height_m",
                                                "grouser_count",
                                                "shear_modulus_m"};
  return columns;
}

}  // namespace talus::terramech
