#include <talus/planner/simulation/worlds/ruts.hpp>

namespace talus::planner {
namespace ruts_test {

TEST(Ruts, WheelIsNotInItsOwnRut) {
  Ruts ruts(0.1);
  for (double x = 0.05; x < 1.0; x += 0.02) {
    EXPECT_EQ(ruts.passes({x, 0.0}), 0) << x;
    ruts.press({x, 0.0});
    ruts.moved(0.02);
  }
  EXPECT_EQ(ruts.passes({0.05, 0.0}), 1);
  EXPECT_EQ(ruts.passes({0.05, 0.3}), 0);
}

TEST(Ruts, PassesAreCountedPerWheel) {
  Ruts ruts(0.1);
  for (int wheel = 0; wheel < 3; ++wheel) {
    EXPECT_EQ(ruts.passes({0.05, 0.05}), wheel);
    ruts.press({0.05, 0.05});
    EXPECT_EQ(ruts.passes({0.05, 0.05}), wheel) << "it stands there now";
    ruts.moved(0.5);
  }
}

TEST(Ruts, ReversingRoverIsInItsRut) {
  Ruts ruts(0.1);
  ruts.press({0.05, 0.05});
  EXPECT_EQ(ruts.passes({0.05, 0.05}), 0);
  ruts.turnBack();
  EXPECT_EQ(ruts.passes({0.05, 0.05}), 1);
}

TEST(Ruts, NegativeCoordinatesAreSupported) {
  Ruts ruts(0.1);
  ruts.press({-0.05, -123.45});
  ruts.turnBack();
  EXPECT_EQ(ruts.passes({-0.05, -123.45}), 1);
  EXPECT_EQ(ruts.passes({0.05, -123.45}), 0);
}

}  // namespace ruts_test
}  // namespace talus::planner
