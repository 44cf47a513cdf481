#include <cmath>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/effects/wheel_contact.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace wheel_contact_test {

WheelContact loaded(double load_N, double slip) {
  WheelContact contact = contactOf(madeSand(), Wheel{});
  contact.load_N = load_N;
  contact.slip = slip;
  return contact;
}

TEST(WheelContact, WithoutEffectsMatchesWongReece) {
  // Property: two integrators of one model, with 8 and 24 points, differ by their quadrature error only.
  for (const double load : {15.0, 80.0, 250.0})
    for (const double slip : {-0.9, -0.3, 0.0, 0.1, 0.4, 0.9}) {
      const auto exact = equilibrium(madeSand(), Wheel{}, {.load_N = load, .slip = slip});
      const auto fast = solveContact(loaded(load, slip));
      constexpr double tolerance = 1e-6;
      EXPECT_NEAR(fast.sinkage_m, exact.sinkage_m, tolerance * exact.sinkage_m) << load << ' ' << slip;
      EXPECT_NEAR(fast.drawbar_pull_N, exact.drawbar_pull_N, tolerance * load) << load << ' ' << slip;
      EXPECT_NEAR(fast.torque_Nm, exact.torque_Nm, tolerance * load * 0.1) << load << ' ' << slip;
    }
}

TEST(WheelContact, BatchSolutionMatchesSingleSolutions) {
  // Property: a batch of wheels for the kernel, the fast rule, or both agrees with the same wheels solved
  // one at a time.
  std::vector<WheelContact> contacts;
  for (const double slip : {-0.5, 0.0, 0.05, 0.3, 0.6, 0.95}) {
    contacts.push_back(loaded(60.0, slip));
    contacts.push_back(loaded(60.0, slip));
    contacts.back().rebound = 0.1;
    contacts.push_back(loaded(1e7, slip));
  }
  SolvedContacts solved;
  solveContacts(contacts, solved);
  const std::vector<ContactForces>& forces = solved.forces;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const ContactForces one = solveContact(contacts[k]);
    EXPECT_NEAR(forces[k].sinkage_m, one.sinkage_m, 2e-7) << k;
    EXPECT_NEAR(forces[k].drawbar_pull_N, one.drawbar_pull_N, 1e-6 * contacts[k].load_N) << k;
    EXPECT_NEAR(forces[k].torque_Nm, one.torque_Nm, 1e-6 * contacts[k].load_N * contacts[k].radius_m) << k;
  }
}

TEST(WheelContact, UnchangedContactsAreNotSolvedAgain) {
  // Property: stored forces of an unchanged contact are returned; a changed contact is solved again.
  SolvedContacts solved;
  solveContacts({loaded(60.0, 0.3), loaded(80.0, 0.3)}, solved);
  solved.forces[0].torque_Nm = solved.forces[1].torque_Nm = -1.0;
  solveContacts({loaded(60.0, 0.3), loaded(80.0, 0.31)}, solved);
  EXPECT_EQ(solved.forces[0].torque_Nm, -1.0);
  EXPECT_NEAR(solved.forces[1].torque_Nm, solveContact(loaded(80.0, 0.31)).torque_Nm, 1e-6 * 80.0 * 0.1);
  solveContacts({loaded(60.0, 0.3)}, solved);
  EXPECT_GT(solved.forces[0].torque_Nm, 0.0);
}

TEST(WheelContact, ImposedSinkageIsReachedAtTheGivenLoad) {
  // Closed form: z = gain z0 + extra.
  WheelContact contact = loaded(80.0, 0.4);
  const double z0 = solveContact(contact).sinkage_m;
  contact.sinkage_gain = 2.0;
  contact.extra_sinkage_m = 0.003;
  const auto deep = solveContact(contact);
  EXPECT_NEAR(deep.sinkage_m, 2.0 * z0 + 0.003, 1e-12);
  // Property: more sinkage under the same load reduces the drawbar pull.
  EXPECT_LT(deep.drawbar_pull_N, solveContact(loaded(80.0, 0.4)).drawbar_pull_N);
}

TEST(WheelContact, SideForceIsOddAndPullEvenInTheSlipAngle) {
  WheelContact left = loaded(80.0, 0.3), right = left;
  left.slip_angle_rad = 0.3;
  right.slip_angle_rad = -0.3;
  const auto a = solveContact(left), b = solveContact(right);
  EXPECT_DOUBLE_EQ(a.drawbar_pull_N, b.drawbar_pull_N);
  EXPECT_DOUBLE_EQ(a.side_force_N, -b.side_force_N);
  EXPECT_LT(a.side_force_N, 0.0);
  EXPECT_LT(a.drawbar_pull_N, solveContact(loaded(80.0, 0.3)).drawbar_pull_N);
}

TEST(WheelContact, HardLayerLimitsSinkage) {
  WheelContact contact = loaded(200.0, 0.2);
  const double soft = solveContact(contact).sinkage_m;
  contact.hard_depth_m = 0.5 * soft;
  contact.hard_modulus_Pa_m = 1e9;
  // Property: the sinkage is between the layer's depth and the sinkage without the layer.
  EXPECT_GT(solveContact(contact).sinkage_m, 0.5 * soft);
  EXPECT_LT(solveContact(contact).sinkage_m, 0.75 * soft);
}

TEST(WheelContact, ExcessiveLoadSinksTheWheelToItsAxle) {
  WheelContact contact = loaded(1e7, 0.2);
  EXPECT_NEAR(solveContact(contact).sinkage_m, contact.radius_m, 1e-9);
}

TEST(WheelContact, LongitudinalAndLateralDiggingCombineByPath) {
  WheelContact c = contactOf(madeSand(), Wheel{.radius_m = 0.12, .grouser_height_m = 0.01});
  c.load_N = 80.0;
  c.slip = 0.4;
  const double z0 = solveContact(c).sinkage_m;
  c.dug_m = 0.003;
  c.ploughed_m = 0.004;
  c.extra_sinkage_m = 0.001;
  const ContactForces forces = solveContact(c);
  EXPECT_NEAR(forces.sinkage_m, z0 + 0.005 + 0.001, 1e-12);  // Closed form: hypot(3, 4) = 5.
  EXPECT_NEAR(forces.dug_m, 0.005 * 9.0 / 25.0, 1e-12);      // Closed form: share 3^2 / 5^2.
}

}  // namespace wheel_contact_test
}  // namespace talus::terramech
