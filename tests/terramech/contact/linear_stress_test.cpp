#include <cmath>

#include <talus/terramech/contact/linear_stress.hpp>
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

}  // namespace linear_stress_test

}  // namespace talus::terramech
