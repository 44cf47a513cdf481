#include <cmath>
#include <numbers>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

namespace rim_contact_test {

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

}  // namespace rim_contact_test

}  // namespace talus::terramech
