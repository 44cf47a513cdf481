#include <cmath>
#include <numeric>

#include <talus/planner/refine/short_cut.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using testing::drawn;
using testing::randomMap;

TEST(ShortCut, DropsIdleTurns) {
  const MotionCost cost(drawn({".....", ".#...", "....."}));
  const auto route = withoutIdleTurns(cost, {{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}, {2.5, 2.5}});
  EXPECT_EQ(route.size(), 3U);
}

}  // namespace
}  // namespace talus::planner
