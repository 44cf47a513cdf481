#include <cmath>

#include <site_fixture.hpp>

#include <talus/planner/simulation/worlds/simulated_wheel_table.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

namespace talus::planner {
namespace simulated_wheel_table_test {

using costmap::testRover;
using costmap::testSand;

TEST(SimulatedWheelTable, NodesMatchTheForwardModel) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (std::size_t layer = 0; layer < SimulatedWheelTable::kLoads; ++layer)
    for (const double slip : {-0.5, 0.0, 0.3, 0.5}) {
      // Closed form: the forward model at the table's nodes, at every 0.025 of slip
      const double load = SimulatedWheelTable::load(layer), load_N = load * terramech::wheelLoad_N(rover);
      const auto wheel = terramech::equilibrium(testSand(), rover.wheel, {.load_N = load_N, .slip = slip});
      const SimulatedWheelTable::Row row = table.at(slip, load);
      EXPECT_NEAR(row.pull, wheel.drawbar_pull_N / load_N, 1e-7);  // stated accuracy of the batch
      EXPECT_NEAR(row.sinkage, wheel.sinkage_m / rover.wheel.radius_m, 1e-7);
      EXPECT_NEAR(row.torque, wheel.torque_Nm / (load_N * rover.wheel.radius_m), 1e-7);
      EXPECT_EQ(row.hold, 0.0);
    }
  // Property: between two nodes a value lies between theirs, and beyond the last node it is constant.
  EXPECT_GT(table.at(0.3, 1.05).sinkage, table.at(0.3, 1.0).sinkage);
  EXPECT_LT(table.at(0.3, 1.05).sinkage, table.at(0.3, 1.15).sinkage);
  EXPECT_NEAR(table.at(0.3, 2.5).sinkage, table.at(0.3, 1.9).sinkage, 1e-12);
}

// Property: at slip angles the nodes equal the forward model; the side force is a magnitude.
TEST(SimulatedWheelTable, NodesMatchTheForwardModelAtSlipAngles) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (std::size_t sheet = 1; sheet < SimulatedWheelTable::kAngles; ++sheet)
    for (const double slip : {-0.5, 0.0, 0.3, 0.5}) {
      const double load_N = terramech::wheelLoad_N(rover), angle = SimulatedWheelTable::angle_rad(sheet);
      const auto wheel = terramech::equilibrium(
          testSand(), rover.wheel,
          {.load_N = load_N, .slip = slip, .slip_angle_rad = angle, .gravity_m_s2 = rover.gravity_m_s2});
      const SimulatedWheelTable::Row row = table.at(slip, 1.0, -angle);
      EXPECT_NEAR(row.pull, wheel.drawbar_pull_N / load_N, 1e-6);
      EXPECT_NEAR(row.hold, -wheel.side_force_N / load_N, 1e-6);
      EXPECT_GT(row.hold, 0.0);
      EXPECT_EQ(row.hold, table.at(slip, 1.0, angle).hold);
    }
}

// Property: between nodes the table equals the forward model to 1 % of the load, away from slip 0.
TEST(SimulatedWheelTable, InterpolationMatchesTheForwardModelWithinOnePercent) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (double slip = 0.06; slip < 0.9; slip += 0.0713)
    for (double load = 0.3; load < 1.9; load += 0.083) {
      const double load_N = load * terramech::wheelLoad_N(rover);
      const auto wheel = terramech::equilibrium(testSand(), rover.wheel, {.load_N = load_N, .slip = slip});
      EXPECT_NEAR(table.at(slip, load).pull, wheel.drawbar_pull_N / load_N, 0.01) << slip << " " << load;
    }
}

// Closed form: rows are equidistant in slip and layers in load; slip beyond a locked wheel is clamped.
TEST(SimulatedWheelTable, NodesAreEquidistantAndEndsClamped) {
  EXPECT_EQ(SimulatedWheelTable::slip(0), -1.0);
  EXPECT_EQ(SimulatedWheelTable::slip(SimulatedWheelTable::kRows - 1), 1.0);
  EXPECT_NEAR(SimulatedWheelTable::load(SimulatedWheelTable::kLoads - 1), 1.9, 1e-12);
  const SimulatedWheelTable table(testSand(), testRover());
  EXPECT_EQ(table.at(1.7, 1.0).pull, table.row(SimulatedWheelTable::kRows - 1, 1.0).pull);
  EXPECT_EQ(table.at(-3.0, 1.0).torque, table.row(0, 1.0).torque);
}

// A soil without strength or stiffness carries no load: no pull at any slip.
TEST(SimulatedWheelTable, SoilWithoutBearingCapacityYieldsNoPull) {
  terramech::Soil mud = testSand();
  mud.cohesive_modulus = 0.0;
  mud.frictional_modulus = 10.0;
  const SimulatedWheelTable table(mud, testRover());
  for (const double slip : {0.1, 0.5, 0.9}) EXPECT_LE(table.at(slip, 1.0).pull, 0.0) << slip;
}

}  // namespace simulated_wheel_table_test
}  // namespace talus::planner
