#include <cmath>
#include <numbers>
#include <stdexcept>

#include <talus/terramech/contact/rim_contact.hpp>

namespace talus::terramech {
namespace rim_contact_test {

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

const Wheel kWheel{.radius_m = 0.2, .width_m = 0.1};

TEST(RimContact, UniformStressesIntegrateToClosedForm) {
  const ShearDisplacement displacement{{0.2, 0.3, 0.7}};
  const RimForces pressed = rimForces(EvenPressure{}, kWheel, displacement);
  const double rb = 0.02;
  EXPECT_NEAR(pressed.load_N, rb * 5e3 * 2.0 * std::sin(0.7), 1e-9);  // Closed form.
  EXPECT_NEAR(pressed.drawbar_pull_N, 0.0, 1e-9);
  const RimForces sheared = rimForces(EvenShear{}, kWheel, displacement);
  EXPECT_NEAR(sheared.torque_Nm, 0.2 * rb * 2e3 * 1.4, 1e-9);
  EXPECT_NEAR(sheared.drawbar_pull_N, rb * 2e3 * 2.0 * std::sin(0.7), 1e-9);
}

TEST(RimContact, EntryAngleBalancesTheLoad) {
  const double load = 0.02 * 5e3 * 2.0 * std::sin(0.9);
  const RimEquilibrium rim =
      rimEquilibrium(EvenPressure{}, kWheel, {.load_N = load, .slip = 0.0, .first_guess = 0.01});
  EXPECT_NEAR(rim.entry_angle_rad, 0.9, 1e-12);  // Closed form.
}

TEST(RimContact, LoadBeyondTheAxleIsRejected) {
  const double most = 0.02 * 5e3 * 2.0;
  EXPECT_NO_THROW(rimEquilibrium(EvenPressure{}, kWheel, {.load_N = 0.999 * most}));
  EXPECT_THROW(rimEquilibrium(EvenPressure{}, kWheel, {.load_N = 1.001 * most}), std::domain_error);
}

}  // namespace rim_contact_test
}  // namespace talus::terramech
