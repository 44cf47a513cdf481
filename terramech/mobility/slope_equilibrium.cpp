#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Dense>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

SteadyWheel mobilityReference(const RefinedModel& model, const Rover& rover, int pass) {
  requireForces(model);
  validate(rover);
  RangeCheck{"wheel"}.atLeast("pass", pass, 1.0);
  const RefinedModel ground = withoutSensors(model);
  const double load_N = wheelLoad_N(rover), radius_m = rover.wheel.radius_m;
  const auto over = [&](const auto& f) {
    return SteadyWheel{f.drawbar_pull_N / load_N, std::min(f.sinkage_m / radius_m, 1.0),
                       f.torque_Nm / (load_N * radius_m)};
  };
  if (!ground.effects.empty()) {
    WheelState state = steadyWheel(rover, load_N, kReferenceSlip);
    state.pass_index = pass;
    state.slope_rad = 0.0;
    return over(predict(ground, state));
  }
  try {
    return over(equilibrium(ground.soil, rover.wheel, {.load_N = load_N, .slip = kReferenceSlip}));
  } catch (const std::domain_error&) {  // sunk to its axle
    return over(
        forcesAtEntry(ground.soil, rover.wheel, {.slip = kReferenceSlip}, 0.5 * std::numbers::pi).forces);
  }
}

namespace {

constexpr double kSunk = 0.999;  // sinkage over radius, z/r, of a wheel sunk to its axle
constexpr double kMostStrength = SlopeEquilibrium::kMostStrength, kStrengthError = 5e-4,
                 kMostSlip = SlopeEquilibrium::kMostSlip,
                 kMostSlipAngle_rad = SlopeEquilibrium::kMostSlipAngle_rad;

/// Returns the force components along and across the direction of travel, for a wheel plane at angle beta to
/// the right of that direction.
Planar turned(double along_wheel, double across_wheel, double beta) {
  const double c = std::cos(beta), s = std::sin(beta);
  return {along_wheel * c + across_wheel * s, across_wheel * c - along_wheel * s};
}

}  // namespace

Planar demandOf(const Gradient& g) noexcept {
  const double run = std::sqrt(1.0 + g.along * g.along);
  return {g.along * std::sqrt(1.0 + g.along * g.along + g.across * g.across) / run, g.across / run};
}

class SlopeEquilibrium::Solver {
 public:
  Solver(WheelForcesTable fresh, WheelForcesTable rut, const Rover& rover)
      : fresh_(std::move(fresh)), rut_(std::move(rut)), rover_(rover), stance_(rover) {
    for (std::size_t a = 0; a < even_in_rut_.size(); ++a)
      for (int axle = 0; axle < stance_.wheels() / 2; ++axle)
        even_in_rut_[a] +=
            2.0 * rutOf(axle, WheelForcesTable::angleOf(static_cast<int>(a))).value / stance_.wheels();
  }

  SlopeState at(const Gradient& gradient, double strength) const noexcept;
  double leastStrength(const Gradient& gradient, double near) const noexcept;
  std::vector<WheelOnSlope> wheels(const Gradient& gradient, const SlopeState& state, double strength) const;
  SteadyWheel evenWheel(WheelMotion motion, bool in_rut) const noexcept;
  const RoverStance& stance() const { return stance_; }
  Solver withoutRuts() const {
    Solver fresh = *this;
    fresh.ruts_ = false;
    fresh.even_in_rut_.fill(0.0);
    return fresh;
  }

 private:
  /// Unknowns: slip, slip angle, and the steering or slip difference that balances the yaw moment.
  struct Unknowns {
    double slip = 0.0, angle_rad = 0.0, difference = 0.0;
  };

  /// Plane and ground of one equilibrium.
  struct Ground {
    Planar demand;
    double normal_N, strength;
  };

  /// Share of a wheel's width that rolls in the rut of the axle ahead, and its derivative by the slip angle.
  struct RutShare {
    double value = 0.0, by_angle = 0.0;
  };

  /// Residuals of the force balance along and across, divided by the normal force, and of the yaw moment over
  /// normal force and half wheelbase; derivatives by the unknowns at constant loads.
  struct Balance {
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();
    Eigen::Matrix3d by = Eigen::Matrix3d::Zero();
  };

  /// Result of a scan of the table's nodes under even loads: initial values at the first slip angle that
  /// meets the demand.
  struct Scan {
    bool found = false, pulls = false;
    Unknowns start;
  };

  RutShare rutOf(int axle, double angle_rad) const noexcept;
  WheelRatios forces(const WheelMotion& motion, const RutShare& rut, double strength) const noexcept;
  Balance balance(const Ground& ground, const Unknowns& u) const noexcept;
  Scan scan(const Ground& ground) const noexcept;
  bool solve(const Ground& ground, Unknowns& u) const noexcept;
  SlopeFailure gripOf(const SlopeState& state, const Unknowns& u) const noexcept;
  void fill(const Ground& ground, const Unknowns& u, SlopeState& state) const noexcept;
  WheelMotion motionOf(int wheel, const Unknowns& u) const noexcept;
  bool isSteady(const Unknowns& u) const noexcept;
  RoverStance::Loads shares(const Planar& demand) const noexcept;
  double normal_N(const Gradient& gradient) const noexcept;

  WheelForcesTable fresh_, rut_;
  Rover rover_;
  bool ruts_ = true;  // false: later axles roll on fresh ground, too
  RoverStance stance_;
  std::array<double, WheelForcesTable::kAngles> even_in_rut_{};  // mean share of all wheels, by angle node
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

/// The wheels of an axle at the distance d behind the front axle roll beside its ruts by d sin(body angle).
SlopeEquilibrium::Solver::RutShare SlopeEquilibrium::Solver::rutOf(int axle,
                                                                   double angle_rad) const noexcept {
  if (axle == 0 || !ruts_) return {};
  if (rover_.steering == Steering::AllWheel) return {.value = 1.0};
  const double behind_m = stance_.position_m(0).x - stance_.position_m(2 * axle).x,
               widths = behind_m / rover_.wheel.width_m, off = widths * std::sin(angle_rad),
               share = std::exp(-2.0 * off * off);
  return {.value = share, .by_angle = -4.0 * off * widths * std::cos(angle_rad) * share};
}

/// Forces of a wheel partly in a rut, on ground with `strength` times the shear stresses of its class.
WheelRatios SlopeEquilibrium::Solver::forces(const WheelMotion& motion, const RutShare& rut,
                                             double strength) const noexcept {
  WheelRatios f = rut.value < 1.0 ? fresh_.at(motion) : rut_.at(motion);
  if (rut.value > 0.0 && rut.value < 1.0) {
    const WheelRatios in_rut = rut_.at(motion);
    for (std::size_t c = 0; c < kWheelChannels; ++c) {
      f.by_slip[c] += rut.value * (in_rut.by_slip[c] - f.by_slip[c]);
      f.by_angle[c] +=
          rut.value * (in_rut.by_angle[c] - f.by_angle[c]) + rut.by_angle * (in_rut.value[c] - f.value[c]);
      f.value[c] += rut.value * (in_rut.value[c] - f.value[c]);
    }
  }
  for (auto* part : {&f.value, &f.by_slip, &f.by_angle}) {
    (*part)[kPullRatio] += (strength - 1.0) * (*part)[kTorqueRatio];
    (*part)[kTorqueRatio] *= strength;
    (*part)[kSideRatio] *= strength;
  }
  return f;
}

SlopeEquilibrium::Solver::Balance SlopeEquilibrium::Solver::balance(const Ground& ground,
                                                                    const Unknowns& u) const noexcept {
  const Planar& demand = ground.demand;
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
    motion.load_N = share * ground.normal_N;
    const WheelRatios f = forces(motion, rutOf(k / 2, turn), ground.strength);
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
SlopeEquilibrium::Solver::Scan SlopeEquilibrium::Solver::scan(const Ground& ground) const noexcept {
  const Planar& demand = ground.demand;
  const double side = demand.y < 0.0 ? -1.0 : 1.0, wanted = std::abs(demand.y);
  constexpr int kRolling = (WheelForcesTable::kSlips - 1) / 2;
  Scan out;
  double last_side = 0.0, last_slip = 0.0;
  bool last = false;
  for (int a = 0; a < WheelForcesTable::kAngles; ++a) {
    const double beta = WheelForcesTable::angleOf(a);
    const double c = std::cos(beta), s = std::sin(beta);
    const double in_rut = even_in_rut_[static_cast<std::size_t>(a)];
    const auto node = [&](WheelChannel channel, int k) {
      const double fresh = fresh_.atNode(channel, k, a);
      return fresh + in_rut * (rut_.atNode(channel, k, a) - fresh);
    };
    const auto pull = [&](int k) {
      return node(kPullRatio, k) + (ground.strength - 1.0) * node(kTorqueRatio, k);
    };
    const auto hold_of = [&](int k) { return ground.strength * node(kSideRatio, k); };
    // Mirrored so that downhill is to the right and the lateral force acts to the left.
    const auto along = [&](int k) { return pull(k) * c + hold_of(k) * s; };
    const auto across = [&](int k) { return pull(k) * s - hold_of(k) * c; };
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
    if (a == 0) out.pulls = reached && slip <= kMostSlip;
    if (reached) {
      if (!out.found && hold >= wanted) {
        const double share = last && hold > last_side ? (wanted - last_side) / (hold - last_side) : 1.0;
        out.start.slip = last ? last_slip + share * (slip - last_slip) : slip;
        out.start.angle_rad =
            0.0 - side * (a == 0 ? 0.0 : beta - (1.0 - share) * WheelForcesTable::kAngleStep_rad);
        out.found = true;
      }
    }
    if (!out.found && last && !reached) {
      // The pull suffices up to an angle within this step.
      out.start.slip = 0.5 * (last_slip + kMostSlip);
      out.start.angle_rad = 0.0 - side * (beta - 0.5 * WheelForcesTable::kAngleStep_rad);
      out.found = true;
    }
    last = reached;
    last_side = hold;
    last_slip = slip;
  }
  return out;
}

/// Newton's method with steps limited to the table.
bool SlopeEquilibrium::Solver::solve(const Ground& ground, Unknowns& u) const noexcept {
  constexpr double kClose = 1e-10, kSteepest = 1.04;
  for (int iteration = 0; iteration < 15; ++iteration) {
    const Balance b = balance(ground, u);
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

void SlopeEquilibrium::Solver::fill(const Ground& ground, const Unknowns& u,
                                    SlopeState& state) const noexcept {
  const Planar& demand = ground.demand;
  const double normal = ground.normal_N;
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
    const WheelRatios f = forces(motion, rutOf(k / 2, turn), ground.strength);
    const double torque = f.value[kTorqueRatio] * motion.load_N * radius;
    if (std::abs(torque) > std::abs(state.torque_Nm)) state.torque_Nm = torque;
    // In a rut, too, a wheel sinks from the surface as far as its load requires on fresh ground (wong_2001).
    state.sinkage_m = std::max(state.sinkage_m, fresh_.at(motion).value[kSinkageRatio] * radius);
    state.side_force_over_load = std::max(state.side_force_over_load, std::abs(f.value[kSideRatio]));
    // r omega over travel speed.
    const double rim = std::cos(motion.slip_angle_rad) / std::max(travelRatio(motion.slip), 1e-9);
    fastest = std::max(fastest, rim);
    power_W_per_mps += torque * rim / radius;
  }
  state.speed_mps = rover_.max_speed_mps / std::max(fastest, 1.0);
  state.energy_J_per_m = std::max(power_W_per_mps, 0.0) + rover_.hotel_power_W / state.speed_mps;
}

double SlopeEquilibrium::Solver::leastStrength(const Gradient& gradient, double near) const noexcept {
  Ground ground{demandOf(gradient), normal_N(gradient), 0.0};
  const auto holds = [&](double strength) {
    ground.strength = strength;
    const Scan scanned = scan(ground);
    Unknowns u = scanned.start;
    return scanned.found && solve(ground, u) && isSteady(u);
  };
  double step = 0.02, low = std::clamp(near - step, 0.0, kMostStrength), high = low + 2.0 * step;
  for (; high < kMostStrength && !holds(high); step *= 2.0) {
    low = high;
    high = std::min(high + step, kMostStrength);
  }
  for (step = 0.04; low > 0.0 && holds(low); step *= 2.0) {
    high = low;
    low = std::max(low - step, 0.0);
  }
  while (high - low > kStrengthError) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

bool SlopeEquilibrium::Solver::isSteady(const Unknowns& u) const noexcept {
  const double difference = rover_.steering == Steering::Skid ? 0.5 * std::abs(u.difference) : 0.0;
  return u.slip + difference <= kMostSlip && std::abs(u.angle_rad) <= kMostSlipAngle_rad;
}

SlopeFailure SlopeEquilibrium::Solver::gripOf(const SlopeState& state, const Unknowns& u) const noexcept {
  if (state.sinkage_m > kSunk * rover_.wheel.radius_m || state.sinkage_m >= rover_.clearance_m)
    return SlopeFailure::Sinks;
  if (state.slip + 0.5 * std::abs(state.slip_difference) > kMostSlip) return SlopeFailure::CannotPull;
  if (std::abs(u.angle_rad) > kMostSlipAngle_rad) return SlopeFailure::Slides;
  if (std::abs(state.torque_Nm) > rover_.max_torque_Nm) return SlopeFailure::Torque;
  return SlopeFailure::None;
}

SlopeState SlopeEquilibrium::Solver::at(const Gradient& gradient, double strength) const noexcept {
  const Ground ground{demandOf(gradient), normal_N(gradient), strength};
  SlopeState state;
  const Scan scanned = scan(ground);
  Unknowns u = scanned.start;
  if (scanned.found && solve(ground, u)) {
    fill(ground, u, state);
    state.grip = gripOf(state, u);
  } else {
    const double rolling = fresh_.atNode(kSinkageRatio, (WheelForcesTable::kSlips - 1) / 2, 0);
    const bool sunk = rolling > kSunk || rolling * rover_.wheel.radius_m >= rover_.clearance_m;
    state.stability_margin_rad = stance_.stabilityMargin_rad(ground.demand);  // body angle unknown
    // If the rover has an equilibrium under even loads, the failure is that of the larger component of the
    // gradient.
    const bool lacks_pull = !scanned.pulls || (scanned.found && std::abs(gradient.across) <= gradient.along);
    state.grip = sunk                                 ? SlopeFailure::Sinks
                 : lacks_pull && gradient.along > 0.0 ? SlopeFailure::CannotPull
                                                      : SlopeFailure::Slides;
  }
  state.failure = state.stability_margin_rad < 0.0 ? SlopeFailure::Tips : state.grip;
  return state;
}

std::vector<WheelOnSlope> SlopeEquilibrium::Solver::wheels(const Gradient& gradient, const SlopeState& state,
                                                           double strength) const {
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
    const WheelRatios f = forces(motion, rutOf(k / 2, turn), strength);
    const double r = rover_.wheel.radius_m, load_N = motion.load_N;
    all.push_back({load_N, motion.slip, motion.slip_angle_rad, f.value[kSinkageRatio] * r,
                   f.value[kTorqueRatio] * load_N * r, f.value[kPullRatio] * load_N,
                   f.value[kSideRatio] * load_N});
  }
  return all;
}

SteadyWheel SlopeEquilibrium::Solver::evenWheel(WheelMotion motion, bool in_rut) const noexcept {
  const auto under = [&](double load_N) {
    motion.load_N = load_N;
    return forces(motion, {.value = in_rut ? 1.0 : 0.0}, 1.0).value;
  };
  const double even_N = wheelLoad_N(rover_);
  const auto f = under(even_N / std::hypot(1.0, under(even_N)[kPullRatio]));
  return {f[kPullRatio], f[kSinkageRatio], f[kTorqueRatio], std::abs(f[kSideRatio])};
}

SlopeEquilibrium::SlopeEquilibrium(const Soil& soil, const Rover& rover)
    : SlopeEquilibrium(onSoil(soil), rover) {}

SlopeEquilibrium::SlopeEquilibrium(const RefinedModel& model, const Rover& rover)
    : solver_(std::make_shared<const Solver>(WheelForcesTable(model, rover, 1),
                                             WheelForcesTable(rutted(model), rover, 2), rover)) {}

SlopeState SlopeEquilibrium::at(const Gradient& gradient, double strength) const noexcept {
  return solver_->at(gradient, strength);
}

double SlopeEquilibrium::leastStrength(const Gradient& gradient, double near) const noexcept {
  return solver_->leastStrength(gradient, near);
}

std::vector<WheelOnSlope> SlopeEquilibrium::wheels(const Gradient& gradient, const SlopeState& state,
                                                   double strength) const {
  return solver_->wheels(gradient, state, strength);
}

SteadyWheel SlopeEquilibrium::evenWheel(double slip, double slip_angle_rad, bool in_rut) const noexcept {
  return solver_->evenWheel({.slip = slip, .slip_angle_rad = slip_angle_rad}, in_rut);
}

SlopeEquilibrium::SlopeEquilibrium(std::shared_ptr<const Solver> solver) : solver_(std::move(solver)) {}

SlopeEquilibrium SlopeEquilibrium::withoutRuts() const {
  return SlopeEquilibrium(std::make_shared<const Solver>(solver_->withoutRuts()));
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
