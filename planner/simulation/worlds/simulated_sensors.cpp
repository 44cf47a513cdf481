#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {
namespace {

// Standard deviations of the rover's sensors, equal to those assumed by WheelObserver.
constexpr double kSlipNoise = 0.02, kAngleNoise_rad = 0.02, kTorqueNoise = 0.05, kSinkageNoise = 0.03;
constexpr double kSecondNoise = 0.03;  // of the slip by rim speed and odometry
// Standard deviation of the difference between the slip of one wheel and the slip of the rover.
constexpr double kEncoderNoise = 0.005;
// Magnitudes of the faults of SensorFault.
constexpr double kSlipBias = -0.2, kTorqueOffset = 0.15, kSinkageOffset = -0.1;
constexpr double kDisplaced_m = 5.0, kDisplacedFor_m = 10.0;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

const std::vector<std::string_view>& sensorFaultNames() {
  static const std::vector<std::string_view> names{"none",           "slip_stuck",    "slip_biased",
                                                   "odometry_stuck", "torque_offset", "sinkage_datum",
                                                   "silent",         "pose_displaced"};
  return names;
}

terramech::Telemetry telemetryOf(const WheelMeasurements& look) {
  using R = const costmap::TelemetryReading&;
  using All = const WheelMeasurements&;
  constexpr std::pair<const char*, double (*)(R, All)> kColumns[] = {
      {"time_s", [](R r, All) { return r.time_s; }},
      {"x_m", [](R r, All) { return r.place.x_m; }},
      {"y_m", [](R r, All) { return r.place.y_m; }},
      {"heading_rad", [](R, All all) { return all.heading_rad; }},
      {"slope_rad", [](R r, All) { return std::atan(r.gradient); }},
      {"roll_rad", [](R r, All) { return std::atan(r.across); }},
      {"slip", [](R r, All) { return r.slip; }},
      {"slip_angle_rad", [](R r, All) { return r.slip_angle_rad; }},
      {"rim_speed_mps", [](R, All all) { return all.rim_speed_mps; }},
      {"speed_mps", [](R r, All all) { return all.rim_speed_mps * (1.0 - r.speed_slip); }},
      {"load_N", [](R r, All) { return r.load_N; }},
      {"torque_Nm", [](R r, All) { return r.torque_Nm; }},
      {"sinkage_m", [](R r, All) { return r.sinkage_m; }},
      {"pass_index", [](R r, All) { return static_cast<double>(r.pass); }}};
  terramech::Telemetry rows{
      .source = "simulation", .numbers = {}, .words = {{"wheel", {}}}, .lines = {}, .rejected = {}};
  for (const auto& [name, field] : kColumns) rows.numbers.push_back({name, {}});
  for (std::size_t w = 0; w < look.wheels.size(); ++w) {
    if (std::isnan(look.wheels[w].slip)) continue;
    for (std::size_t c = 0; c < rows.numbers.size(); ++c)
      rows.numbers[c].values.push_back(kColumns[c].second(look.wheels[w], look));
    rows.words[0].values.push_back("w" + std::to_string(w + 1));
    rows.lines.push_back(rows.lines.size() + 1);
  }
  return rows;
}

SimulatedSensors::SimulatedSensors(const SensorOptions& options, const terramech::Rover& rover)
    : options_(options), rover_(rover), random_(options.seed), random_speed_(~options.seed) {
  if (!(options.pose_drift >= 0.0 && options.pose_drift <= kMostPoseDrift))
    throw std::invalid_argument("SensorOptions: pose_drift = " + std::to_string(options.pose_drift) +
                                ", must be 0 to " + std::to_string(kMostPoseDrift));
  const double way = std::uniform_real_distribution<double>(0.0, 6.283185307179586)(random_);
  drift_per_m_ = {options.pose_drift * std::cos(way), options.pose_drift * std::sin(way)};
  displaced_from_m_ = std::uniform_real_distribution<double>(5.0, 20.0)(random_);
  faulty_wheel_ =
      static_cast<std::size_t>(random_() % static_cast<std::uint64_t>(std::max(rover.wheel_count, 1)));
}

maps::Point SimulatedSensors::estimatedPlace(const maps::Point& place) const noexcept {
  return {place.x_m + drift_.x_m, place.y_m + drift_.y_m};
}

void SimulatedSensors::moved(double distance_m) {
  drift_.x_m += drift_per_m_.x_m * distance_m;
  drift_.y_m += drift_per_m_.y_m * distance_m;
  driven_m_ += distance_m;
}

bool SimulatedSensors::drops() {
  return options_.noise && std::uniform_real_distribution<double>(0.0, 1.0)(random_) < options_.dropout;
}

WheelMeasurements SimulatedSensors::look(const TrueWorld::Step& step, const Moment& moment) {
  const double radius_m = rover_.wheel.radius_m, noise = options_.noise ? 1.0 : 0.0;
  WheelMeasurements look{.heading_rad = std::atan2(moment.heading.y, moment.heading.x),
                         .slip_angle_rad = step.slip_angle_rad + noise * kAngleNoise_rad * normal_(random_),
                         .rim_speed_mps = rover_.max_speed_mps,
                         .wheels = {}};
  const double slip = step.slip + noise * kSlipNoise * normal_(random_);
  for (const TrueWorld::SimulatedWheel& wheel : step.wheels) {
    const double own_slip = slip + noise * kEncoderNoise * normal_(random_);
    const double torque = wheel.forces.torque * (1.0 + noise * kTorqueNoise * normal_(random_));
    const double sinkage = wheel.forces.sinkage * (1.0 + noise * kSinkageNoise * normal_(random_));
    look.wheels.push_back({.time_s = moment.time_s,
                           .place = estimatedPlace(wheel.place),
                           .load_N = wheel.load_N,
                           .slip = std::clamp(own_slip, -1.0, 1.0),
                           .torque_Nm = drops() ? kNone : torque * wheel.load_N * radius_m,
                           .sinkage_m = drops() ? kNone : sinkage * radius_m + moment.dug_m,
                           .gradient = moment.gradient,
                           .across = moment.across,
                           .slip_angle_rad = look.slip_angle_rad,
                           .drawbar_pull_N = kNone,
                           .pass = wheel.passes + 1});
    if (options_.second_slip)
      look.wheels.back().speed_slip = step.slip + noise * kSecondNoise * normal_speed_(random_speed_);
    spoil(look.wheels.back(), look.wheels.size() - 1);
  }
  return look;
}

void SimulatedSensors::spoil(costmap::TelemetryReading& reading, std::size_t wheel) {
  const double radius_m = rover_.wheel.radius_m;
  const bool mine = wheel == faulty_wheel_;
  const double displaced_m = driven_m_ - displaced_from_m_;
  switch (options_.fault) {
    case SensorFault::SlipStuck:
    case SensorFault::OdometryStuck:
      if (!mine && options_.fault == SensorFault::SlipStuck) return;
      if (!stuck_slip_) stuck_slip_ = reading.slip;
      reading.slip = *stuck_slip_;
      if (options_.fault == SensorFault::OdometryStuck) reading.speed_slip = reading.slip;
      return;
    case SensorFault::SlipBiased:
      if (mine) reading.slip = std::clamp(reading.slip + kSlipBias, -1.0, 1.0);
      return;
    case SensorFault::TorqueOffset:
      if (mine) reading.torque_Nm += kTorqueOffset * reading.load_N * radius_m;
      return;
    case SensorFault::SinkageDatum:
      if (mine) reading.sinkage_m = std::max(reading.sinkage_m + kSinkageOffset * radius_m, 0.0);
      return;
    case SensorFault::Silent:
      if (mine) reading.slip = reading.torque_Nm = reading.sinkage_m = kNone;
      return;
    case SensorFault::PoseDisplaced:
      if (displaced_m >= 0.0 && displaced_m < kDisplacedFor_m) reading.place.x_m += kDisplaced_m;
      return;
    case SensorFault::None:
      return;
  }
}

}  // namespace talus::planner
