#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::terramech {
namespace slope_equilibrium_test {

Rover fourWheels(Steering steering) {
  return {.name = "cart",
          .mass_kg = 100.0,
          .gravity_m_s2 = 2.0,
          .wheel_count = 4,
          .wheel = {.radius_m = 0.1, .width_m = 0.1},
          .wheelbase_m = 1.2,
          .track_m = 0.9,
          .clearance_m = 0.2,
          .max_torque_Nm = 10.0,
          .max_speed_mps = 0.5,
          .steering = steering};
}

TEST(Turning, SkidSteeringEnergyIsLateralFrictionWork) {
  const TurnEfforts efforts =
      turnEfforts(fourWheels(Steering::Skid), {.lateral_resistance = 0.5, .rolling_J_per_m = 40.0});
  // Closed form: 4 wheels of 50 N, each 0.6 m from the centre, at a lateral force over load of 0.5.
  EXPECT_DOUBLE_EQ(efforts.on_arc.energy_J, 0.5 * 4 * 50.0 * 0.6);
  // Closed form: in place, the rows at 0.45 m from the centre also roll in opposite directions.
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J, 60.0 + 40.0 * 0.45);
}

TEST(Turning, AllWheelSteeringRollsAboutTheCentre) {
  const TurnEfforts efforts = turnEfforts(fourWheels(Steering::AllWheel), {.rolling_J_per_m = 40.0});
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J,
                   30.0);  // Closed form: half the diagonal of 1.2 by 0.9 m is 0.75 m.
  EXPECT_DOUBLE_EQ(efforts.on_arc.energy_J, 0.0);
  // Closed form: the two middle wheels of six roll half the track.
  Rover six = fourWheels(Steering::AllWheel);
  six.wheel_count = 6;
  EXPECT_DOUBLE_EQ(turnEfforts(six, {.rolling_J_per_m = 40.0}).in_place.energy_J,
                   40.0 * (2.0 * 0.75 + 0.45) / 3.0);
}

TEST(Turning, TurnTimeIsLimitedByTheFastestWheel) {
  auto rover = fourWheels(Steering::AllWheel);
  rover.hotel_power_W = 10.0;
  const TurnEfforts efforts = turnEfforts(rover, {});
  // Closed form: on an arc the outer row rolls 0.45 m more per radian at 0.5 m/s; in place every wheel rolls
  // 0.75 m.
  EXPECT_DOUBLE_EQ(efforts.on_arc.time_s, 0.9);
  EXPECT_DOUBLE_EQ(efforts.in_place.time_s, 1.5);
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J, 15.0);
}

TEST(Turning, BulldozingForceMatchesPassiveEarthPressure) {
  const auto rover = fourWheels(Steering::Skid);
  Soil sand;
  sand.friction_angle_rad = std::numbers::pi / 6;  // K_p = tan^2(60 deg) = 3
  sand.density_kg_m3 = 1500.0;
  // Closed form: z = 2 cm of a wheel of 10 cm: chord 2 sqrt(0.004 - 0.0004) = 0.12 m.
  EXPECT_NEAR(bulldozing_N(sand, rover, 0.02), 0.5 * 1500.0 * 2.0 * 0.0004 * 3.0 * 0.12, 1e-12);
  sand.cohesion_Pa = 1000.0;
  EXPECT_NEAR(bulldozing_N(sand, rover, 0.02), 0.216 + 2.0 * 1000.0 * 0.02 * std::sqrt(3.0) * 0.12, 1e-9);
  EXPECT_DOUBLE_EQ(bulldozing_N(sand, rover, 0.0), 0.0);
  // Property: the energy of turning increases with the bulldozing force.
  EXPECT_GT(turnEfforts(rover, {.bulldozing_N = 5.0}).on_arc.energy_J,
            turnEfforts(rover, {}).on_arc.energy_J);
}

Rover rover(int wheels = 4) {
  return {.name = "box",
          .mass_kg = 40.0,
          .wheel_count = wheels,
          .wheel = {},
          .wheelbase_m = 0.8,
          .track_m = 0.6,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 20.0};
}

TEST(RoverStance, PitchAndRollTransferLoad) {
  const RoverStance stance{rover()};
  const auto n = stance.shares({0.2, 0.1});
  // Closed form: load transfer h/L tan(pitch) and h/T tan(roll), half at each wheel.
  const double back = 0.3 / 0.8 * 0.2 / 2.0, right = 0.3 / 0.6 * 0.1 / 2.0;
  EXPECT_NEAR(n[0], 0.25 - back - right, 1e-12);  // front left, uphill in both directions
  EXPECT_NEAR(n[1], 0.25 - back + right, 1e-12);
  EXPECT_NEAR(n[2], 0.25 + back - right, 1e-12);
  EXPECT_NEAR(n[3], 0.25 + back + right, 1e-12);
}

TEST(RoverStance, ForcesAndMomentsBalance) {
  for (const int wheels : {4, 6, 8}) {
    Rover r = rover(wheels);
    r.centre_of_mass_ahead_m = 0.1;
    r.centre_of_mass_left_m = -0.05;
    const RoverStance stance{r};
    for (const Planar demand : {Planar{0.0, 0.0}, Planar{0.3, -0.2}, Planar{-0.5, 0.4}, Planar{0.7, 0.5}}) {
      const auto n = stance.shares(demand);
      double sum = 0.0, x = 0.0, y = 0.0;
      for (int k = 0; k < wheels; ++k) {
        const double share = n[static_cast<std::size_t>(k)];
        EXPECT_GE(share, 0.0);
        sum += share;
        x += share * stance.position_m(k).x;
        y += share * stance.position_m(k).y;
      }
      // Closed form: the resultant of the normal forces meets the line of the weight in the plane, with or
      // without lifted wheels.
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(x, 0.1 - 0.3 * demand.x, 1e-9) << wheels << ' ' << demand.x;
      EXPECT_NEAR(y, -0.05 - 0.3 * demand.y, 1e-9) << wheels << ' ' << demand.y;
    }
  }
}

TEST(RoverStance, StabilityMarginIsZeroAtTheTippingSlope) {
  const RoverStance stance{rover()};
  // Closed form: half the base over the height, half the track over the height.
  EXPECT_NEAR(stance.stabilityMargin_rad({0.4 / 0.3, 0.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, 1.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, -0.5}), std::atan(1.0) - std::atan(0.5), 1e-12);
  EXPECT_LT(stance.stabilityMargin_rad({0.0, 1.1}), 0.0);
}

TEST(RoverStance, WithoutCentreOfMassHeightLoadsAreEqualAndMarginIsNan) {
  Rover r = rover();
  r.centre_of_mass_height_m = 0.0;
  const RoverStance stance{r};
  EXPECT_EQ(stance.shares({0.4, 0.3})[0], 0.25);  // Closed form
  EXPECT_TRUE(std::isnan(stance.stabilityMargin_rad({0.1, 0.0})));
}

std::string refusal(const Rover& r) {
  try {
    const RoverStance stance{r};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(RoverStance, InvalidGeometryIsRejected) {
  Rover r = rover();
  r.centre_of_mass_ahead_m = 0.5;
  EXPECT_NE(refusal(r).find("rover 'box': centre_of_mass_ahead_m = 0.5"), std::string::npos) << refusal(r);
  r = rover();
  r.track_m = 0.0;
  EXPECT_NE(refusal(r).find("track_m = 0, must be > 0"), std::string::npos) << refusal(r);
  EXPECT_NE(refusal(rover(1)).find("wheels.count = 1"), std::string::npos);
  EXPECT_NE(refusal(rover(3)).find("must be even, 4 to 12"), std::string::npos) << refusal(rover(3));
}

Soil loam() {
  return {.name = "loam",
          .cohesion_Pa = 3000.0,
          .friction_angle_rad = 0.44,
          .sinkage_exponent = 0.8,
          .frictional_modulus = 1.7e6,
          .shear_modulus_m = 0.02};
}

Rover sixWheels() {
  return {.name = "six wheels",
          .mass_kg = 60.0,
          .gravity_m_s2 = 3.71,
          .wheel_count = 6,
          .wheel = {.radius_m = 0.1, .width_m = 0.1},
          .wheelbase_m = 0.8,
          .track_m = 0.7,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 12.0,
          .max_speed_mps = 0.06,
          .hotel_power_W = 8.0};
}

RefinedModel withEffect(const char* name, std::vector<double> parameters) {
  RefinedModel model;
  model.soil = loam();
  const EffectForm& form = *findEffect(name);
  model.effects = {{.name = name,
                    .covariate = form.covariate,
                    .channel = form.channel,
                    .parameters = std::move(parameters)}};
  return model;
}

TEST(Mobility, ReferenceIsTheWheelAtReferenceSlipUnderItsLoad) {
  const double load_N = wheelLoad_N(sixWheels());
  const WheelForces wheel = equilibrium(loam(), sixWheels().wheel, {.load_N = load_N, .slip = 0.5});
  const SteadyWheel of = mobilityReference(onSoil(loam()), sixWheels());
  EXPECT_DOUBLE_EQ(of.drawbar_pull_over_load, wheel.drawbar_pull_N / load_N);  // Closed form.
  EXPECT_DOUBLE_EQ(of.sinkage_over_radius, wheel.sinkage_m / 0.1);
  EXPECT_DOUBLE_EQ(of.torque_over_load_radius, wheel.torque_Nm / (load_N * 0.1));
}

TEST(Mobility, SinkageIncreasesWithGravityAndWithSlipSinkage) {
  Rover heavy = sixWheels();
  heavy.gravity_m_s2 *= 2.0;
  const double plain = mobilityReference(onSoil(loam()), sixWheels()).sinkage_over_radius;
  EXPECT_LT(plain, mobilityReference(onSoil(loam()), heavy).sinkage_over_radius);
  EXPECT_LT(plain,
            mobilityReference(withEffect("slip_sinkage_ding", {0.4}), sixWheels()).sinkage_over_radius);
}

TEST(Mobility, SoilWithoutBearingCapacityCarriesTheWheelOnItsAxle) {
  Soil bog = loam();
  bog.frictional_modulus = 1e3;
  EXPECT_NEAR(mobilityReference(onSoil(bog), sixWheels()).sinkage_over_radius, 1.0, 1e-9);
}

TEST(Mobility, SensorEffectsDoNotChangeMobility) {
  for (const char* name : {"load_cell_tilt", "torque_offset", "sinkage_datum", "slip_bias"}) {
    EXPECT_EQ(mobilityReference(withEffect(name, {0.05}), sixWheels()).drawbar_pull_over_load,
              mobilityReference(onSoil(loam()), sixWheels()).drawbar_pull_over_load)
        << name;
  }
}

TEST(Mobility, InvalidArgumentsAreRejected) {
  Rover bad = sixWheels();
  bad.mass_kg = -1.0;
  EXPECT_REFUSED(mobilityReference(onSoil(loam()), bad), std::invalid_argument, "mass_kg = -1, must be > 0");
  EXPECT_THROW(mobilityReference(onSoil(loam()), sixWheels(), 0), std::invalid_argument);
  RefinedModel model;
  model.soil = loam();
  model.base = BaseModel::LinearFormula;
  EXPECT_REFUSED(mobilityReference(model, sixWheels()), std::invalid_argument,
                 "cannot predict slip on a slope; trace the data with model: wong-reece");
}

Soil coarseSand() {
  return {.name = "sand",
          .cohesion_Pa = 600.0,
          .friction_angle_rad = 0.55,
          .sinkage_exponent = 1.0,
          .frictional_modulus = 1.5e6,
          .shear_modulus_m = 0.015};
}

Rover boxRover(Steering steering = Steering::AllWheel) {
  Rover box = rover();
  box.wheel = {.radius_m = 0.12, .width_m = 0.1};
  box.track_m = 0.7;
  box.max_torque_Nm = 40.0;
  box.hotel_power_W = 10.0;
  box.steering = steering;
  return box;
}

constexpr Steering kSteerings[] = {Steering::Skid, Steering::Ackermann, Steering::AllWheel};

/// Net force [N] and moment [Nm] on a rover in three dimensions, in the map's axes, with each wheel solved
/// separately.
struct Net {
  double along, across, normal, yaw, pitch, roll;
};

struct Vec {
  double x, y, z;
};
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec operator*(double s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec unit(Vec a) {
  return (1.0 / std::sqrt(dot(a, a))) * a;
}

Net netOf(const Soil& soil, const Rover& r, const Gradient& g, const SlopeState& state,
          const std::vector<WheelOnSlope>& wheels) {
  const Vec ahead = unit({1.0, 0.0, g.along}), up = unit({-g.along, -g.across, 1.0}), left = cross(up, ahead);
  const auto inPlane = [&](double angle) { return std::cos(angle) * ahead + std::sin(angle) * left; };
  const Vec body = inPlane(state.body_turn_rad),
            body_left = inPlane(state.body_turn_rad + 0.5 * std::numbers::pi);
  const Vec weight{0.0, 0.0, -r.mass_kg * r.gravity_m_s2};
  Vec force = weight, moment{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const WheelOnSlope& w = wheels[k];
    const WheelForces f = equilibrium(soil, r.wheel,
                                      {.load_N = w.load_N,
                                       .slip = w.slip,
                                       .slip_angle_rad = w.slip_angle_rad,
                                       .gravity_m_s2 = r.gravity_m_s2});
    const Vec on = inPlane(-w.slip_angle_rad), across = inPlane(-w.slip_angle_rad + 0.5 * std::numbers::pi);
    const Vec here = f.drawbar_pull_N * on + f.side_force_N * across + w.load_N * up;
    const double x = (k / 2 == 0 ? 0.5 : -0.5) * r.wheelbase_m, y = (k % 2 == 0 ? 0.5 : -0.5) * r.track_m;
    const Vec arm = (x - r.centre_of_mass_ahead_m) * body + (y - r.centre_of_mass_left_m) * body_left +
                    (-r.centre_of_mass_height_m) * up;
    force = force + here;
    moment = moment + cross(arm, here);
  }
  return {dot(force, ahead), dot(force, left),       dot(force, up),
          dot(moment, up),   dot(moment, body_left), dot(moment, body)};
}

TEST(SlopeEquilibrium, WheelForcesBalanceTheWeight) {
  for (const Steering steering : kSteerings) {
    Rover r = boxRover(steering);
    r.centre_of_mass_ahead_m = 0.06;
    const auto equilibrium = SlopeEquilibrium{coarseSand(), r}.withoutRuts();
    const double weight = r.mass_kg * r.gravity_m_s2;
    int held = 0;
    for (double a = -0.35; a <= 0.36; a += 0.07)
      for (double c = -0.35; c <= 0.36; c += 0.07) {
        const SlopeState state = equilibrium.at({a, c});
        if (!state.holds()) continue;
        ++held;
        const Net net = netOf(coarseSand(), r, {a, c}, state, equilibrium.wheels({a, c}, state));
        // Property: forces and moments in three dimensions are balanced; tolerance 0.005 of the weight for
        // the table of wheel forces.
        EXPECT_NEAR(net.along / weight, 0.0, 0.005) << a << ' ' << c;
        EXPECT_NEAR(net.across / weight, 0.0, 0.005) << a << ' ' << c;
        EXPECT_NEAR(net.normal / weight, 0.0, 1e-9);
        EXPECT_NEAR(net.yaw / (weight * r.wheelbase_m), 0.0, 0.004) << a << ' ' << c;
        // The wheel loads balance the moments of the wheel forces about the centre of mass.
        EXPECT_NEAR(net.pitch / (weight * r.wheelbase_m), 0.0, 0.004);
        EXPECT_NEAR(net.roll / (weight * r.track_m), 0.0, 0.004);
      }
    EXPECT_GT(held, 30);
  }
}

// Slip on one slope by bisection.
double slipOnSlope(const Soil& soil, const Rover& rover, double slope_rad) {
  const double load_N = wheelLoad_N(rover) * std::cos(slope_rad);
  const auto excess = [&](double slip) {
    return equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip}).drawbar_pull_N / load_N -
           std::tan(slope_rad);
  };
  double low = excess(0.0) > 0.0 ? -1.0 : 0.0, high = low < 0.0 ? 0.0 : 0.01;
  while (excess(high) < 0.0) {
    low = high;
    high = std::min(1.0, high + 0.01);
  }
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(SlopeEquilibrium, StraightUpSlopeBalancesOneWheel) {
  Rover r = boxRover();
  r.centre_of_mass_height_m = 0.0;  // without load transfer
  const SlopeEquilibrium rutted{coarseSand(), r}, fresh = rutted.withoutRuts();
  for (double slope = -0.2; slope <= 0.11; slope += 0.05) {
    const SlopeState state = fresh.at({std::tan(slope), 0.0});
    ASSERT_TRUE(state.holds()) << slope;
    // Closed form: the slip of a wheel by bisection. Tolerance: table errors up to 0.004 in pull over load, times
    // the derivative of slip by pull over load.
    EXPECT_NEAR(state.slip, slipOnSlope(coarseSand(), r, slope), 0.006) << slope;
    EXPECT_NEAR(state.slip_angle_rad, 0.0, 1e-9);
    // Property: later axles in ruts reduce the slip uphill.
    if (slope > 0.01) {
      EXPECT_LT(rutted.at({std::tan(slope), 0.0}).slip, state.slip) << slope;
    }
  }
}

// Property: the least strength holds, and a little less does not; at strength s the pull of a wheel is that of its
// class plus s - 1 times its torque over the radius.
TEST(SlopeEquilibrium, LeastStrengthIsTheEdgeOfWhatHolds) {
  for (const Steering steering : kSteerings) {
    const SlopeEquilibrium equilibrium{coarseSand(), boxRover(steering)};
    for (const Gradient plane : {Gradient{0.15, 0.0}, Gradient{0.05, 0.12}, Gradient{-0.15, 0.05}}) {
      const double least = equilibrium.leastStrength(plane);
      const SlopeState edge = equilibrium.at(plane, least + 1e-4);
      EXPECT_LE(edge.slip, 0.8 + 1e-6);
      EXPECT_GT(edge.speed_mps, 0.0);
      const SlopeState below = equilibrium.at(plane, least - 0.01);
      EXPECT_TRUE(below.speed_mps == 0.0 || below.grip != SlopeFailure::None)
          << plane.along << ' ' << plane.across;
      EXPECT_NEAR(equilibrium.leastStrength(plane, 2.0), least, 1e-3);
    }
  }
  const SlopeEquilibrium straight{coarseSand(), boxRover()};
  const Gradient climb{0.1, 0.0};
  const SlopeState state = straight.at(climb, 1.2);
  double pull_N = 0.0, load_N = 0.0;
  for (const WheelOnSlope& wheel : straight.wheels(climb, state, 1.2)) {
    pull_N += wheel.drawbar_pull_N;
    load_N += wheel.load_N;
  }
  EXPECT_NEAR(pull_N / load_N, 0.1, 1e-6);
}

TEST(SlopeEquilibrium, IsSymmetricLeftAndRight) {
  for (const Steering steering : kSteerings) {
    const SlopeEquilibrium equilibrium{coarseSand(), boxRover(steering)};
    for (const double a : {-0.2, 0.0, 0.15})
      for (const double c : {0.05, 0.2, 0.3}) {
        const SlopeState left = equilibrium.at({a, c}), right = equilibrium.at({a, -c});
        // Property: a plane and its mirror image have mirrored equilibria; tolerance: rounding of the Newton
        // steps.
        EXPECT_EQ(left.failure, right.failure);
        EXPECT_NEAR(left.slip, right.slip, 1e-8);
        EXPECT_NEAR(left.slip_angle_rad, -right.slip_angle_rad, 1e-8);
        EXPECT_NEAR(left.body_turn_rad, -right.body_turn_rad, 1e-8);
        EXPECT_NEAR(left.energy_J_per_m, right.energy_J_per_m, 1e-6 * left.energy_J_per_m + 1e-9);
      }
  }
}

TEST(SlopeEquilibrium, SlipAngleAndEnergyIncreaseWithCrossSlope) {
  for (const Steering steering : kSteerings) {
    const SlopeEquilibrium equilibrium{coarseSand(), boxRover(steering)};
    double last = -1.0, energy = 0.0;
    for (double c = 0.0; c < 0.6; c += 0.02) {
      const SlopeState state = equilibrium.at({0.0, c});
      if (!state.holds()) break;
      // Property: the slip angle grows with the cross slope, and so does the energy.
      EXPECT_GT(-state.slip_angle_rad, last) << c;
      EXPECT_GE(state.energy_J_per_m, energy * (1.0 - 1e-3)) << c;
      last = -state.slip_angle_rad;
      energy = state.energy_J_per_m;
    }
    EXPECT_GT(last, 0.1);
  }
}

TEST(SlopeEquilibrium, BodyYawsUphillUnlessAllWheelsSteer) {
  const Gradient across{0.0, 0.2};  // rises to the left
  EXPECT_EQ(SlopeEquilibrium(coarseSand(), boxRover(Steering::AllWheel)).at(across).body_turn_rad, 0.0);
  EXPECT_GT(SlopeEquilibrium(coarseSand(), boxRover(Steering::Skid)).at(across).body_turn_rad, 0.02);
  EXPECT_GT(SlopeEquilibrium(coarseSand(), boxRover(Steering::Ackermann)).at(across).body_turn_rad, 0.02);
}

/// True if an equilibrium without load transfer exists, by brute force: some slip and slip angle within the
/// limits give the required force along and at least the required force across, with equal wheels under equal
/// loads.
bool anyHolds(const Soil& soil, const Rover& r, const Gradient& g) {
  const double steep = std::sqrt(1.0 + g.along * g.along + g.across * g.across);
  const double load = wheelLoad_N(r) / steep;
  const double run = std::sqrt(1.0 + g.along * g.along);
  const double along = g.along * steep / run, across = g.across / run;
  for (double angle = 0.0; angle <= 0.7854; angle += 0.02) {
    double last_x = 0.0, last_y = 0.0;
    bool first = true;
    for (double slip = -1.0; slip <= 0.8001; slip += 0.02) {
      const WheelForces f = equilibrium(soil, r.wheel,
                                        {.load_N = load,
                                         .slip = std::min(slip, 0.8),
                                         .slip_angle_rad = -angle,
                                         .gravity_m_s2 = r.gravity_m_s2});
      const double c = std::cos(angle), s = std::sin(angle);
      const double x = (f.drawbar_pull_N * c - f.side_force_N * s) / load;
      const double y = (f.side_force_N * c + f.drawbar_pull_N * s) / load;
      if (!first && (last_x - along) * (x - along) <= 0.0 && std::max(y, last_y) >= across) return true;
      last_x = x;
      last_y = y;
      first = false;
    }
  }
  return false;
}

TEST(SlopeEquilibrium, FindsAnEquilibriumWheneverOneExists) {
  Rover r = boxRover();
  r.centre_of_mass_height_m = 0.0;
  const auto equilibrium = SlopeEquilibrium{coarseSand(), r}.withoutRuts();
  std::mt19937_64 engine{3};
  std::uniform_real_distribution<double> any{-0.7, 0.7};
  int held = 0, none = 0;
  for (int k = 0; k < 40; ++k) {
    const Gradient g{any(engine), std::abs(any(engine))};
    const bool want = anyHolds(coarseSand(), r, g);
    // Property: existence agrees with brute force; where the two differ, the limit lies within 0.02 of
    // gradient.
    if (equilibrium.at(g).holds() != want) {
      const auto holds = [&](double a, double c) {
        return equilibrium.at({g.along + a, g.across + c}).holds();
      };
      const bool edge = holds(0.0, -0.02) != holds(0.0, 0.02) || holds(-0.02, 0.0) != holds(0.02, 0.0);
      EXPECT_TRUE(edge) << g.along << ' ' << g.across << ' ' << want;
    }
    ++(want ? held : none);
  }
  EXPECT_GT(held, 8);
  EXPECT_GT(none, 8);
}

TEST(SlopeEquilibrium, ReportsTheCauseOfFailure) {
  const SlopeEquilibrium equilibrium{coarseSand(), boxRover()};
  EXPECT_EQ(equilibrium.at({0.7, 0.0}).failure, SlopeFailure::CannotPull);
  EXPECT_EQ(equilibrium.at({0.0, 0.9}).failure, SlopeFailure::Slides);
  EXPECT_EQ(equilibrium.at({-1.2, 0.0}).failure, SlopeFailure::Slides);
  EXPECT_EQ(equilibrium.at({0.0, 1.3}).failure, SlopeFailure::Tips);
  Rover weak = boxRover();
  weak.max_torque_Nm = 0.5;
  EXPECT_EQ(SlopeEquilibrium(coarseSand(), weak).at({0.05, 0.0}).failure, SlopeFailure::Torque);
  Rover low = boxRover();
  low.clearance_m = 0.9 * SlopeEquilibrium(coarseSand(), boxRover()).at({}).sinkage_m;
  EXPECT_EQ(SlopeEquilibrium(coarseSand(), low).at({}).failure, SlopeFailure::Sinks);
  // Straight uphill, load transfer makes the pull insufficient that is sufficient under equal loads; the
  // failure is not sliding.
  Rover tall = boxRover();
  tall.centre_of_mass_height_m = 0.5 * tall.wheelbase_m / 0.3;
  for (double along = 0.05; along < 0.5; along += 0.01) {
    const SlopeState state = SlopeEquilibrium(coarseSand(), tall).at({along, 0.0});
    EXPECT_NE(state.grip, SlopeFailure::Slides) << along;
  }
  Soil bog = coarseSand();
  bog.frictional_modulus = 2e3;
  EXPECT_EQ(SlopeEquilibrium(bog, boxRover()).at({0.0, 0.0}).failure, SlopeFailure::Sinks);
}

TEST(SlopeEquilibrium, LockedRoverIsStableDownhillUpToTheSlidingSlope) {
  const auto equilibrium = SlopeEquilibrium{coarseSand(), boxRover()}.withoutRuts();
  const double even = wheelLoad_N(boxRover());
  const WheelForces locked =
      terramech::equilibrium(coarseSand(), boxRover().wheel, {.load_N = even, .slip = -1.0});
  const double steepest = -locked.drawbar_pull_N / even;
  // Closed form: locked wheels hold tan(slope) = -DP/N; tolerance 0.03 for load transfer and the cosine.
  EXPECT_TRUE(equilibrium.at({-(steepest - 0.04), 0.0}).holds());
  EXPECT_FALSE(equilibrium.at({-(steepest + 0.06), 0.0}).holds());
}

// Closed form: the point where the line of the weight meets the plane, in the body's axes, against the
// rectangle of the wheels. The rover is short, wide and tall, and turns uphill on cross slopes.
TEST(SlopeEquilibrium, IsStableOnlyWithCentreOfMassWithinTheWheelBase) {
  int tipped = 0, turned = 0;  // cases that tip only because the body turns
  for (const auto& [steering, cohesion_Pa] : {std::pair{Steering::Skid, 4000.0},
                                              {Steering::Ackermann, 4000.0},
                                              {Steering::AllWheel, 4000.0},
                                              {Steering::Skid, 600.0},
                                              {Steering::Ackermann, 600.0}}) {
    Soil soil = coarseSand();
    soil.cohesion_Pa = cohesion_Pa;
    Rover r = boxRover(steering);
    r.wheelbase_m = 0.5;
    r.track_m = 1.5;
    r.centre_of_mass_height_m = 2.0;
    const SlopeEquilibrium equilibrium{soil, r};
    int held = 0;
    for (double a = -0.5; a <= 0.51; a += 0.02)
      for (double c = -0.5; c <= 0.51; c += 0.02) {
        const SlopeState state = equilibrium.at({a, c});
        const Vec ahead = unit({1.0, 0.0, a}), up = unit({-a, -c, 1.0}), left = cross(up, ahead);
        const double turn = state.body_turn_rad;
        const Vec body = std::cos(turn) * ahead + std::sin(turn) * left, side = cross(up, body);
        // From the centre of mass vertically down to the plane: h / up.z metres.
        const Vec down{0.0, 0.0, -r.centre_of_mass_height_m / up.z};
        const auto beyond = [&](const Vec& x, const Vec& y) {
          return std::max(std::abs(dot(down, x)) - 0.25, std::abs(dot(down, y)) - 0.75);
        };
        const double off = beyond(body, side);
        if (state.holds()) {
          ++held;
          EXPECT_LT(off, 1e-9) << name(state.failure) << ' ' << a << ' ' << c;
        }
        if (state.grip == SlopeFailure::None && off > 1e-9) {
          ++tipped;
          turned += beyond(ahead, left) < -0.005 ? 1 : 0;
          EXPECT_EQ(state.failure, SlopeFailure::Tips) << a << ' ' << c;
        }
      }
    EXPECT_GT(held, 30);
  }
  EXPECT_GT(tipped, 20);
  EXPECT_GT(turned, 5);
}

TEST(SlopeEquilibrium, ListsItsAssumptions) {
  EXPECT_TRUE(slopeAssumptions(boxRover()).empty());
  Rover r = boxRover();
  r.centre_of_mass_height_m = 0.0;
  ASSERT_EQ(slopeAssumptions(r).size(), 1u);
  EXPECT_NE(slopeAssumptions(r)[0].find("rover 'box': centre_of_mass_height_m is not given"),
            std::string::npos);
}

TEST(Rut, SecondPassSinksLessAndPullsMore) {
  const Soil sand{.name = "sand",
                  .cohesion_Pa = 800.0,
                  .friction_angle_rad = 0.63,
                  .sinkage_exponent = 1.0,
                  .cohesive_modulus = 1400.0,
                  .frictional_modulus = 820000.0,
                  .shear_modulus_m = 0.015};
  const Wheel wheel{.radius_m = 0.12, .width_m = 0.12};
  for (const double slip : {0.1, 0.3, 0.6}) {
    const WheelForces first = equilibrium(sand, wheel, {.load_N = 56.0, .slip = slip});
    const WheelForces second = equilibrium(rutted(sand), wheel, {.load_N = 56.0, .slip = slip});
    // Property: the sinkage is reduced by the factor 4^(2/(2n + 1)), and the resistance in proportion to the
    // root of the sinkage.
    EXPECT_NEAR(second.sinkage_m / first.sinkage_m, 0.397, 0.03) << slip;
    EXPECT_GT(second.drawbar_pull_N, first.drawbar_pull_N) << slip;
  }
}

Rover deepRover() {
  Rover rover = boxRover();
  rover.gravity_m_s2 = 3.71;
  return rover;
}

Soil soil(int kind) {
  Soil s{.name = "soil",
         .cohesion_Pa = 200.0,
         .friction_angle_rad = 0.55,
         .sinkage_exponent = 1.0,
         .frictional_modulus = 8e5,
         .shear_modulus_m = 0.018};
  if (kind == 1) s.cohesion_Pa = 7000.0, s.friction_angle_rad = 0.44, s.sinkage_exponent = 0.7;
  if (kind == 2) s.shear_modulus_m = 0.01;
  return s;
}

TEST(WheelForcesTable, MatchesTheWheel) {
  std::mt19937_64 engine{4};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine);
  };
  for (const int kind : {0, 1, 2}) {
    const WheelForcesTable table{onSoil(soil(kind)), deepRover()};
    std::vector<double> errors;
    for (int k = 0; k < 400; ++k) {
      const WheelMotion m{wheelLoad_N(deepRover()) * between(0.3, 4.0), between(-0.95, 0.9),
                          between(-0.8, 0.8)};
      const WheelForces f = equilibrium(soil(kind), deepRover().wheel,
                                        {.load_N = m.load_N,
                                         .slip = m.slip,
                                         .slip_angle_rad = m.slip_angle_rad,
                                         .gravity_m_s2 = deepRover().gravity_m_s2});
      const WheelRatios t = table.at(m);
      const double r = deepRover().wheel.radius_m;
      errors.push_back(std::max({std::abs(t.value[kPullRatio] - f.drawbar_pull_N / m.load_N),
                                 std::abs(t.value[kSideRatio] - f.side_force_N / m.load_N),
                                 std::abs(t.value[kTorqueRatio] - f.torque_Nm / (m.load_N * r)),
                                 std::abs(t.value[kSinkageRatio] - f.sinkage_m / r)}));
    }
    std::sort(errors.begin(), errors.end());
    // Property: the errors are within those stated in the header.
    EXPECT_LT(errors.back(), 0.015) << kind;
    EXPECT_LT(errors[errors.size() / 2], 0.001) << kind;
  }
}

TEST(WheelForcesTable, DerivativesMatchFiniteDifferences) {
  const WheelForcesTable table{onSoil(soil(0)), deepRover()};
  const double h = 1e-6;
  for (const double slip : {-0.72, -0.01, 0.33, 0.81})
    for (const double angle : {-0.4, -0.02, 0.0, 0.3}) {
      const WheelRatios at = table.at({30.0, slip, angle});
      const WheelRatios more = table.at({30.0, slip + h, angle}), left = table.at({30.0, slip, angle + h});
      for (std::size_t c = 0; c < kWheelChannels; ++c) {
        // Property: the derivatives equal finite differences of the same cubic.
        EXPECT_NEAR(at.by_slip[c], (more.value[c] - at.value[c]) / h, 1e-4);
        EXPECT_NEAR(at.by_angle[c], (left.value[c] - at.value[c]) / h, 1e-4);
      }
    }
}

TEST(WheelForcesTable, EffectWithoutInfluenceEqualsTheSoil) {
  RefinedModel model = withEffect("slip_sinkage_ding", {0.0});
  model.soil = soil(0);
  const WheelForcesTable a{onSoil(soil(0)), deepRover()}, b{model, deepRover()};
  for (const double slip : {-0.5, 0.2})
    for (const double angle : {0.0, 0.3})
      for (std::size_t c = 0; c < kWheelChannels; ++c)
        // Property: two solvers of one wheel agree; 1e-5 for the faster rule of effects.
        EXPECT_NEAR(a.at({30.0, slip, angle}).value[c], b.at({30.0, slip, angle}).value[c], 1e-4);
}

}  // namespace slope_equilibrium_test
}  // namespace talus::terramech
