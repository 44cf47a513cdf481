#include <talus/terramech/calibration/tables/no_soil.hpp>

#include "requirement.hpp"

namespace talus::terramech {
namespace no_soil_test {

using testing::HasSubstr;

constexpr double kNone = RunningSoil::kNan;

// Two rows with measured pull and side force.
SoilAnswer answer(double side, double predicted_side, double misfit) {
  SoilAnswer a{.measured = Eigen::MatrixXd::Constant(2, kChannels, kNone),
               .predicted = Eigen::MatrixXd::Constant(2, kChannels, 0.2),
               .misfit = misfit};
  a.measured.col(static_cast<int>(Channel::DrawbarPull)).setConstant(0.21);
  a.measured.col(static_cast<int>(Channel::SideForce)).setConstant(side);
  a.predicted.col(static_cast<int>(Channel::SideForce)).setConstant(predicted_side);
  return a;
}

SoilEstimate sand() {
  SoilEstimate e;
  e.cohesion_Pa = 500.0;
  e.friction_angle_rad = 0.55;
  e.tan_friction = 0.613;
  e.covariance = Eigen::Vector2d(1e4, 1e-4).asDiagonal();
  return e;
}

// Closed form: with constant columns the unexplained share is |y - f| / |y|.
TEST(NoSoil, ColumnWithMoreThanHalfUnexplainedIsNamed) {
  const UnexplainedColumn worst = unexplained(answer(1.0, 0.4, 10.0));
  EXPECT_EQ(worst.column, "side_force_N");
  EXPECT_NEAR(worst.left, 0.6, 1e-12);
  EXPECT_EQ(unexplained(answer(1.0, 0.6, 10.0)).column, "");
  EXPECT_EQ(unexplained(answer(0.09, 0.0, 10.0)).column, "") << "little of the load";
}

TEST(NoSoil, ZeroReadingWithNonZeroPredictionIsUnexplained) {
  EXPECT_TRUE(leavesUnexplained(answer(0.0, 0.3, 10.0), Channel::SideForce));
  EXPECT_FALSE(leavesUnexplained(answer(0.0, 0.09, 10.0), Channel::SideForce));
  EXPECT_FALSE(leavesUnexplained(answer(0.0, 0.3, 10.0), Channel::DrawbarPull));
  EXPECT_FALSE(leavesUnexplained(answer(0.0, 0.3, 10.0), Channel::Torque)) << "not measured";
  EXPECT_THAT(noSoilExplains(sand(), answer(0.0, 0.3, 10.0)), HasSubstr("has a side_force_N that reads 0"));
}

TEST(NoSoil, ReasonIsGivenOnlyForLargeMisfit) {
  EXPECT_THAT(noSoilExplains(sand(), answer(1.0, 0.4, 10.0)), HasSubstr("leaves 60 % of side_force_N"));
  EXPECT_EQ(noSoilExplains(sand(), answer(1.0, 0.4, 2.9)), "") << "within the stated noise";
  EXPECT_EQ(noSoilExplains(sand(), answer(1.0, 0.9, 10.0)), "") << "a warning does";
}

TEST(NoSoil, ImplausibleFrictionAngleIsRejectedAtAnyMisfit) {
  SoilEstimate steel = sand();
  steel.friction_angle_rad = 1.2;
  steel.tan_friction = 2.57;
  EXPECT_THAT(noSoilExplains(steel, answer(1.0, 0.9, 10.0)), HasSubstr("a friction angle of 69 deg"));
  EXPECT_THAT(noSoilExplains(steel, answer(1.0, 0.9, 1.0)), HasSubstr("a friction angle of 69 deg"))
      << "however near it comes";
}

}  // namespace no_soil_test
}  // namespace talus::terramech
