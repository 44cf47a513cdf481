#include <talus/planner/field/remedy.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace remedy_test {

using testing::drawn;

TEST(Remedy, InvalidPlaceNamesItsFaultAndTheNearestTraversableCell) {
  const auto map = drawn({"..#?.", "..##."});
  EXPECT_EQ(invalidPlace(*map, "start", {2.6, 0.5}),
            "start 2.60,0.50 lies on a blocked cell; the nearest traversable cell is 1.50,0.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {3.9, 1.5}),
            "goal 3.90,1.50 lies on an unobserved cell; the nearest traversable cell is 4.50,1.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {9.0, 0.5}),
            "goal 9.00,0.50 lies outside the map; the nearest traversable cell is 4.50,0.50");
}

// Property: the message names the hazard in the cell, the hazard whose clearance covers the cell, or the
// rim, and offers a cell that is connected to the other end.
TEST(Remedy, InvalidPlaceNamesItsHazard) {
  using costmap::Hazard;
  const auto map = drawn({"######", "#..#.#", "#....#", "######"});
  const auto rocks = [](maps::Cell c) { return c == maps::Cell{3, 2} ? Hazard::Rocks : Hazard::Near; };
  EXPECT_EQ(invalidPlace(*map, "start", {3.5, 2.5}, {.hazards = rocks}),
            "start 3.50,2.50 lies on a blocked cell: rocks; the nearest traversable cell is 3.50,1.50");
  EXPECT_THAT(invalidPlace(*map, "start", {0.5, 0.5}, {.hazards = rocks}),
              ::testing::HasSubstr("too near to the rim of the map"));
  EXPECT_THAT(invalidPlace(*map, "goal", {4.5, 3.2}, {.hazards = rocks}),
              ::testing::HasSubstr("too near to rocks"));
  const auto west = [](maps::Cell c) { return c.column < 2; };
  EXPECT_EQ(invalidPlace(*map, "start", {3.5, 2.5}, {.hazards = rocks, .joined = west}),
            "start 3.50,2.50 lies on a blocked cell: rocks; the nearest traversable cell is 1.50,2.50, from "
            "which the goal "
            "can be reached");
}

TEST(Remedy, GoalIsValidWithinItsTolerance) {
  const MotionCost cost(drawn({"..#..", "..#.."}));
  EXPECT_TRUE(mayEnd(cost, {1.5, 0.5}, 0.0));
  EXPECT_FALSE(mayEnd(cost, {2.5, 0.5}, 0.4));
  EXPECT_TRUE(mayEnd(cost, {2.5, 0.5}, 0.6));
}

}  // namespace remedy_test
}  // namespace talus::planner
