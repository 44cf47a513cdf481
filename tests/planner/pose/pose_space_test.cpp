#include <ompl/base/ScopedState.h>

#include <talus/planner/pose/pose_space.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_space_test {

TEST(PoseSpace, InterpolationFollowsTheShortestCurve) {
  const auto map = testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
  const MotionCost motion(map);
  for (const bool reverse : {true, false}) {
    const PoseCost cost(motion, {.turning_radius_m = 2.0, .may_reverse = reverse});
    const auto space = std::make_shared<PoseSpace>(cost);
    space->setup();
    ompl::base::ScopedState<PoseSpace> a(space), b(space), middle(space);
    PoseSpace::setPose(a.get(), {{5.0, 5.0}, 0.3});
    PoseSpace::setPose(b.get(), {{14.0, 9.0}, 2.0});
    const double whole = space->distance(a.get(), b.get());
    space->interpolate(a.get(), b.get(), 0.4, middle.get());
    // Property: the distance from a point on the shortest curve to the end is the length of the rest of the
    // curve.
    EXPECT_NEAR(space->distance(middle.get(), b.get()), 0.6 * whole, 1e-6);
    space->interpolate(a.get(), b.get(), 1.0, middle.get());
    EXPECT_NEAR(PoseSpace::pose(middle.get()).place.x_m, 14.0, 1e-9);
  }
}

}  // namespace pose_space_test
}  // namespace talus::planner
