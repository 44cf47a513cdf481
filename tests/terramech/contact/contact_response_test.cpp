#include <cmath>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {
namespace contact_response_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

std::vector<ContactSoil> soils() {
  return {{200.0, 0.56, 0.5, 1.6e6, 0.012},
          {6200.0, 0.4, 1.1, 1.2e6, 0.027},
          {3000.0, 0.45, 0.8, 1.8e6, 0.02},
          {500.0, 0.6, 0.3, 4e5, 0.02},
          {0.0, 0.5, 1.6, 2e7, 0.03}};
}

Soil exactSoil(const ContactSoil& s) {
  return {.name = "test",
          .cohesion_Pa = s.cohesion_Pa,
          .friction_angle_rad = s.friction_angle_rad,
          .sinkage_exponent = s.sinkage_exponent,
          .frictional_modulus = s.sinkage_modulus,
          .shear_modulus_m = s.shear_modulus_m};
}

TEST(ContactResponse, MatchesTheExactContactIntegrals) {
  // Closed form: the same integrals (C.8 to C.10) by the 24-point rule; stated accuracy 1e-4 of load.
  for (const ContactSoil& s : soils()) {
    for (const double load : {20.0, 80.0}) {
      for (const double slip : {0.05, 0.2, 0.5, 0.8, 1.0}) {
        const WheelForces exact = equilibrium(exactSoil(s), kWheel, {.load_N = load, .slip = slip});
        const ForceVector f = contactForces(s, kWheel, {.sinkage_m = exact.sinkage_m, .slip = slip});
        EXPECT_NEAR(f[kLoad], load, 1e-4 * load);
        EXPECT_NEAR(f[kTorque], exact.torque_Nm, 1e-4 * load * kWheel.radius_m);
        EXPECT_NEAR(f[kPull], exact.drawbar_pull_N, 1e-4 * load);
      }
    }
  }
}

TEST(ContactResponse, DerivativeMatchesCentralDifferences) {
  // Property: the derivatives equal central differences with a relative step of 1e-5, whose error is about
  // 1e-9 of the scale.
  for (const ContactSoil& s : soils()) {
    const ContactState at{.sinkage_m = 0.02, .slip = 0.4};
    ContactDerivative d;
    (void)contactForces(s, kWheel, at, d);
    for (int column = 0; column < kContactColumns; ++column) {
      const auto shifted = [&](double sign) {
        ContactSoil soil = s;
        ContactState state = at;
        double* const x[] = {&soil.cohesion_Pa,
                             &soil.friction_angle_rad,
                             &soil.sinkage_exponent,
                             &soil.sinkage_modulus,
                             &soil.shear_modulus_m,
                             &state.sinkage_m,
                             &state.slip};
        const double step = 1e-5 * (*x[column] > 0.0 ? *x[column] : 1000.0);
        *x[column] += sign * step;
        return std::pair{contactForces(soil, kWheel, state), step};
      };
      const auto [up, step] = shifted(1.0);
      const auto [down, same] = shifted(-1.0);
      const Eigen::Vector3d numeric = (up - down) / (2.0 * step);
      EXPECT_LT((numeric - d.col(column)).norm(), 1e-6 * (numeric.norm() + 1e-9)) << "column " << column;
    }
  }
}

}  // namespace contact_response_test
}  // namespace talus::terramech
