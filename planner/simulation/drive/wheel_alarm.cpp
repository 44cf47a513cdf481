#include <algorithm>
#include <cmath>

#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kRemembered = 120;  // readings
constexpr std::size_t kLeast = 20;        // readings needed for a datum

double medianOf(std::deque<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Excess sinkage divided by the wheel radius, minus the wheel's own datum (the median of earlier excesses).
double WheelAlarm::excessSinkage(std::size_t wheel, const costmap::TelemetryReading& reading,
                                 const WheelExpectation& expected) {
  if (std::isnan(reading.sinkage_m) || reading.pass > 1) return 0.0;
  std::deque<double>& before = excess_[wheel];
  const double excess = reading.sinkage_m / radius_m_ - expected.sinkage_over_radius;
  const double datum = before.size() >= kLeast ? medianOf(before) : 0.0;
  before.push_back(excess);
  if (before.size() > kRemembered) before.pop_front();
  return excess - datum;
}

WheelAlarm::AlarmCheck WheelAlarm::check(const WheelMeasurements& look,
                                         const std::vector<WheelExpectation>& expected) {
  AlarmCheck check;
  excess_.resize(std::max(excess_.size(), look.wheels.size()));
  std::size_t slipping = 0, reading_slip = 0;
  double expected_angle_rad = 0.0;
  for (std::size_t w = 0; w < look.wheels.size(); ++w) {
    const costmap::TelemetryReading& reading = look.wheels[w];
    reading_slip += std::isnan(reading.slip) ? 0U : 1U;
    // The threshold is at least the limit: downhill, slip below the limit is traction even if the expected
    // slip is negative, and a rover that stops there must climb back.
    slipping += reading.slip > std::max(expected[w].slip, 0.0) + limits_.slip ? 1U : 0U;
    expected_angle_rad = std::fmax(expected_angle_rad, expected[w].slip_angle_rad);
    check.sank.push_back(excessSinkage(w, reading, expected[w]) > limits_.sinkage);
  }
  if (slipping > 0 && 2 * slipping >= reading_slip)
    check.reason = "slips";
  else if (std::abs(look.slip_angle_rad) > expected_angle_rad + limits_.slip_angle_rad)
    check.reason = "slides";
  else if (std::find(check.sank.begin(), check.sank.end(), true) != check.sank.end())
    check.reason = "sinks";
  return check;
}

costmap::TravelState MapExpectation::at(const maps::Point& place, const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  const auto grid = map_.published();
  const auto curve = grid->at(*cell).curve();
  return grid->cost().detail(onSlope(curve >= costmap::CellCode::kUnknown ? classCurve(*cell) : curve),
                             heading);
}

costmap::TravelState MapExpectation::ofClass(const maps::Point& place,
                                             const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  costmap::TravelState state = at(place, heading);
  const costmap::TravelState of_class = map_.published()->cost().detail(onSlope(classCurve(*cell)), heading);
  state.slip = std::min(state.slip, of_class.slip);
  state.sinkage_m = std::min(state.sinkage_m, of_class.sinkage_m);
  return state;
}

WheelExpectation MapExpectation::ofWheel(const maps::Point& place, const maps::Point& middle,
                                         const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  const double radius_m = map_.model().rover().wheel.radius_m;
  return {
      .slip = static_cast<double>(ofClass(middle, heading).slip),
      .sinkage_over_radius = static_cast<double>(ofClass(place, heading).sinkage_m) / radius_m,
      .slip_angle_rad =
          cell ? std::abs(map_.published()->cost().hold(onSlope(classCurve(*cell)), heading).slip_angle_rad)
               : 0.0};
}

costmap::CellCode MapExpectation::onSlope(costmap::CellCode::Curve curve) const {
  return costmap::CellCode({.dz_dx = slope_.dzDx(), .dz_dy = slope_.dzDy(), .curve = curve});
}

costmap::CellCode::Curve MapExpectation::classCurve(maps::Cell cell) const noexcept {
  return static_cast<costmap::CellCode::Curve>(std::max(map_.surface().classIndex(cell), 0));
}

}  // namespace talus::planner
