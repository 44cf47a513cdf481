#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/mobility/traversability_plane.hpp>

namespace talus::terramech {
namespace traversability_plane_test {

double eq321(double torque, double sinkage) {
  return torque - sinkage - 0.1;
}

const CategoryThresholds kFig312{.dp_low = std::tan(0.17453292519943295),
                                 .dp_high = std::tan(0.17453292519943295),
                                 .z_threshold = 0.5,
                                 .z_critical = 0.5};

TEST(TraversabilityPlane, CategoriesMatchThesisFigure312) {
  const TraversabilityPlane plane = traversabilityPlane(eq321, kFig312, {.columns = 40, .rows = 20});
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      // Printed in: thesis Fig. 3.12, one line of DP/W = tan 10 deg and one of z/r = 0.5.
      const bool pulls = plane.torqueAt(column) - plane.sinkageAt(row) - 0.1 > kFig312.dp_high;
      const bool shallow = plane.sinkageAt(row) < 0.5;
      EXPECT_EQ(plane.at(column, row), pulls && shallow ? Category::Safe : Category::Dangerous);
    }
}

TEST(TraversabilityPlane, ThesisExampleSoilsAreDangerousByEquation321) {
  // Printed in: thesis 3.5, pairs (0.1, 0.2) "dangerous" and (0.3, 0.4) "safe". Eq. 3.21 gives -0.2 for both;
  // the second pair cannot be reproduced.
  for (const auto& [torque, sinkage] : {std::pair{0.1, 0.2}, {0.3, 0.4}})
    EXPECT_EQ(categorise({.drawbar_pull_over_load = eq321(torque, sinkage), .sinkage_over_radius = sinkage},
                         kFig312),
              Category::Dangerous);
}

TEST(TraversabilityPlane, FindsTheBoundaryBetweenCategories) {
  EXPECT_NEAR(torqueForPull(eq321, 0.2, 0.3, 1.0), 0.6, 1e-12);  // Closed form.
  EXPECT_TRUE(std::isnan(torqueForPull(eq321, 0.9, 0.3, 1.0)));
}

TEST(TraversabilityPlane, EmptyPlaneIsRejected) {
  EXPECT_REFUSED(traversabilityPlane(eq321, kFig312, {.columns = 0}), std::invalid_argument,
                 "columns = 0, must be in [1, 10000]");
}

}  // namespace traversability_plane_test
}  // namespace talus::terramech
