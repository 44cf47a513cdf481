#include <algorithm>

#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {
namespace {

struct Column {
  const char* name;
  double (*value)(const WheelState&);
};

constexpr Column kColumns[] = {
    {"slip", [](const WheelState& s) { return s.slip; }},
    {"slip_angle_rad", [](const WheelState& s) { return s.slip_angle_rad; }},
    {"load_N", [](const WheelState& s) { return s.load_N; }},
    {"speed_mps", [](const WheelState& s) { return s.speed_mps; }},
    {"rim_speed_mps", [](const WheelState& s) { return s.rim_speed_mps; }},
    {"time_s", [](const WheelState& s) { return s.time_s; }},
    {"pass_index", [](const WheelState& s) { return s.pass_index; }},
    {"slope_rad", [](const WheelState& s) { return s.slope_rad; }},
    {"wheel_radius_m", [](const WheelState& s) { return s.wheel.radius_m; }},
    {"wheel_width_m", [](const WheelState& s) { return s.wheel.width_m; }},
    {"grouser_height_m", [](const WheelState& s) { return s.wheel.grouser_height_m; }},
    {"grouser_count", [](const WheelState& s) { return static_cast<double>(s.wheel.grouser_count); }},
};

}  // namespace

double WheelState::covariate(std::string_view name) const {
  for (const Column& column : kColumns)
    if (name == column.name) return column.value(*this);
  for (const auto& [key, value] : extra)
    if (key == name) return value;
  for (const auto& [key, text] : group)
    if (key == name) return 1.0;
  return name == "constant" ? 1.0 : kUnknown;
}

std::string_view WheelState::label(std::string_view column) const {
  for (const auto& [key, value] : group)
    if (key == column) return value;
  return {};
}

const std::vector<std::string>& stateColumns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Column& column : kColumns) all.emplace_back(column.name);
    return all;
  }();
  return names;
}

}  // namespace talus::terramech
