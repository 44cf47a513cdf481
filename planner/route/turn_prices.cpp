#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <talus/planner/route/turn_prices.hpp>

namespace talus::planner {
namespace {

constexpr double kStop_s = 20.0;  // ours, not from the literature

using terramech::Rover;
using terramech::Steering;

// Sum over the wheels of a force a wheel times its distance from the middle along the heading [N m].
double scrubLever_Nm(const Rover& rover, double force_N) noexcept {
  const int axles = std::max(1, rover.wheel_count / 2);
  double lever = 0.0;
  for (int k = 0; k < axles; ++k) {
    const double x = axles == 1 ? 0.0 : rover.wheelbase_m * (static_cast<double>(k) / (axles - 1) - 0.5);
    lever += 2.0 * force_N * std::abs(x);
  }
  return lever;
}

TurnPrice price(const Rover& rover, const TurningGround& ground, double drive_J, double time_s) noexcept {
  const double energy_J = drive_J + rover.hotel_power_W * time_s;
  return {.cost_J = energy_J + ground.time_weight_W * time_s, .energy_J = energy_J, .time_s = time_s};
}

// What the table of a curve states on the flat; zeros where it has none.
costmap::DriveState onTheFlat(const costmap::DriveCost& cost, std::size_t curve) noexcept {
  const auto& table = cost.states()[curve];
  return table ? (*table)[costmap::DriveCurve::kBins / 2] : costmap::DriveState{};
}

TurningGround groundOf(const costmap::GroundModel& model, const terramech::Soil& soil,
                       const costmap::DriveState& flat) noexcept {
  return {.lateral_resistance = std::tan(soil.friction_angle_rad),
          .bulldozing_N = bulldozing_N(soil, model.rover(), static_cast<double>(flat.sinkage_m)),
          .rolling_J_per_m =
              std::max(0.0, static_cast<double>(flat.energy_J_per_m) -
                                model.rover().hotel_power_W * static_cast<double>(flat.time_s_per_m)),
          .time_weight_W = model.parts().policy.time_weight_W};
}

double passivePressure(const terramech::Soil& soil) noexcept {
  const double t = std::tan(std::numbers::pi / 4 + soil.friction_angle_rad / 2);
  return t * t;
}

}  // namespace

double bulldozing_N(const terramech::Soil& soil, const Rover& rover, double sinkage_m) noexcept {
  const double z = std::clamp(sinkage_m, 0.0, rover.wheel.radius_m);
  const double chord_m = 2.0 * std::sqrt(2.0 * rover.wheel.radius_m * z - z * z);
  const double k = passivePressure(soil);
  return (0.5 * soil.density_kg_m3 * rover.gravity_m_s2 * z * z * k +
          2.0 * soil.cohesion_Pa * z * std::sqrt(k)) *
         chord_m;
}

TurnPrices turnPrices(const Rover& rover, const TurningGround& ground) noexcept {
  const double rho_m = 0.5 * std::hypot(rover.wheelbase_m, rover.track_m), row_m = 0.5 * rover.track_m;
  const bool skids = rover.steering == Steering::Skid;
  const double dragged_N = ground.lateral_resistance * terramech::wheelLoad_N(rover) + ground.bulldozing_N;
  const double scrub_J = skids ? scrubLever_Nm(rover, dragged_N) : 0.0;
  const double swept_m = skids ? row_m : rho_m;
  return {.on_arc = price(rover, ground, scrub_J, row_m / rover.max_speed_mps),
          .in_place = price(rover, ground, scrub_J + ground.rolling_J_per_m * swept_m,
                            swept_m / rover.max_speed_mps)};
}

Kinematics kinematicsOf(const Rover& rover, const TurningGround& ground) {
  if (rover.steering == Steering::Ackermann && rover.turning_radius_m <= 0.0)
    throw std::invalid_argument("rover '" + rover.name +
                                "': turning_radius_m = 0, must be > 0 with steering ackermann");
  return {.turning_radius_m = rover.turning_radius_m,
          .turns = turnPrices(rover, ground),
          .cusp = price(rover, ground, 0.0, rover.wheel.radius_m / rover.max_speed_mps),
          .stop = price(rover, ground, 0.0, kStop_s)};
}

Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::DriveCost& cost) {
  const auto& classes = model.parts().classes;
  const auto softest = std::ranges::min_element(
      classes, {}, [](const costmap::GroundClass& c) { return c.soil.friction_angle_rad; });
  Kinematics kinematics = kinematicsOf(model.rover(), groundOf(model, softest->soil, onTheFlat(cost, 0)));
  for (std::size_t k = 0; k < cost.curves().size(); ++k) {
    const costmap::DriveState flat = onTheFlat(cost, k);
    const bool own =
        k < classes.size() && flat.class_index == k;  // a class's number may be lent to another belief
    kinematics.turns_by_curve.push_back(
        turnPrices(model.rover(), groundOf(model, own ? classes[k].soil : softest->soil, flat)));
  }
  return kinematics;
}

}  // namespace talus::planner
