#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {
namespace rover_test {

TEST(Wheel, SizesMustBePositiveAndGrousersAreOptional) {
  EXPECT_NO_THROW(validate(Wheel{}));
  EXPECT_NO_THROW(validate({.radius_m = 0.2, .width_m = 0.1, .grouser_height_m = 0.01, .grouser_count = 24}));
  for (const double bad : {0.0, -0.1, 1e-12, 1e14, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(validate({.radius_m = bad}), std::invalid_argument) << bad;
    EXPECT_THROW(validate({.width_m = bad}), std::invalid_argument) << bad;
  }
  EXPECT_THROW(validate({.grouser_height_m = -0.001}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_height_m = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_count = -1}), std::invalid_argument);
}

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

Soil sand() {
  return {.name = "sand", .friction_angle_rad = 0.55, .cohesive_modulus = 950.0, .frictional_modulus = 1.5e6};
}

TEST(Soil, SinkageModulusIsKcOverWidthPlusKphi) {
  // Closed form: Eq. A.1.
  EXPECT_DOUBLE_EQ(sinkageModulus(sand(), 0.1), 950.0 / 0.1 + 1.5e6);
}

TEST(Soil, ErrorNamesSoilFieldValueAndBound) {
  Soil soil = sand();
  soil.cohesion_Pa = -1.0;
  EXPECT_THAT([&] { validate(soil); },
              Throws<std::invalid_argument>(
                  Property(&std::exception::what, HasSubstr("soil 'sand': cohesion_Pa = -1, must be >= 0"))));
}

// Property: physically implausible magnitudes are rejected, even if the formulas accept them.
TEST(Soil, ImplausibleMagnitudesAreRejected) {
  for (const auto& [field, value, text] :
       {std::tuple{&Soil::cohesion_Pa, 1e15, "cohesion_Pa = 1e+15, must be in [0, 1e+09]"},
        {&Soil::shear_modulus_m, 1e-15, "shear_modulus_m = 1e-15, must be in [1e-09, 1000]"},
        {&Soil::shear_modulus_m, 1e15, "shear_modulus_m = 1e+15, must be in [1e-09, 1000]"},
        {&Soil::sinkage_exponent, 1e-15, "sinkage_exponent = 1e-15, must be in [0.001, 100]"},
        {&Soil::density_kg_m3, 1e-15, "density_kg_m3 = 1e-15, must be in [0.1, 1e+06]"},
        {&Soil::density_kg_m3, 1e15, "density_kg_m3 = 1e+15, must be in [0.1, 1e+06]"}}) {
    Soil soil = sand();
    soil.*field = value;
    EXPECT_REFUSED(validate(soil), std::invalid_argument, text);
  }
}

TEST(Soil, NanIsRejectedInEveryField) {
  for (const auto& [name, field] : {std::pair{"cohesion_Pa", &Soil::cohesion_Pa},
                                    {"friction_angle_rad", &Soil::friction_angle_rad},
                                    {"sinkage_exponent", &Soil::sinkage_exponent},
                                    {"cohesive_modulus", &Soil::cohesive_modulus},
                                    {"frictional_modulus", &Soil::frictional_modulus},
                                    {"shear_modulus_m", &Soil::shear_modulus_m},
                                    {"c1", &Soil::c1},
                                    {"c2", &Soil::c2},
                                    {"density_kg_m3", &Soil::density_kg_m3}}) {
    Soil soil = sand();
    soil.*field = std::nan("");
    EXPECT_REFUSED(validate(soil), std::invalid_argument, name + std::string(" = nan, must be finite"));
  }
}

using testing::ThrowsMessage;

Rover rover() {
  return {.name = "A",
          .mass_kg = 120.0,
          .gravity_m_s2 = 3.71,
          .wheel_count = 6,
          .wheelbase_m = 1.2,
          .track_m = 1.0,
          .clearance_m = 0.3,
          .max_torque_Nm = 30.0};
}

TEST(Rover, WheelLoadIsWeightOverWheelCount) {
  EXPECT_DOUBLE_EQ(wheelLoad_N(rover()), 120.0 * 3.71 / 6.0);  // Closed form: m g / count.
}

TEST(Rover, EveryLengthMassAndLimitIsChecked) {
  EXPECT_NO_THROW(validate(rover()));
  for (double Rover::*field : {&Rover::mass_kg, &Rover::gravity_m_s2, &Rover::wheelbase_m, &Rover::track_m,
                               &Rover::clearance_m, &Rover::max_torque_Nm, &Rover::max_speed_mps})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      Rover r = rover();
      r.*field = bad;
      EXPECT_THROW(validate(r), std::invalid_argument);
    }
  for (double Rover::*field :
       {&Rover::centre_of_mass_height_m, &Rover::turning_radius_m, &Rover::hotel_power_W}) {
    Rover r = rover();
    r.*field = 0.0;
    EXPECT_NO_THROW(validate(r));
    r.*field = -1.0;
    EXPECT_THROW(validate(r), std::invalid_argument);
  }
  for (const double bad : {1e-15, 1e-9, 1e-4, 1001.0}) {
    Rover r = rover();
    r.turning_radius_m = bad;
    EXPECT_THAT([&] { validate(r); }, ThrowsMessage<std::invalid_argument>(HasSubstr("must be 0 or")));
  }
  for (const auto& [field, bad] : {std::pair{&Rover::mass_kg, 1e-3},
                                   {&Rover::mass_kg, 1e7},
                                   {&Rover::max_speed_mps, 1e-12},
                                   {&Rover::max_speed_mps, 101.0}}) {
    Rover r = rover();
    r.*field = bad;
    EXPECT_THROW(validate(r), std::invalid_argument) << bad;
  }
  Rover in_millimetres = rover();
  in_millimetres.clearance_m = 250.0;
  EXPECT_THROW(validate(in_millimetres), std::invalid_argument);
  for (double Rover::*field : {&Rover::max_pitch_rad, &Rover::max_roll_rad})
    for (const double bad : {-0.1, 1.6, std::nan("")}) {
      Rover r = rover();
      r.*field = bad;
      EXPECT_THROW(validate(r), std::invalid_argument);
    }
}

TEST(Rover, ErrorNamesRoverAndField) {
  Rover one_wheel = rover();
  one_wheel.wheel_count = 1;
  EXPECT_THAT([&] { validate(one_wheel); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("rover 'A': wheels.count = 1, must be >= 2")));
  Rover flat = rover();
  flat.wheel.width_m = 0.0;
  EXPECT_THAT([&] { validate(flat); }, ThrowsMessage<std::invalid_argument>(HasSubstr("wheels.width_m = 0")));
}

TEST(SideBulldozing, FrictionlessResistanceIsCohesionAndWeightTerm) {
  // Closed form: phi = 0 gives X = 45 deg, D1 = 2, D2 = 1, R = 2 c h + gamma h^2.
  const Hegedus soil = hegedus({.cohesion_Pa = 500.0, .tan_friction = 0.0, .weight_N_m3 = 15000.0});
  EXPECT_NEAR(soil.resistance_N_m(0.03), 2.0 * 500.0 * 0.03 + 15000.0 * 0.03 * 0.03, 1e-9);
}

TEST(SideBulldozing, FrictionalResistanceMatchesHegedus) {
  // Closed form: phi = 30 deg, X = 30 deg, cot X = sqrt 3, D1 = 2 sqrt 3, D2 = sqrt 3 + 3 / sqrt 3 = 2 sqrt
  // 3.
  const Hegedus soil =
      hegedus({.cohesion_Pa = 100.0, .tan_friction = 1.0 / std::sqrt(3.0), .weight_N_m3 = 1000.0});
  EXPECT_NEAR(soil.per_depth_Pa, 2.0 * std::sqrt(3.0) * 100.0, 1e-9);
  EXPECT_NEAR(soil.per_depth_squared_N_m3, 0.5 * 12.0 * 1000.0, 1e-8);
}

TEST(SideBulldozing, FaceResistanceIsTheIntegralOverTheChord) {
  const Hegedus soil{.per_depth_Pa = 700.0, .per_depth_squared_N_m3 = 50000.0};
  const double r = 0.2;
  for (const double theta_1 : {0.003, 0.05, 0.0999, 0.1001, 0.3, 0.9, 0.5 * std::numbers::pi}) {
    double sum = 0.0;
    const int n = 20000;
    for (int k = 0; k < n; ++k) {
      const double theta = theta_1 * ((k + 0.5) / n);
      // r (cos theta - cos theta_1) without cancellation
      const double h = 2.0 * r * std::sin(0.5 * (theta_1 + theta)) * std::sin(0.5 * (theta_1 - theta));
      sum += 2.0 * soil.resistance_N_m(h) * r * std::cos(theta) * theta_1 / n;
    }
    // Property: the closed form equals the integral; the midpoint rule with 20000 intervals is accurate to
    // 1e-8.
    EXPECT_NEAR(faceResistance_N(soil, {r, theta_1}) / sum, 1.0, 1e-7) << theta_1;
  }
}

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

TEST(ContactGeometry, EntryAngleIsArccosOfOneMinusSinkageOverRadius) {
  // Closed form: thesis text before Eq. 3.12 (corrected: arccos, not arctan).
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.05), std::numbers::pi / 3.0, 1e-15);
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.1), std::numbers::pi / 2.0, 1e-15);
  EXPECT_EQ(entryAngle_rad(kWheel, 0.0), 0.0);
}

TEST(ContactGeometry, EntryAngleIsAccurateAtSmallSinkage) {
  // Closed form: theta_1 = sqrt(2 z/r) (1 + z/(12 r) + ...); arccos(1 - z/r) is accurate to half of the
  // digits only.
  const double ratio = 1e-10;
  EXPECT_NEAR(entryAngle_rad(kWheel, ratio * 0.1) / std::sqrt(2.0 * ratio), 1.0 + ratio / 12.0, 1e-15);
}

TEST(ContactGeometry, SinkageInvertsEntryAngle) {
  // Property: sinkage and entry angle are inverse to each other.
  for (const double z : {1e-9, 1e-3, 0.03, 0.15}) {
    EXPECT_NEAR(sinkage_m(kWheel, entryAngle_rad(kWheel, z)), z, 1e-14 * (z + 1e-9));
  }
}

TEST(ContactGeometry, ChordIsTwiceRadiusTimesSineOfEntryAngle) {
  // Closed form: 2 r sin(theta_1).
  EXPECT_NEAR(contactChord_m(kWheel, 0.02), 0.2 * std::sin(entryAngle_rad(kWheel, 0.02)), 1e-16);
}

TEST(ContactGeometry, InvalidSinkageIsRejected) {
  EXPECT_REFUSED(entryAngle_rad(kWheel, -1e-6), std::invalid_argument,
                 "sinkage_m = -1e-06, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, 0.2), std::invalid_argument, "sinkage_m = 0.2, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, std::nan("")), std::invalid_argument,
                 "sinkage_m = nan, must be finite");
}

ShearDisplacement at(double slip, double entry = 0.6) {
  return ShearDisplacement{{0.2, slip, entry}};
}

TEST(ShearDisplacement, IsEquationC6ForDrivenWheels) {
  const double entry = 0.6, theta = 0.1;
  // Closed form: C.6.
  EXPECT_DOUBLE_EQ(at(0.3).at_m(theta), 0.2 * ((entry - theta) - 0.7 * (std::sin(entry) - std::sin(theta))));
  EXPECT_DOUBLE_EQ(at(1.0).at_m(theta), 0.2 * (entry - theta));  // spinning in place: the arc rolled
}

TEST(ShearDisplacement, IntegratesTheSlidingVelocityOfARimPoint) {
  // Closed form: dj = (r omega - v cos theta) dt with d theta = -omega dt; v/(r omega) = 1/(1 + slip) for a
  // braked wheel.
  for (const double slip : {-0.6, -0.2, 0.0, 0.4}) {
    const double q = slip < 0.0 ? 1.0 / (1.0 + slip) : 1.0 - slip;
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double theta = 0.6 - 0.5 * (k + 0.5) / kSteps;
      sum += 0.2 * (1.0 - q * std::cos(theta)) * 0.5 / kSteps;
    }
    EXPECT_NEAR(at(slip).at_m(0.1), sum, 1e-10) << slip;
  }
}

TEST(ShearDisplacement, LockedWheelHasInfiniteShearDisplacement) {
  EXPECT_EQ(at(-1.0).at_m(0.3), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(at(-1.0).signChange_rad(0.0)));
}

TEST(ShearDisplacement, SignChangesOnlyForTowedWheelsAtSmallNegativeSlip) {
  EXPECT_TRUE(std::isnan(at(0.0).signChange_rad(0.0)));
  EXPECT_TRUE(std::isnan(at(-0.5).signChange_rad(0.0)));  // the rim is slower than the soil from the entry on
  const double zero = at(-0.1).signChange_rad(0.0);
  ASSERT_GT(zero, 0.0);
  EXPECT_NEAR(at(-0.1).at_m(zero), 0.0, 1e-15);
  EXPECT_GT(at(-0.1).at_m(zero + 0.05), 0.0);
  EXPECT_LT(at(-0.1).at_m(zero - 0.05), 0.0);
}

/// Uniform pressure, no shear, contact from theta_1 to theta_2 = -theta_1; all integrals have closed forms.
struct EvenPressure {
  double pressure_Pa(double) const { return 5e3; }
  double shear_Pa(double, double) const { return 0.0; }
  double peak_rad(double) const { return 0.0; }
  double exit_rad(double entry) const { return -entry; }
};

/// Uniform shear in addition.
struct EvenShear : EvenPressure {
  double shear_Pa(double, double) const { return 2e3; }
};

const Wheel kLargeWheel{.radius_m = 0.2, .width_m = 0.1};

TEST(RimContact, UniformStressesIntegrateToClosedForm) {
  const ShearDisplacement displacement{{0.2, 0.3, 0.7}};
  const RimForces pressed = rimForces(EvenPressure{}, kLargeWheel, displacement);
  const double rb = 0.02;
  EXPECT_NEAR(pressed.load_N, rb * 5e3 * 2.0 * std::sin(0.7), 1e-9);  // Closed form.
  EXPECT_NEAR(pressed.drawbar_pull_N, 0.0, 1e-9);
  const RimForces sheared = rimForces(EvenShear{}, kLargeWheel, displacement);
  EXPECT_NEAR(sheared.torque_Nm, 0.2 * rb * 2e3 * 1.4, 1e-9);
  EXPECT_NEAR(sheared.drawbar_pull_N, rb * 2e3 * 2.0 * std::sin(0.7), 1e-9);
}

TEST(RimContact, EntryAngleBalancesTheLoad) {
  const double load = 0.02 * 5e3 * 2.0 * std::sin(0.9);
  const RimEquilibrium rim =
      rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = load, .slip = 0.0, .first_guess = 0.01});
  EXPECT_NEAR(rim.entry_angle_rad, 0.9, 1e-12);  // Closed form.
}

TEST(RimContact, LoadBeyondTheAxleIsRejected) {
  const double most = 0.02 * 5e3 * 2.0;
  EXPECT_NO_THROW(rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = 0.999 * most}));
  EXPECT_THROW(rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = 1.001 * most}), std::domain_error);
}

struct Errors {
  double side = 0.0, pull = 0.0, sinkage = 0.0;  // root mean square errors of side force and pull over load,
                                                 // and of sinkage over radius
  int runs = 0;
};

// RMS errors over the driven runs of the smooth wheel at a slip angle (cmu_testbed, Pavlov and Johnson),
// with the slip in the wheel's plane.
Errors errorsAt(double angle_deg, const Soil& soil, const std::string& path) {
  std::ifstream runs(path);
  Errors errors;
  for (std::string line; std::getline(runs, line);) {
    double slip = 0.0, beta = 0.0, v = 0.0, rim = 0.0, load = 0.0, z = 0.0, pull = 0.0, side = 0.0, r = 0.0,
           b = 0.0;
    if (std::sscanf(line.c_str(), "smooth_%*[^,],smooth,%*[^,],%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf",
                    &slip, &beta, &v, &rim, &load, &z, &pull, &side, &r, &b) != 10)
      continue;
    if (slip < 0.0 || std::abs(std::abs(beta) * 180.0 / std::numbers::pi - angle_deg) > 4.0) continue;
    const double along = v * std::cos(beta);
    const WheelForces f = equilibrium(soil, {.radius_m = r, .width_m = b},
                                      {.load_N = load,
                                       .slip = rim >= along ? 1.0 - along / rim : rim / along - 1.0,
                                       .slip_angle_rad = beta,
                                       .gravity_m_s2 = 9.81});
    errors.side += std::pow((f.side_force_N - side) / load, 2);
    errors.pull += std::pow((f.drawbar_pull_N - pull) / load, 2);
    errors.sinkage += std::pow((f.sinkage_m - z) / r, 2);
    ++errors.runs;
  }
  for (double* sum : {&errors.side, &errors.pull, &errors.sinkage})
    *sum = std::sqrt(*sum / std::max(1, errors.runs));
  return errors;
}

// Measured by others: the soil of the authors (cohesion estimated, friction measured, k and n from plate
// tests). Three parameters, K, c1 and the slip sinkage, are fitted to the runs at 0 degrees only.
// docs/slopes.md states the errors at 45 degrees, where the goals are missed.
TEST(MeasuredWheel, ThreeParametersFittedStraightPredictRunsAt15Degrees) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  if (!folder) GTEST_SKIP() << "TALUS_MEASURED_DATA is not set";
  const std::string runs = std::filesystem::path(folder) / "cmu_testbed" / "runs.csv";
  Soil soil{.name = "testbed",
            .cohesion_Pa = 1000.0,
            .friction_angle_rad = 29.0 * std::numbers::pi / 180.0,
            .sinkage_exponent = 1.44,
            .frictional_modulus = 9.3e6,
            .shear_modulus_m = 0.0092,
            .c1 = 0.354,
            .slip_sinkage_exponent = 0.11};
  for (const double angle_deg : {0.0, 15.0}) {
    const Errors errors = errorsAt(angle_deg, soil, runs);
    ASSERT_GE(errors.runs, 9);
    EXPECT_LT(errors.side, 0.05) << angle_deg;
    EXPECT_LT(errors.pull, 0.04) << angle_deg;
    EXPECT_LT(errors.sinkage, 0.03) << angle_deg;
  }
  // Property: without slip sinkage the predicted sinkage is too small.
  soil.slip_sinkage_exponent = 0.0;
  for (const double angle_deg : {0.0, 15.0, 45.0})
    EXPECT_GT(errorsAt(angle_deg, soil, runs).sinkage, 0.07) << angle_deg;
}

}  // namespace rover_test
}  // namespace talus::terramech
