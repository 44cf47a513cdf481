#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <refused.hpp>

#include <talus/terramech/mobility/slope_table.hpp>

namespace talus::terramech {
namespace slope_table_test {

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 600.0,
          .friction_angle_rad = 0.55,
          .sinkage_exponent = 1.0,
          .frictional_modulus = 1.5e6,
          .shear_modulus_m = 0.015};
}

Rover rover() {
  return {.name = "box",
          .mass_kg = 40.0,
          .wheel_count = 6,
          .wheel = {.radius_m = 0.12, .width_m = 0.1},
          .wheelbase_m = 0.8,
          .track_m = 0.7,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 40.0,
          .steering = Steering::Ackermann};
}

TEST(SlopeTable, IsNeverLessRestrictiveThanTheEquilibrium) {
  for (const double left_m : {0.0, 0.08}) {
    Rover r = rover();
    r.centre_of_mass_left_m = left_m;
    const SlopeEquilibrium equilibrium{sand(), r};
    const SlopeTable table{equilibrium};
    std::mt19937_64 engine{9};
    std::uniform_real_distribution<double> any{-0.5, 0.5};
    int wary = 0;
    std::vector<double> angle_errors, slip_errors;
    for (int k = 0; k < 2000; ++k) {
      const Gradient g{any(engine), any(engine)};
      const SlopeState exact = equilibrium.at(g), read = table.at(g);
      // Property: the table is conservative; a state that it refuses wrongly lies within one step of an
      // infeasible one.
      EXPECT_TRUE(exact.holds() || !read.holds()) << g.along << ' ' << g.across;
      if (exact.holds() && !read.holds()) {
        ++wary;
        bool near = false;
        for (const double a : {-1.0, 0.0, 1.0})
          for (const double c : {-1.0, 0.0, 1.0})
            near = near || !equilibrium.at({g.along + a * table.step(), g.across + c * table.step()}).holds();
        EXPECT_TRUE(near) << g.along << ' ' << g.across;
      }
      if (!exact.holds() || !read.holds()) continue;
      angle_errors.push_back(std::abs(read.slip_angle_rad) - std::abs(exact.slip_angle_rad));
      slip_errors.push_back(std::abs(read.slip - exact.slip));
    }
    ASSERT_GT(angle_errors.size(), 300u);
    std::ranges::sort(angle_errors);
    std::ranges::sort(slip_errors);
    // Property: the slip angle grows with increasing slope up to the limit, where two equilibria meet and
    // its derivative is infinite. Linear interpolation therefore errs towards larger angles; half of all
    // points lie within the stated numbers.
    EXPECT_GT(angle_errors.front(), -0.005);
    EXPECT_LT(angle_errors[angle_errors.size() / 2], 0.004);
    EXPECT_LT(slip_errors[slip_errors.size() / 2], 0.005);
    EXPECT_GT(wary, 10);
  }
}

TEST(SlopeTable, SlopesOutsideTheTableAreInfeasible) {
  const SlopeTable table{SlopeEquilibrium{sand(), rover()}};
  EXPECT_FALSE(table.at({5.0, 0.0}).holds());
  EXPECT_FALSE(table.at({0.0, -5.0}).holds());
  EXPECT_FALSE(table.at({std::nan(""), 0.0}).holds());
}

TEST(SlopeTable, ZeroStepIsRejected) {
  const SlopeEquilibrium equilibrium{sand(), rover()};
  EXPECT_REFUSED(SlopeTable(equilibrium, {.slope = {}, .step = 0.0}), std::invalid_argument,
                 "step = 0, must be in [0.001, 0.5]");
}

}  // namespace slope_table_test
}  // namespace talus::terramech
