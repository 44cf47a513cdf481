#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include <talus/terramech/contact/shear_displacement.hpp>
#include <talus/terramech/mobility/rover_stance.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

constexpr double kSunk = 0.999;  // sinkage over radius, z/r, of a wheel sunk to its axle

/// Returns the force components along and across the direction of travel, for a wheel plane at angle beta to
/// the right of that direction.
Planar turned(double along_wheel, double across_wheel, double beta) {
  const double c = std::cos(beta), s = std::sin(beta);
  return {along_wheel * c + across_wheel * s, across_wheel * c - along_wheel * s};
}

const SlopeOptions& checked(const SlopeOptions& options) {
  const RangeCheck check{"slope options"};
  check.within("max_slip", options.max_slip, {1e-6, 1.0});
  check.within("max_slip_angle_rad", options.max_slip_angle_rad, {1e-6, 1.04});
  return options;
}

}  // namespace

Planar demandOf(const Gradient& g) noexcept {
  const double run = std::sqrt(1.0 + g.along * g.along);
  return {g.along * std::sqrt(1.0 + g.along * g.along + g.across * g.across) / run, g.across / run};
}

class SlopeEquilibrium::Solver {
 public:
  Solver(WheelForcesTable forces, const Rover& rover, const SlopeOptions& options)
      : forces_(std::move(forces)), rover_(rover), options_(checked(options)), stance_(rover) {}

  SlopeState at(const Gradient& gradient) const noexcept;
  std::vector<WheelOnSlope> wheels(const Gradient& gradient, const SlopeState& state) const;
  WheelOnSlope wheel(const WheelMotion& motion) const noexcept;
  WheelOnSlope evenWheel(double slip, double slip_angle_rad) const noexcept {
    return wheel({wheelLoad_N(rover_), slip, slip_angle_rad});
  }
  const RoverStance& stance() const { return stance_; }
  Solver withEvenLoads() const {
    Rover even = rover_;
    even.centre_of_mass_height_m = even.centre_of_mass_ahead_m = even.centre_of_mass_left_m = 0.0;
    return {forces_, even, options_};
  }

 private:
  /// Unknowns: slip, slip angle, and the steering or slip difference that balances the yaw moment.
  struct Unknowns {
    double slip = 0.0, angle_rad = 0.0, difference = 0.0;
  };

  /// Residuals of the force balance along and across, divided by the normal force, and of the yaw moment over
  /// normal force and half wheelbase; derivatives by the unknowns at constant loads.
  struct Balance {
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();
    Eigen::Matrix3d by = Eigen::Matrix3d::Zero();
  };

  /// Result of a scan of the table's nodes under even loads: initial values at the first slip angle that
  /// meets the demand, and the largest lateral force.
  struct Scan {
    bool found = false, pulls = false;
    Unknowns start;
    double most_side = 0.0;
  };

  Balance balance(const Planar& demand, double normal_N, const Unknowns& u) const noexcept;
  Scan scan(const Planar& demand) const noexcept;
  bool solve(const Planar& demand, double normal_N, Unknowns& u) const noexcept;
  SlopeFailure gripOf(const SlopeState& state, const Unknowns& u) const noexcept;
  void fill(const Planar& demand, double normal_N, const Unknowns& u, SlopeState& state) const noexcept;
  WheelMotion motionOf(int wheel, const Unknowns& u) const noexcept;
  RoverStance::Loads shares(const Planar& demand) const noexcept;
  double normal_N(const Gradient& gradient) const noexcept;

  WheelForcesTable forces_;
  Rover rover_;
  SlopeOptions options_;
  RoverStance stance_;
};

const char* name(SlopeFailure failure) {
  constexpr std::array<const char*, 6> names{"holds", "tips", "sinks", "cannot pull", "slides", "torque"};
  return names[static_cast<std::size_t>(failure)];
}

double SlopeEquilibrium::Solver::normal_N(const Gradient& g) const noexcept {
  return rover_.mass_kg * rover_.gravity_m_s2 / std::sqrt(1.0 + g.along * g.along + g.across * g.across);
}

/// Load shares for a demand in body axes. The demand is limited to 0.97 of tip-over, because grip is not
/// defined with all weight on one axle or side.
RoverStance::Loads SlopeEquilibrium::Solver::shares(const Planar& demand) const noexcept {
  constexpr double kMost = 0.97;
  const Planar centre = stance_.centre_m();
  const double half_base = stance_.position_m(0).x, half_track = stance_.position_m(0).y,
               height = rover_.centre_of_mass_height_m;
  const auto within = [&](double half, double ahead, double towards) {
    const double moved = height * std::abs(towards),
                 room = kMost * (towards < 0.0 ? half - ahead : half + ahead);
    return moved > room ? room / moved : 1.0;
  };
  const double part = std::min(within(half_base, centre.x, demand.x), within(half_track, centre.y, demand.y));
  return stance_.shares({part * demand.x, part * demand.y});
}

/// Slip and slip angle of a wheel for the given unknowns.
WheelMotion SlopeEquilibrium::Solver::motionOf(int wheel, const Unknowns& u) const noexcept {
  const Planar at = stance_.position_m(wheel);
  WheelMotion motion{0.0, u.slip, u.angle_rad};
  if (rover_.steering == Steering::AllWheel)
    motion.slip_angle_rad -= 0.5 * u.difference * at.x / stance_.position_m(0).x;
  else if (rover_.steering == Steering::Ackermann && wheel < 2)
    motion.slip_angle_rad -= u.difference;
  else if (rover_.steering == Steering::Skid)
    motion.slip -= std::copysign(0.5, at.y) * u.difference;
  motion.slip = std::clamp(motion.slip, -1.0, 1.0);
  return motion;
}

SlopeEquilibrium::Solver::Balance SlopeEquilibrium::Solver::balance(const Planar& demand, double normal,
                                                                    const Unknowns& u) const noexcept {
  const bool crabs = rover_.steering == Steering::AllWheel, skids = rover_.steering == Steering::Skid;
  // Body angle `turn` to the right of the direction of travel; the wheels turn with the body.
  const double turn = crabs ? 0.0 : u.angle_rad, c = std::cos(turn), s = std::sin(turn);
  const auto shares = this->shares({demand.x * c - demand.y * s, demand.x * s + demand.y * c});
  const double lever = 1.0 / stance_.position_m(0).x;
  Balance b;
  b.rest << -demand.x, -demand.y, 0.0;
  for (int k = 0; k < stance_.wheels(); ++k) {
    const double share = shares[static_cast<std::size_t>(k)];
    if (share <= 0.0) continue;
    WheelMotion motion = motionOf(k, u);
    motion.load_N = share * normal;
    const WheelRatios f = forces_.at(motion);
    const double beta = motion.slip_angle_rad;
    const Planar force = turned(f.value[kPullRatio], f.value[kSideRatio], beta);
    const Planar by_slip = turned(f.by_slip[kPullRatio], f.by_slip[kSideRatio], beta);
    Planar by_angle = turned(f.by_angle[kPullRatio], f.by_angle[kSideRatio], beta);
    by_angle.x += force.y;  // rotation of the force
    by_angle.y -= force.x;
    const Planar at = stance_.position_m(k), centre = stance_.centre_m();
    const double x = at.x - centre.x, y = at.y - centre.y;
    // Vector from the centre of mass to the wheel, along and across the direction of travel [lever lengths].
    const Planar arm{lever * (x * c + y * s), lever * (y * c - x * s)};
    const double angle_by_difference = crabs   ? -0.5 * at.x / stance_.position_m(0).x
                                       : skids ? 0.0
                                               : (k < 2 ? -1.0 : 0.0);
    const double slip_by_difference = skids ? -std::copysign(0.5, at.y) : 0.0;
    const auto moment = [&](const Planar& p) { return arm.x * p.y - arm.y * p.x; };
    const Planar by_difference{by_slip.x * slip_by_difference + by_angle.x * angle_by_difference,
                               by_slip.y * slip_by_difference + by_angle.y * angle_by_difference};
    b.rest += share * Eigen::Vector3d{force.x, force.y, moment(force)};
    b.by.col(0) += share * Eigen::Vector3d{by_slip.x, by_slip.y, moment(by_slip)};
    b.by.col(1) += share * Eigen::Vector3d{by_angle.x, by_angle.y, moment(by_angle)};
    b.by.col(2) += share * Eigen::Vector3d{by_difference.x, by_difference.y, moment(by_difference)};
  }
  return b;
}

/// Scans the slip angles of the table towards the uphill side. For each angle, finds the least slip that
/// meets the demand along, and the lateral force there; selects the first angle whose lateral force meets the
/// demand across.
SlopeEquilibrium::Solver::Scan SlopeEquilibrium::Solver::scan(const Planar& demand) const noexcept {
  const double side = demand.y < 0.0 ? -1.0 : 1.0, wanted = std::abs(demand.y);
  constexpr int kRolling = (WheelForcesTable::kSlips - 1) / 2;
  Scan out;
  double last_side = 0.0, last_slip = 0.0;
  bool last = false;
  for (int a = 0; a < WheelForcesTable::kAngles; ++a) {
    const double beta = WheelForcesTable::angleOf(a);
    const double c = std::cos(beta), s = std::sin(beta);
    // Mirrored so that downhill is to the right and the lateral force acts to the left.
    const auto along = [&](int k) {
      return forces_.atNode(kPullRatio, k, a) * c + forces_.atNode(kSideRatio, k, a) * s;
    };
    const auto across = [&](int k) {
      return -(forces_.atNode(kSideRatio, k, a) * c - forces_.atNode(kPullRatio, k, a) * s);
    };
    const int step = along(kRolling) < demand.x ? 1 : -1;
    bool reached = false;
    double slip = 0.0, hold = 0.0;
    for (int k = kRolling; k + step >= 0 && k + step < WheelForcesTable::kSlips; k += step) {
      const double from = along(k), to = along(k + step);
      if ((to - demand.x) * step < 0.0) continue;
      const double share = to != from ? std::clamp((demand.x - from) / (to - from), 0.0, 1.0) : 0.0;
      slip = WheelForcesTable::slipOf(k) + share * step * WheelForcesTable::kSlipStep;
      hold = across(k) + share * (across(k + step) - across(k));
      reached = true;
      break;
    }
    if (a == 0) out.pulls = reached && slip <= options_.max_slip;
    if (reached) {
      if (slip <= options_.max_slip && beta <= options_.max_slip_angle_rad + 1e-9)
        out.most_side = std::max(out.most_side, hold);
      if (!out.found && hold >= wanted) {
        const double share = last && hold > last_side ? (wanted - last_side) / (hold - last_side) : 1.0;
        out.start.slip = last ? last_slip + share * (slip - last_slip) : slip;
        out.start.angle_rad =
            0.0 - side * (a == 0 ? 0.0 : beta - (1.0 - share) * WheelForcesTable::kAngleStep_rad);
        out.found = true;
      }
    }
    last = reached;
    last_side = hold;
    last_slip = slip;
  }
  return out;
}

/// Newton's method with steps limited to the table.
bool SlopeEquilibrium::Solver::solve(const Planar& demand, double normal, Unknowns& u) const noexcept {
  constexpr double kClose = 1e-10, kSteepest = 1.04;
  for (int iteration = 0; iteration < 25; ++iteration) {
    const Balance b = balance(demand, normal, u);
    if (b.rest.cwiseAbs().maxCoeff() < kClose) return true;
    const Eigen::Vector3d step = -b.by.inverse() * b.rest;
    if (!step.allFinite()) return false;
    const double shorten =
        1.0 / std::max({1.0, std::abs(step[0]) / 0.15, std::abs(step[1]) / 0.15, std::abs(step[2]) / 0.15});
    u.slip = std::clamp(u.slip + shorten * step[0], -1.0, 1.0);
    u.angle_rad = std::clamp(u.angle_rad + shorten * step[1], -kSteepest, kSteepest);
    u.difference = std::clamp(u.difference + shorten * step[2], -1.0, 1.0);
  }
  return false;
}

void SlopeEquilibrium::Solver::fill(const Planar& demand, double normal, const Unknowns& u,
                                    SlopeState& state) const noexcept {
  const bool crabs = rover_.steering == Steering::AllWheel, skids = rover_.steering == Steering::Skid;
  state.slip = u.slip;
  state.slip_angle_rad =
      rover_.steering == Steering::Ackermann ? u.angle_rad - 0.5 * u.difference : u.angle_rad;
  (skids ? state.slip_difference : state.steering_rad) = u.difference;
  state.body_turn_rad = crabs ? 0.0 : 0.0 - u.angle_rad;
  const double turn = -state.body_turn_rad, c = std::cos(turn), s = std::sin(turn);
  const Planar of_body{demand.x * c - demand.y * s, demand.x * s + demand.y * c};
  state.stability_margin_rad = stance_.stabilityMargin_rad(of_body);
  const auto shares = this->shares(of_body);
  const double radius = rover_.wheel.radius_m;
  // The travel speed is limited by the fastest rim, at max_speed_mps.
  double power_W_per_mps = 0.0, fastest = 0.0;
  for (int k = 0; k < stance_.wheels(); ++k) {
    WheelMotion motion = motionOf(k, u);
    motion.load_N = shares[static_cast<std::size_t>(k)] * normal;
    if (motion.load_N <= 0.0) continue;
    const WheelRatios f = forces_.at(motion);
    const double torque = f.value[kTorqueRatio] * motion.load_N * radius;
    if (std::abs(torque) > std::abs(state.torque_Nm)) state.torque_Nm = torque;
    state.sinkage_m = std::max(state.sinkage_m, f.value[kSinkageRatio] * radius);
    state.side_force_over_load = std::max(state.side_force_over_load, std::abs(f.value[kSideRatio]));
    // r omega over travel speed.
    const double rim = std::cos(motion.slip_angle_rad) / std::max(travelRatio(motion.slip), 1e-9);
    fastest = std::max(fastest, rim);
    power_W_per_mps += std::max(torque, 0.0) * rim / radius;
  }
  state.speed_mps = rover_.max_speed_mps / std::max(fastest, 1.0);
  state.energy_J_per_m = power_W_per_mps + rover_.hotel_power_W / state.speed_mps;
  // Pull reserve at the current slip angle, from nodes under even loads.
  const double size = std::abs(u.angle_rad);
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  for (double slip = -1.0; slip <= options_.max_slip + 1e-9; slip += WheelForcesTable::kSlipStep) {
    const WheelRatios f = forces_.at({normal / stance_.wheels(), slip, size});
    const double along = turned(f.value[kPullRatio], f.value[kSideRatio], size).x;
    most = std::max(most, along);
    least = std::min(least, along);
  }
  state.pull_reserve = std::min(most - demand.x, demand.x - least);
}

SlopeFailure SlopeEquilibrium::Solver::gripOf(const SlopeState& state, const Unknowns& u) const noexcept {
  if (state.sinkage_m > kSunk * rover_.wheel.radius_m || state.sinkage_m >= rover_.clearance_m)
    return SlopeFailure::Sinks;
  if (state.slip + 0.5 * std::abs(state.slip_difference) > options_.max_slip) return SlopeFailure::CannotPull;
  if (std::abs(u.angle_rad) > options_.max_slip_angle_rad) return SlopeFailure::Slides;
  if (std::abs(state.torque_Nm) > rover_.max_torque_Nm) return SlopeFailure::Torque;
  return SlopeFailure::None;
}

SlopeState SlopeEquilibrium::Solver::at(const Gradient& gradient) const noexcept {
  const Planar demand = demandOf(gradient);
  const double normal = normal_N(gradient);
  SlopeState state;
  const Scan scanned = scan(demand);
  state.side_reserve = scanned.most_side - std::abs(demand.y);
  Unknowns u = scanned.start;
  if (scanned.found && solve(demand, normal, u)) {
    fill(demand, normal, u, state);
    state.grip = gripOf(state, u);
  } else {
    const double rolling = forces_.atNode(kSinkageRatio, (WheelForcesTable::kSlips - 1) / 2, 0);
    const bool sunk = rolling > kSunk || rolling * rover_.wheel.radius_m >= rover_.clearance_m;
    state.stability_margin_rad = stance_.stabilityMargin_rad(demand);  // body angle unknown
    // If the rover has an equilibrium under even loads, the failure is that of the larger component of the
    // gradient.
    const bool lacks_pull = !scanned.pulls || (scanned.found && std::abs(gradient.across) <= gradient.along);
    state.grip = sunk                                 ? SlopeFailure::Sinks
                 : lacks_pull && gradient.along > 0.0 ? SlopeFailure::CannotPull
                                                      : SlopeFailure::Slides;
    state.side_reserve = std::min(state.side_reserve, 0.0);
  }
  state.failure = state.stability_margin_rad < 0.0 ? SlopeFailure::Tips : state.grip;
  return state;
}

std::vector<WheelOnSlope> SlopeEquilibrium::Solver::wheels(const Gradient& gradient,
                                                           const SlopeState& state) const {
  const Planar demand = demandOf(gradient);
  const double normal = normal_N(gradient), turn = -state.body_turn_rad, c = std::cos(turn),
               s = std::sin(turn);
  const auto shares = this->shares({demand.x * c - demand.y * s, demand.x * s + demand.y * c});
  const bool ackermann = rover_.steering == Steering::Ackermann;
  const Unknowns u{state.slip, ackermann ? -state.body_turn_rad : state.slip_angle_rad,
                   rover_.steering == Steering::Skid ? state.slip_difference : state.steering_rad};
  std::vector<WheelOnSlope> all;
  for (int k = 0; k < stance_.wheels(); ++k) {
    WheelMotion motion = motionOf(k, u);
    motion.load_N = shares[static_cast<std::size_t>(k)] * normal;
    all.push_back(wheel(motion));
  }
  return all;
}

WheelOnSlope SlopeEquilibrium::Solver::wheel(const WheelMotion& motion) const noexcept {
  const WheelRatios f = forces_.at(motion);
  const double r = rover_.wheel.radius_m, load_N = motion.load_N;
  return {load_N,
          motion.slip,
          motion.slip_angle_rad,
          f.value[kSinkageRatio] * r,
          f.value[kTorqueRatio] * load_N * r,
          f.value[kPullRatio] * load_N,
          f.value[kSideRatio] * load_N};
}

SlopeEquilibrium::SlopeEquilibrium(const Soil& soil, const Rover& rover, const SlopeOptions& options)
    : solver_(std::make_shared<const Solver>(WheelForcesTable(soil, rover), rover, options)) {}

SlopeEquilibrium::SlopeEquilibrium(const RefinedModel& model, const Rover& rover, const SlopeOptions& options)
    : solver_(std::make_shared<const Solver>(WheelForcesTable(model, rover), rover, options)) {}

SlopeEquilibrium::SlopeEquilibrium(std::shared_ptr<const Solver> solver) : solver_(std::move(solver)) {}

SlopeEquilibrium SlopeEquilibrium::withEvenLoads() const {
  return SlopeEquilibrium(std::make_shared<const Solver>(solver_->withEvenLoads()));
}

SlopeState SlopeEquilibrium::at(const Gradient& gradient) const noexcept {
  return solver_->at(gradient);
}

std::vector<WheelOnSlope> SlopeEquilibrium::wheels(const Gradient& gradient, const SlopeState& state) const {
  return solver_->wheels(gradient, state);
}

WheelOnSlope SlopeEquilibrium::evenWheel(double slip, double slip_angle_rad) const noexcept {
  return solver_->evenWheel(slip, slip_angle_rad);
}

bool SlopeEquilibrium::symmetric() const noexcept {
  return solver_->stance().centre_m().y == 0.0;
}

std::vector<std::string> slopeAssumptions(const Rover& rover) {
  std::vector<std::string> all;
  if (rover.centre_of_mass_height_m == 0.0)
    all.push_back("rover '" + rover.name +
                  "': centre_of_mass_height_m is not given: slopes move no load between its wheels, and it "
                  "does not tip");
  return all;
}

}  // namespace talus::terramech
