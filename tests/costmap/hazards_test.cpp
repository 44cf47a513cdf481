#include <algorithm>

#include <site_fixture.hpp>

#include <costmap/hazards.hpp>

namespace talus::costmap {
namespace {

maps::Grid grid(int side, double resolution_m) {
  return {.width = side, .height = side, .resolution_m = resolution_m, .south_west = {}};
}

TEST(Inflate, KeepsHalfTheRoversWidthFromAKeepOutCell) {
  maps::Raster<Hazard> hazards(grid(11, 0.1), Hazard::None);
  hazards[{5, 5}] = Hazard::KeepOut;
  HazardLimits limits;
  limits.inflation_m = 0.2;
  inflate(hazards, limits);
  // Closed form: centres less than 0.2 m from the cell's edge: one and two cells away, not three (0.25 m).
  EXPECT_TRUE(has(hazards[{6, 5}], Hazard::Near));
  EXPECT_TRUE(has(hazards[{7, 5}], Hazard::Near));
  EXPECT_FALSE(has(hazards[{8, 5}], Hazard::Near));
  EXPECT_FALSE(has(hazards[{7, 7}], Hazard::Near));
  EXPECT_TRUE(has(hazards[{6, 6}], Hazard::Near));
}

TEST(Inflate, DoesNothingToCellsWiderThanTheRover) {
  maps::Raster<Hazard> hazards(grid(3, 5.0), Hazard::None);
  hazards[{1, 1}] = Hazard::Unknown;
  inflate(hazards, HazardLimits::of(testRover()));
  EXPECT_EQ(std::count(hazards.values().begin(), hazards.values().end(), Hazard::None), 8);
}

TEST(HazardLimits, ReliefOfALargeFootprintCountsInProportion) {
  const HazardLimits limits = HazardLimits::of(testRover());
  EXPECT_DOUBLE_EQ(reliefShare(limits, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(reliefShare(limits, 8.0), 0.1);  // Closed form: wheelbase 0.8 m over 8 m
}

}  // namespace
}  // namespace talus::costmap
