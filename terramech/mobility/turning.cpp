#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/terramech/mobility/turning.hpp>

namespace talus::terramech {
namespace {

// Mean over the axles of a function of the axle position x.
template <typename Number>
double meanOverAxles(const Rover& rover, Number number) noexcept {
  const int axles = std::max(1, rover.wheel_count / 2);
  double sum = 0.0;
  for (int k = 0; k < axles; ++k)
    sum += number(axles == 1 ? 0.0 : rover.wheelbase_m * (static_cast<double>(k) / (axles - 1) - 0.5));
  return sum / axles;
}

double passivePressure(const Soil& soil) noexcept {
  const double t = std::tan(std::numbers::pi / 4 + soil.friction_angle_rad / 2);
  return t * t;
}

}  // namespace

double bulldozing_N(const Soil& soil, const Rover& rover, double sinkage_m) noexcept {
  const double z = std::clamp(sinkage_m, 0.0, rover.wheel.radius_m);
  const double chord_m = 2.0 * std::sqrt(2.0 * rover.wheel.radius_m * z - z * z);
  const double k = passivePressure(soil);
  return (0.5 * soil.density_kg_m3 * rover.gravity_m_s2 * z * z * k +
          2.0 * soil.cohesion_Pa * z * std::sqrt(k)) *
         chord_m;
}

TurnEfforts turnEfforts(const Rover& rover, const TurningGround& ground) noexcept {
  const double rho_m = 0.5 * std::hypot(rover.wheelbase_m, rover.track_m), row_m = 0.5 * rover.track_m;
  const bool skids = rover.steering == Steering::Skid;
  const double dragged_N = ground.lateral_resistance * wheelLoad_N(rover) + ground.bulldozing_N;
  const double scrub_J = skids ? 2.0 * std::max(1, rover.wheel_count / 2) * dragged_N *
                                     meanOverAxles(rover, [](double x_m) { return std::abs(x_m); })
                               : 0.0;
  const double swept_m = skids ? row_m : rho_m,
               rolled_m =
                   skids ? row_m : meanOverAxles(rover, [&](double x_m) { return std::hypot(x_m, row_m); });
  const auto effort = [&](double drive_J, double time_s) {
    return TurnEffort{.energy_J = drive_J + rover.hotel_power_W * time_s, .time_s = time_s};
  };
  return {.on_arc = effort(scrub_J, row_m / rover.max_speed_mps),
          .in_place = effort(scrub_J + ground.rolling_J_per_m * rolled_m, swept_m / rover.max_speed_mps)};
}

}  // namespace talus::terramech
