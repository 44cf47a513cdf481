#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/numerics/functions.hpp>

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
  const TurnEffort on_arc = effort(scrub_J, row_m / rover.max_speed_mps),
                   in_place =
                       effort(scrub_J + ground.rolling_J_per_m * rolled_m, swept_m / rover.max_speed_mps);
  return {on_arc, in_place, rover.turning_radius_m > 0.0 ? on_arc : in_place};
}

namespace {

void checkWheels(const Rover& rover) {
  validate(rover);
  if (rover.wheel_count >= 4 && rover.wheel_count <= RoverStance::kMostWheels && rover.wheel_count % 2 == 0)
    return;
  throw std::invalid_argument("rover '" + rover.name +
                              "': wheels.count = " + std::to_string(rover.wheel_count) +
                              ", must be even, 4 to 12, on slopes in two dimensions");
}

}  // namespace

RoverStance::RoverStance(const Rover& rover)
    : half_base_m_(0.5 * rover.wheelbase_m),
      half_track_m_(0.5 * rover.track_m),
      centre_m_{rover.centre_of_mass_ahead_m, rover.centre_of_mass_left_m},
      height_m_(rover.centre_of_mass_height_m) {
  checkWheels(rover);
  wheels_ = rover.wheel_count;
  const int axles = wheels_ / 2;
  for (int k = 0; k < wheels_; ++k) {
    const double x = half_base_m_ * (1.0 - 2.0 * (k / 2) / (axles - 1.0));
    const double y = k % 2 == 0 ? half_track_m_ : -half_track_m_;
    position_m_[static_cast<std::size_t>(k)] = {x, y};
    sum_xx_ += x * x;
    sum_yy_ += y * y;
  }
}

RoverStance::Loads RoverStance::shares(const Planar& demand) const {
  // Point at which the line of action of the weight meets the plane.
  const Planar at{centre_m_.x - height_m_ * demand.x, centre_m_.y - height_m_ * demand.y};
  Loads shares{};
  bool lifts = false;
  for (int k = 0; k < wheels_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    shares[i] = 1.0 / wheels_ + at.x * position_m_[i].x / sum_xx_ + at.y * position_m_[i].y / sum_yy_;
    lifts = lifts || shares[i] < 0.0;
  }
  return lifts ? lifted(at, shares) : shares;
}

RoverStance::Loads RoverStance::lifted(const Planar& at, Loads shares) const {
  std::array<bool, kMostWheels> down{};
  for (int k = 0; k < wheels_; ++k)
    down[static_cast<std::size_t>(k)] = shares[static_cast<std::size_t>(k)] >= 0.0;
  for (int round = 0; round < wheels_; ++round) {
    // Least squares with sum N = 1, sum N x = at.x, sum N y = at.y: N = A^T (A A^T)^-1 (1, at).
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    const auto row = [&](std::size_t i) { return Eigen::Vector3d{1.0, position_m_[i].x, position_m_[i].y}; };
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheels_); ++i)
      if (down[i]) square += row(i) * row(i).transpose();
    const Eigen::Vector3d weights =
        square.completeOrthogonalDecomposition().solve(Eigen::Vector3d{1.0, at.x, at.y});
    bool again = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheels_); ++i) {
      shares[i] = down[i] ? row(i).dot(weights) : 0.0;
      if (shares[i] < 0.0) {
        down[i] = false;
        again = true;
      }
    }
    if (!again) break;
  }
  double sum = 0.0;
  for (double& share : shares) sum += share = std::max(share, 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

double RoverStance::stabilityMargin_rad(const Planar& demand) const {
  if (height_m_ == 0.0) return std::numeric_limits<double>::quiet_NaN();
  const auto margin = [&](double reach_m, double demand_towards) {
    return std::atan2(reach_m, height_m_) - std::atan(demand_towards);
  };
  return std::min(
      {margin(half_base_m_ + centre_m_.x, demand.x), margin(half_base_m_ - centre_m_.x, -demand.x),
       margin(half_track_m_ + centre_m_.y, demand.y), margin(half_track_m_ - centre_m_.y, -demand.y)});
}

}  // namespace talus::terramech
