#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <planner/drive_log.hpp>

namespace talus::planner {
namespace {

// Standard deviations of the rover's sensors, as rehearse() draws them.
constexpr double kSlipNoise = 0.02, kTorqueNoise = 0.05, kSinkageNoise = 0.03;
constexpr double kRowEvery_m = 1.0;

}  // namespace

PredictionErrors DriveLog::errors() const {
  PredictionErrors e{.steps = static_cast<int>(steps_.size())};
  double slip = 0.0, energy = 0.0, expected_J = 0.0, true_J = 0.0, length_m = 0.0;
  for (const DriveStep& s : steps_) {
    const double surface_m = s.length_m * std::hypot(1.0, s.gradient);
    slip += std::pow(s.expected_slip - s.truth.slip, 2);
    energy += std::pow(s.expected_energy_J_per_m - s.truth.energy_J_per_m, 2);
    expected_J += s.expected_energy_J_per_m * surface_m;
    true_J += s.truth.energy_J_per_m * surface_m;
    length_m += surface_m;
  }
  if (steps_.empty() || true_J <= 0.0) return e;
  const auto n = static_cast<double>(steps_.size());
  e.slip_rmse = std::sqrt(slip / n);
  e.energy_rmse = std::sqrt(energy / n) / (true_J / length_m);
  e.energy_error = expected_J / true_J - 1.0;
  return e;
}

std::string DriveLog::telemetry(const terramech::Rover& rover, std::uint64_t seed) const {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  std::string text =
      "time_s,x_m,y_m,heading_rad,slope_rad,pass_index,slip,load_N,torque_Nm,sinkage_m,wheel_radius_m,"
      "wheel_width_m,grouser_height_m\n";
  const double radius_m = rover.wheel.radius_m;
  double since_m = kRowEvery_m;
  for (const DriveStep& s : steps_) {
    since_m += s.length_m;
    if (since_m < kRowEvery_m) continue;
    since_m = 0.0;
    const double slip = std::clamp(s.truth.slip + kSlipNoise * noise(random), -1.0, 1.0);
    for (const TrueWorld::WheelState& wheel : s.truth.wheels) {
      const double torque =
          wheel.forces.torque * wheel.load_N * radius_m * (1.0 + kTorqueNoise * noise(random));
      const double sinkage = wheel.forces.sinkage * radius_m * (1.0 + kSinkageNoise * noise(random));
      char row[320];
      std::snprintf(row, sizeof row, "%.3f,%.4f,%.4f,%.5f,%.5f,%d,%.5f,%.4f,%.6g,%.6g,%.6g,%.6g,%.6g\n",
                    s.time_s, wheel.place.x_m, wheel.place.y_m, std::atan2(s.heading.y, s.heading.x),
                    std::atan(s.gradient), wheel.passes + 1, slip, wheel.load_N, torque, sinkage, radius_m,
                    rover.wheel.width_m, rover.wheel.grouser_height_m);
      text += row;
    }
  }
  return text;
}

}  // namespace talus::planner
