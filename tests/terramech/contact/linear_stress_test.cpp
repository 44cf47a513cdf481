#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/contact/pneumatic_tyre.hpp>
#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {
namespace linear_stress_test {

// Simpson's rule over [a, b], 400 intervals: error below 1e-11 for these integrands.
template <class F>
double integral(F&& f, double a, double b) {
  constexpr int kIntervals = 400;
  const double step = (b - a) / kIntervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(a + i * step);
  return sum * step / 3.0;
}

TEST(LinearStressMoments, MomentsEqualTheirIntegrals) {
  // Closed form, checked by quadrature; the last moment is the corrected offset term of Eq. 2.3.
  for (const double theta_1 : {0.01, 0.3, 0.9, 1.5}) {
    const LinearStressMoments m(theta_1);
    const double h = 0.5 * theta_1;
    const auto triangle = [&](double t) { return t < h ? t / h : (theta_1 - t) / h; };
    const auto offset = [&](double t) { return 1.0 - t / h; };
    const auto over = [&](auto weight, auto part) { return [=](double t) { return weight(t) * part(t); }; };
    const auto cosine = [](double t) { return std::cos(t); };
    const auto sine = [](double t) { return std::sin(t); };
    EXPECT_NEAR(m.peak_cos,
                integral(over(triangle, cosine), 0, h) + integral(over(triangle, cosine), h, theta_1), 1e-10);
    EXPECT_NEAR(m.peak_sin, integral(over(triangle, sine), 0, h) + integral(over(triangle, sine), h, theta_1),
                1e-10);
    EXPECT_NEAR(m.offset_cos, integral(over(offset, cosine), 0, h), 1e-10);
    EXPECT_NEAR(m.offset_sin, integral(over(offset, sine), 0, h), 1e-10);
  }
}

TEST(LinearStressMoments, PrintedOffsetTermOfEquation23DiffersFromTheIntegral) {
  // Printed in: thesis Eq. 2.3, cos(theta_m) - sin(theta_m)/theta_m + theta_m. Found wrong.
  const LinearStressMoments m(0.8);
  const double printed = std::cos(0.4) - std::sin(0.4) / 0.4 + 0.4;
  EXPECT_GT(std::abs(printed - m.offset_sin), 0.2);
}

TEST(Mobilisation, IsJanosiHanamotoAtMidContactAndBottom) {
  // Closed form: Eqs. C.6, C.7 at theta_1/2 and 0.
  const Wheel wheel{.radius_m = 0.1, .width_m = 0.1};
  const WheelSample sample{.load_N = 80, .torque_Nm = 3, .sinkage_m = 0.02, .slip = 0.4};
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const auto share = [&](double theta) {
    const double j = 0.1 * (theta_1 - theta - 0.6 * (std::sin(theta_1) - std::sin(theta)));
    return 1.0 - std::exp(-j / 0.02);
  };
  EXPECT_NEAR(mobilisation(wheel, sample, 0.02).peak, share(0.5 * theta_1), 1e-14);
  EXPECT_NEAR(mobilisation(wheel, sample, 0.02).bottom, share(0.0), 1e-14);
}

Soil loam() {
  return {.name = "loam",
          .cohesion_Pa = 3000.0,
          .friction_angle_rad = 0.44,
          .sinkage_exponent = 0.8,
          .frictional_modulus = 1.7e6,
          .shear_modulus_m = 0.02};
}

TEST(ShearStress, StrengthIsMohrCoulomb) {
  EXPECT_DOUBLE_EQ(shearStrength_Pa(loam(), 1e4), 3000.0 + 1e4 * std::tan(0.44));  // Closed form: A.2.
}

TEST(ShearStress, BothLawsShareInitialStiffnessAndStrength) {
  const double strength = shearStrength_Pa(loam(), 1e4);
  EXPECT_NEAR(janosiHanamoto_Pa(loam(), 1e4, 1e-8) / elastoPlastic_Pa(loam(), 1e4, 1e-8), 1.0, 1e-6);
  EXPECT_DOUBLE_EQ(elastoPlastic_Pa(loam(), 1e4, 0.02), strength);
  EXPECT_NEAR(janosiHanamoto_Pa(loam(), 1e4, 1.0), strength, 1e-9);
  // Printed in: thesis A.2 text, 95 % of the strength at three times K.
  EXPECT_NEAR(janosiHanamoto_Pa(loam(), 1e4, 0.06) / strength, 0.95, 5e-4);
}

TEST(ShearStress, IsOddInTheDisplacement) {
  for (const double j : {0.001, 0.01, 0.1}) {  // Property: odd symmetry.
    EXPECT_EQ(janosiHanamoto_Pa(loam(), 5e3, -j), -janosiHanamoto_Pa(loam(), 5e3, j));
    EXPECT_EQ(elastoPlastic_Pa(loam(), 5e3, -j), -elastoPlastic_Pa(loam(), 5e3, j));
  }
}

/// Wong and Reece with the elasto-plastic shear law in place of Janosi and Hanamoto's.
class ElastoPlasticRim {
 public:
  ElastoPlasticRim(const Soil& soil, const Wheel& wheel, const WheelOperation& operation)
      : soil_(soil), rest_(soil, wheel, operation) {}
  double pressure_Pa(double depth_m) const { return rest_.pressure_Pa(depth_m); }
  double shear_Pa(double normal_Pa, double displacement_m) const {
    return elastoPlastic_Pa(soil_, normal_Pa, displacement_m);
  }
  double peak_rad(double entry_rad) const { return rest_.peak_rad(entry_rad); }
  double exit_rad(double entry_rad) const { return rest_.exit_rad(entry_rad); }

 private:
  Soil soil_;
  WongReece rest_;
};

TEST(ShearStress, ElastoPlasticLawPullsMoreAndSinksLessThanJanosi) {
  const WheelOperation operation{.load_N = 80.0, .slip = 0.4};
  const ElastoPlasticRim law{loam(), Wheel{}, operation};
  const RimEquilibrium rim = rimEquilibrium(law, Wheel{}, {.load_N = 80.0, .slip = 0.4});
  const WheelForces janosi = equilibrium(loam(), Wheel{}, operation);
  EXPECT_NEAR(rim.forces.load_N, 80.0, 1e-9);
  // Property: min(x, 1) > 1 - e^-x, so that the elasto-plastic law gives more pull and less sinkage.
  EXPECT_GT(rim.forces.drawbar_pull_N, janosi.drawbar_pull_N);
  EXPECT_LT(rim.entry_angle_rad, janosi.entry_angle_rad);
}

TEST(ShearStress, NinetyFivePercentOfStrengthIsReachedAtThreeK) {
  // Printed in: thesis A.2 (K is a third of the displacement at 95 % of tau_max).
  const Soil soil{.cohesion_Pa = 740.0, .friction_angle_rad = 0.55, .shear_modulus_m = 0.013};
  EXPECT_NEAR(janosiHanamoto_Pa(soil, 8000.0, 0.039) / shearStrength_Pa(soil, 8000.0), 0.95, 0.001);
}

Rover rover() {
  Rover r;
  r.mass_kg = 100.0;
  r.gravity_m_s2 = 10.0;
  r.wheel_count = 4;
  r.wheelbase_m = 1.0;
  r.centre_of_mass_height_m = 0.5;
  return r;
}

TEST(WheelLoads, LoadsAreEqualOnLevelGround) {
  for (const double load_N : wheelLoads_N(rover(), 0.0, {0.5, 0.5, -0.5, -0.5}))
    EXPECT_DOUBLE_EQ(load_N, 250.0);
}

TEST(WheelLoads, TwoAxleLoadTransferMatchesClosedForm) {
  const double slope = 0.2;
  const auto loads_N = wheelLoads_N(rover(), std::tan(slope), {0.5, 0.5, -0.5, -0.5});
  // Closed form: an axle loses m g sin(alpha) h / L, half of it at each wheel
  EXPECT_NEAR(loads_N[0], 250.0 * std::cos(slope) - 0.5 * 1000.0 * std::sin(slope) * 0.5 / 1.0, 1e-9);
  EXPECT_NEAR(loads_N[3], 250.0 * std::cos(slope) + 0.5 * 1000.0 * std::sin(slope) * 0.5 / 1.0, 1e-9);
}

TEST(WheelLoads, SixWheelLoadsBalanceForceAndMoment) {
  const double gradient = -0.15, normal_N = 1000.0 / std::hypot(1.0, gradient);
  const std::vector<double> along{0.5, 0.5, 0.1, 0.1, -0.6, -0.6};
  const auto loads_N = wheelLoads_N(rover(), gradient, along);
  double moment = 0.0;
  for (std::size_t w = 0; w < along.size(); ++w) moment += loads_N[w] * along[w];
  EXPECT_NEAR(std::accumulate(loads_N.begin(), loads_N.end(), 0.0), normal_N, 1e-9);
  EXPECT_NEAR(moment, -normal_N * gradient * 0.5, 1e-9);
}

TEST(WheelLoads, LoadsStayPositiveOnSteepSlopes) {
  for (const double load_N : wheelLoads_N(rover(), 2.0, {0.5, 0.5, -0.5, -0.5})) EXPECT_GT(load_N, 0.0);
  EXPECT_TRUE(wheelLoads_N(rover(), 0.1, {}).empty());
  EXPECT_EQ(wheelLoads_N(rover(), 0.1, {0.0}).size(), 1U);
}

/// Tests of wheel_on_soil.hpp for a wheel that travels at an angle to its plane.

constexpr double kRight = 0.5 * std::numbers::pi;

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 300.0,
          .friction_angle_rad = 0.5,
          .sinkage_exponent = 1.1,
          .frictional_modulus = 1.2e6,
          .shear_modulus_m = 0.015};
}

Soil shearOnly(Soil soil) {
  soil.digging_exponent = soil.side_bulldozing = 0.0;
  return soil;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

TEST(SideSlip, ConvergesToTheStraightWheelAtZeroAngle) {
  for (const double slip : {-1.0, -0.6, -0.1, 0.0, 0.05, 0.4, 1.0}) {
    const WheelForces straight = equilibrium(sand(), {}, {.load_N = 60.0, .slip = slip});
    const WheelForces askew = equilibrium(sand(), {}, {.load_N = 60.0, .slip = slip, .slip_angle_rad = 1e-9});
    // Property: the forces are continuous in the slip angle, here 1e-9 rad.
    EXPECT_NEAR(askew.drawbar_pull_N, straight.drawbar_pull_N, 1e-6) << slip;
    EXPECT_NEAR(askew.torque_Nm, straight.torque_Nm, 1e-7) << slip;
    EXPECT_NEAR(askew.sinkage_m / straight.sinkage_m, 1.0, 1e-7) << slip;
    EXPECT_NEAR(askew.side_force_N, 0.0, 1e-5) << slip;
    EXPECT_EQ(straight.side_force_N, 0.0);
  }
}

TEST(SideSlip, SideForceIsOddAndOtherForcesEvenInSlipAngle) {
  Random random{5};
  for (int k = 0; k < 60; ++k) {
    const double slip = random.between(-1.0, 1.0), angle = random.between(1e-3, kRight);
    const WheelForces left = equilibrium(sand(), {}, {.load_N = 50.0, .slip = slip, .slip_angle_rad = angle});
    const WheelForces right =
        equilibrium(sand(), {}, {.load_N = 50.0, .slip = slip, .slip_angle_rad = -angle});
    // Property: mirror symmetry, exact in floating point.
    EXPECT_EQ(left.side_force_N, -right.side_force_N);
    EXPECT_EQ(left.drawbar_pull_N, right.drawbar_pull_N);
    EXPECT_EQ(left.torque_Nm, right.torque_Nm);
    EXPECT_EQ(left.sinkage_m, right.sinkage_m);
    EXPECT_LE(left.side_force_N, 0.0);
  }
}

TEST(SideSlip, LockedWheelOnHardGroundIsCoulombFriction) {
  Soil hard = shearOnly(sand());
  hard.cohesion_Pa = 0.0;
  hard.frictional_modulus = 1e22;
  hard.shear_modulus_m = 1e-9;
  const double mu = std::tan(hard.friction_angle_rad);
  for (const double angle : {0.2, 0.8, 1.3, kRight}) {
    const WheelForces f = equilibrium(hard, {}, {.load_N = 80.0, .slip = -1.0, .slip_angle_rad = angle});
    // Closed form: F = -mu W along the sliding direction. Tolerance: theta_1 is below 1e-5, and 90 deg is
    // clamped to 89.94 deg, whose cosine is 1e-3.
    EXPECT_NEAR(f.side_force_N / 80.0, -mu * std::sin(angle), 2e-5) << angle;
    EXPECT_NEAR(f.drawbar_pull_N / 80.0, -mu * std::cos(angle), angle < 1.5 ? 2e-5 : 1.1e-3) << angle;
  }
}

TEST(SideSlip, WheelAtFullSlipHasNoLateralShearForce) {
  const WheelForces f =
      equilibrium(shearOnly(sand()), {}, {.load_N = 60.0, .slip = 1.0, .slip_angle_rad = 0.5});
  // Closed form: v = 0, the soil is sheared along the wheel plane only.
  EXPECT_EQ(f.side_force_N, 0.0);
}

TEST(SideSlip, ShearForceNeverExceedsSoilStrength) {
  Random random{11};
  int answered = 0;
  for (int k = 0; k < 200; ++k) {
    Soil soil = sand();
    soil.cohesion_Pa = random.between(0.0, 5e3);
    soil.friction_angle_rad = random.between(0.1, 0.75);
    soil.shear_modulus_m = random.between(0.001, 0.04);
    const Wheel wheel{.radius_m = random.between(0.05, 0.3), .width_m = random.between(0.04, 0.2)};
    const WheelOperation how{.load_N = random.between(10.0, 200.0),
                             .slip = random.between(-1.0, 1.0),
                             .slip_angle_rad = random.between(-kRight, kRight)};
    WheelForces f;
    try {
      f = equilibrium(soil, wheel, how);
    } catch (const std::domain_error&) {
      continue;  // the wheel sinks to its axle
    }
    ++answered;
    double strength_N = 0.0;
    const auto stresses = stressDistribution(soil, wheel, how, 4001);
    for (std::size_t p = 0; p + 1 < stresses.size(); ++p)
      strength_N += (soil.cohesion_Pa + 0.5 * (stresses[p].normal_Pa + stresses[p + 1].normal_Pa) *
                                            std::tan(soil.friction_angle_rad)) *
                    (stresses[p + 1].angle_rad - stresses[p].angle_rad) * wheel.radius_m * wheel.width_m;
    const Hegedus push = hegedus({.cohesion_Pa = soil.cohesion_Pa,
                                  .tan_friction = std::tan(soil.friction_angle_rad),
                                  .weight_N_m3 = soil.density_kg_m3 * how.gravity_m_s2});
    const double face_N =
        faceResistance_N(push, {wheel.radius_m, f.entry_angle_rad}) * std::abs(std::sin(how.slip_angle_rad));
    const double rim_side_N = std::abs(f.side_force_N) - face_N;
    // Property: |int tau| <= int (c + sigma tan phi). Tolerance: 1e-4 for the trapezoid sum of the strength.
    EXPECT_LE(std::hypot(f.torque_Nm / wheel.radius_m, rim_side_N), strength_N * (1.0 + 1e-4)) << k;
    EXPECT_GE(rim_side_N, -1e-6 * how.load_N);
  }
  EXPECT_GT(answered, 150);
}

TEST(SideSlip, ResultantSlipMatchesLimitCases) {
  // Closed form: |i| at slip angle 0, 1 for a locked wheel at any angle, sqrt 2 at 90 deg with r omega = v.
  EXPECT_EQ(resultantSlip(0.3, 0.0), 0.3);
  EXPECT_EQ(resultantSlip(-0.3, 0.0), 0.3);
  EXPECT_NEAR(resultantSlip(-1.0, 0.7), 1.0, 1e-12);
  EXPECT_NEAR(resultantSlip(1.0, 0.7), 1.0, 1e-12);
  EXPECT_NEAR(resultantSlip(0.0, 0.6), std::sin(0.6), 1e-12);
  const double beta = 1.5;
  EXPECT_NEAR(resultantSlip(1.0 - std::cos(beta), beta), std::hypot(1.0 - std::cos(beta), std::sin(beta)),
              1e-12);
}

TEST(SideSlip, DiggingIncreasesSinkageAndReducesPull) {
  Soil soil = sand();
  soil.digging_exponent = 0.0;
  const WheelOperation how{.load_N = 60.0, .slip = 0.2, .slip_angle_rad = 0.6};
  const WheelForces shallow = equilibrium(soil, {}, how);
  soil.digging_exponent = 0.4;
  const WheelForces deep = equilibrium(soil, {}, how);
  // Property: ground that is softer at every depth below 1 m increases the sinkage and reduces the pull.
  EXPECT_GT(deep.sinkage_m, 1.2 * shallow.sinkage_m);
  EXPECT_LT(deep.drawbar_pull_N, shallow.drawbar_pull_N);
}

TEST(SideSlip, ForcesAtEntryAreThoseOfTheEquilibrium) {
  const WheelOperation how{.load_N = 60.0, .slip = 0.2, .slip_angle_rad = 0.6};
  const WheelForces f = equilibrium(sand(), {}, how);
  const ImposedContact at = forcesAtEntry(sand(), {}, how, f.entry_angle_rad);
  EXPECT_NEAR(at.load_N, 60.0, 1e-9);  // Property: the same integrals at the same angle
  EXPECT_NEAR(at.forces.side_force_N, f.side_force_N, 1e-9);
}

TEST(SideSlip, SlipAnglesBeyondNinetyDegreesAreRejected) {
  try {
    static_cast<void>(equilibrium(sand(), {}, {.load_N = 60.0, .slip = 0.1, .slip_angle_rad = 1.6}));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("slip_angle_rad = 1.6"), std::string::npos) << e.what();
  }
}

Soil firmLoam() {
  Soil soil = loam();
  soil.friction_angle_rad = 0.5;
  soil.frictional_modulus = 2e6;
  return soil;
}

Tyre tyre(double inflation_Pa) {
  return {.wheel = {.radius_m = 0.4, .width_m = 0.25}, .inflation_Pa = inflation_Pa, .carcass_Pa = 1e4};
}

TEST(PneumaticTyre, OnRigidGroundFlatAreaTimesPressureEqualsLoad) {
  const TyreForces forces = tyreOnRigidGround(tyre(5e4), {.load_N = 3000.0, .slip = 0.1});
  EXPECT_DOUBLE_EQ(forces.flat_length_m, 3000.0 / (6e4 * 0.25));  // Closed form.
  const double half = 0.5 * forces.flat_length_m;
  EXPECT_NEAR(std::pow(0.4 - forces.deflection_m, 2) + half * half, 0.16,
              1e-14);  // Closed form: chord of a circle.
}

TEST(PneumaticTyre, OnRigidGroundPullRisesWithSlipToTheFrictionLimit) {
  double last = -1.0;
  for (const double slip : {0.0, 0.001, 0.01, 0.1, 1.0}) {
    const double pull = tyreOnRigidGround(tyre(5e4), {.load_N = 3000.0, .slip = slip}).drawbar_pull_N;
    EXPECT_GE(pull, last);
    EXPECT_LE(pull, 0.7 * 3000.0);
    last = pull;
  }
  EXPECT_NEAR(last, 0.7 * 3000.0, 0.01 * 2100.0);
}

TEST(PneumaticTyre, HighInflationIsRigidModeAndLowInflationIsFlattenedMode) {
  const TyreOperation operation{.load_N = 1500.0, .slip = 0.2};
  const double critical = criticalPressure_Pa(firmLoam(), tyre(0.0).wheel, 1500.0);
  const TyreForces hard = tyreOnSoftGround(tyre(critical), firmLoam(), operation);
  EXPECT_EQ(hard.mode, TyreMode::Rigid);
  EXPECT_DOUBLE_EQ(hard.sinkage_m,
                   equilibrium(firmLoam(), tyre(0.0).wheel, {.load_N = 1500.0, .slip = 0.2}).sinkage_m);
  const TyreForces soft = tyreOnSoftGround(tyre(0.4 * critical - 1e4), firmLoam(), operation);
  EXPECT_EQ(soft.mode, TyreMode::Flattened);
  EXPECT_LT(soft.sinkage_m, hard.sinkage_m);
  EXPECT_GT(soft.flat_length_m, 0.0);
  EXPECT_GT(soft.drawbar_pull_N,
            hard.drawbar_pull_N);  // Measured by others: on sand, a lower tyre pressure increases the pull
                                   // (wong_2001).
}

TEST(PneumaticTyre, ForcesEqualTheIntegratedStresses) {
  // Property: load, torque and pull equal midpoint-rule integrals over the round part and the flat, by the
  // laws in the header.
  const double r = 0.4, b = 0.25;
  const Soil soil = firmLoam();
  for (const double slip : {0.0, 0.3}) {
    const Tyre soft = tyre(1e4);
    const TyreForces f = tyreOnSoftGround(soft, soil, {.load_N = 1500.0, .slip = slip});
    ASSERT_EQ(f.mode, TyreMode::Flattened);
    const double entry = std::acos(1.0 - (f.deflection_m + f.sinkage_m) / r);
    const double flat = std::acos(1.0 - f.deflection_m / r);
    const auto j = [&](double a) {  // thesis C.6
      return r * (entry - a - (1.0 - slip) * (std::sin(entry) - std::sin(a)));
    };
    const auto tau = [&](double sigma, double at) {
      return (3000.0 + sigma * std::tan(0.5)) * (1.0 - std::exp(-at / 0.02));
    };
    double load = 2e4 * f.flat_length_m, torque = 0.0, pull = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double a = flat + (entry - flat) * (k + 0.5) / kSteps, ds = r * (entry - flat) / kSteps;
      const double sigma = 2e6 * std::pow(r * (std::cos(a) - std::cos(entry)), 0.8);
      const double t = tau(sigma, j(a));
      load += (sigma * std::cos(a) + t * std::sin(a)) * ds;
      pull += (t * std::cos(a) - sigma * std::sin(a)) * ds;
      torque += r * t * ds;
      const double dx = f.flat_length_m / kSteps;
      const double along = tau(2e4, j(flat) + slip * (k + 0.5) * dx) * dx;
      pull += along;
      torque += (r - f.deflection_m) * along;
    }
    EXPECT_NEAR(b * load, 1500.0, 0.01);
    EXPECT_NEAR(f.torque_Nm / (b * torque), 1.0, 1e-5);
    EXPECT_NEAR(f.drawbar_pull_N, b * pull, 0.01);
  }
}

TEST(PneumaticTyre, SinkageRisesAndDeflectionFallsWithInflationPressure) {
  TyreForces last = tyreOnSoftGround(tyre(2.2e4), firmLoam(), {.load_N = 1500.0, .slip = 0.2});
  for (const double p : {1.8e4, 1.4e4, 1e4, 5e3}) {  // Property: the result is monotone in the pressure.
    const TyreForces forces = tyreOnSoftGround(tyre(p), firmLoam(), {.load_N = 1500.0, .slip = 0.2});
    EXPECT_LT(forces.sinkage_m, last.sinkage_m);
    EXPECT_GT(forces.deflection_m, last.deflection_m);
    last = forces;
  }
}

TEST(PneumaticTyre, CriticalPressureIsThatUnderARigidWheelByBekker) {
  // Closed form: for n = 1 and small angles W = b k sqrt(D z) (3 - n) z / 3 and p = k z.
  Soil soil = firmLoam();
  soil.sinkage_exponent = 1.0;
  const Wheel wheel{.radius_m = 0.4, .width_m = 0.25};
  const double z = 0.01, load = 0.25 * 2e6 * std::sqrt(0.8 * z) * 2.0 / 3.0 * z;
  EXPECT_NEAR(criticalPressure_Pa(soil, wheel, load) / (2e6 * z), 1.0, 1e-12);
}

TEST(PneumaticTyre, InputsOutsideTheModelRangeAreRejected) {
  EXPECT_REFUSED(tyreOnRigidGround(tyre(1e3), {.load_N = 1e5, .slip = 0.1}), std::domain_error,
                 "the tyre flattens over its whole diameter");
  EXPECT_REFUSED(tyreOnSoftGround(tyre(-1.0), firmLoam(), {.load_N = 100.0}), std::invalid_argument,
                 "inflation_Pa = -1, must be >= 0");
  EXPECT_REFUSED(tyreOnSoftGround(tyre(1e3), firmLoam(), {.load_N = 1e6, .slip = 0.2}), std::domain_error,
                 "the tyre sinks and flattens to its axle");
  Soil soil = firmLoam();
  soil.sinkage_exponent = 3.0;
  EXPECT_REFUSED(criticalPressure_Pa(soil, {}, 100.0), std::domain_error,
                 "the critical pressure is known for n < 3 only");
}

Soil drySand() {
  return {.name = "dry sand",
          .cohesion_Pa = 1040.0,
          .friction_angle_rad = 0.4887,
          .sinkage_exponent = 1.1,
          .cohesive_modulus = 990.0,
          .frictional_modulus = 1528430.0};
}

TEST(PressureSinkage, BekkerPressureIsAPowerOfDepth) {
  const double k = 990.0 / 0.05 + 1528430.0;
  EXPECT_DOUBLE_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.02), k * std::pow(0.02, 1.1));  // Closed form: A.1.
  EXPECT_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.0), 0.0);
}

TEST(PressureSinkage, DepthInvertsPressure) {
  for (const double z :
       {0.0, 1e-4, 0.01, 0.2}) {  // Property: pressure and sinkage are inverse to each other.
    EXPECT_NEAR(bekkerDepth_m(drySand(), 0.1, bekkerPressure_Pa(drySand(), 0.1, z)), z, 1e-15);
  }
}

TEST(PressureSinkage, SoilWithoutBearingCapacityIsRejected) {
  Soil soil = drySand();
  soil.cohesive_modulus = -1e6;
  EXPECT_REFUSED(bekkerDepth_m(soil, 0.1, 100.0), std::domain_error, "a soil with modulus -8471570");
  EXPECT_REFUSED(bekkerDepth_m(drySand(), 0.1, -1.0), std::invalid_argument,
                 "pressure_Pa = -1, must be >= 0");
}

TEST(RigidGround, PullIsTorqueOverRadiusUpToTheFrictionLimit) {
  const Wheel wheel{.radius_m = 0.2, .width_m = 0.1};
  const GroundFriction friction{.static_coefficient = 0.7, .kinetic_coefficient = 0.5};
  // Closed form: C.11.
  EXPECT_DOUBLE_EQ(rigidGroundForces(wheel, friction, 100.0, 10.0).drawbar_pull_N, 50.0);
  EXPECT_FALSE(rigidGroundForces(wheel, friction, 100.0, 0.2 * 0.7 * 100.0).slips);
  const RigidGroundForces slipping = rigidGroundForces(wheel, friction, 100.0, -14.1);
  EXPECT_TRUE(slipping.slips);
  EXPECT_DOUBLE_EQ(slipping.drawbar_pull_N, -50.0);
}

TEST(RigidGround, InvalidLoadAndFrictionAreRejected) {
  EXPECT_REFUSED(rigidGroundForces({}, {}, 0.0, 1.0), std::invalid_argument, "load_N = 0, must be > 0");
  EXPECT_REFUSED(rigidGroundForces({}, {.static_coefficient = 0.1, .kinetic_coefficient = 0.5}, 1.0, 1.0),
                 std::invalid_argument, "static_coefficient = 0.1, must be >= 0.5");
}

}  // namespace linear_stress_test
}  // namespace talus::terramech
