#include <stdexcept>

#include <talus/planner/route/rover_kinematics.hpp>

namespace talus::planner {
namespace {

constexpr double kStop_s = 20.0;  // ours, not from the literature

}  // namespace

Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::DriveCost& cost) {
  const terramech::Rover& rover = model.rover();
  if (rover.steering == terramech::Steering::Ackermann && rover.turning_radius_m <= 0.0)
    throw std::invalid_argument("rover '" + rover.name +
                                "': turning_radius_m = 0, must be > 0 with steering ackermann");
  const auto lasting = [&](double time_s) {
    return costmap::priced(terramech::TurnEffort{rover.hotel_power_W * time_s, time_s}, 1.0,
                           model.parts().policy.time_weight_W);
  };
  return {.turning_radius_m = rover.turning_radius_m,
          .turns_by_curve = cost.turns(),
          .cusp = lasting(rover.wheel.radius_m / rover.max_speed_mps),
          .stop = lasting(kStop_s)};
}

}  // namespace talus::planner
