#include <algorithm>
#include <cmath>

#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {
namespace {

struct Column {
  const char* name;
  double (*value)(const WheelState&);
  void (*set)(WheelState&, double);
};

constexpr Column kColumns[] = {
    {"slip", [](const WheelState& s) { return s.slip; }, [](WheelState& s, double v) { s.slip = v; }},
    {"slip_angle_rad", [](const WheelState& s) { return s.slip_angle_rad; },
     [](WheelState& s, double v) { s.slip_angle_rad = v; }},
    {"load_N", [](const WheelState& s) { return s.load_N; }, [](WheelState& s, double v) { s.load_N = v; }},
    {"speed_mps", [](const WheelState& s) { return s.speed_mps; },
     [](WheelState& s, double v) { s.speed_mps = v; }},
    {"rim_speed_mps", [](const WheelState& s) { return s.rim_speed_mps; },
     [](WheelState& s, double v) { s.rim_speed_mps = v; }},
    {"time_s", [](const WheelState& s) { return s.time_s; }, [](WheelState& s, double v) { s.time_s = v; }},
    {"pass_index", [](const WheelState& s) { return s.pass_index; },
     [](WheelState& s, double v) { s.pass_index = v; }},
    {"slope_rad", [](const WheelState& s) { return s.slope_rad; },
     [](WheelState& s, double v) { s.slope_rad = v; }},
    {"wheel_radius_m", [](const WheelState& s) { return s.wheel.radius_m; },
     [](WheelState& s, double v) { s.wheel.radius_m = v; }},
    {"wheel_width_m", [](const WheelState& s) { return s.wheel.width_m; },
     [](WheelState& s, double v) { s.wheel.width_m = v; }},
    {"grouser_height_m", [](const WheelState& s) { return s.wheel.grouser_height_m; },
     [](WheelState& s, double v) { s.wheel.grouser_height_m = v; }},
    {"grouser_count", [](const WheelState& s) { return static_cast<double>(s.wheel.grouser_count); },
     [](WheelState& s, double v) { s.wheel.grouser_count = static_cast<int>(std::lround(v)); }},
};

}  // namespace

double WheelState::covariate(std::string_view name) const {
  for (const Column& column : kColumns)
    if (name == column.name) return column.value(*this);
  for (const auto& [key, value] : extra)
    if (key == name) return value;
  for (const auto& [key, text] : group)
    if (key == name) return 1.0;
  if (const auto star = name.find('*'); star != std::string_view::npos)
    return covariate(name.substr(0, star)) * covariate(name.substr(star + 1));
  return name == "constant" ? 1.0 : kUnknown;
}

void WheelState::setCovariate(std::string_view name, double value) {
  for (const Column& column : kColumns)
    if (name == column.name) return column.set(*this, value);
  for (auto& [key, number] : extra)
    if (key == name) number = value;
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
