#include <cmath>

#include <talus/planner/refine/close_vertices.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace close_vertices_test {

TEST(CloseVertices, VerticesCloserThanAHundredthOfACellAreMerged) {
  const auto map = testing::drawn({".....", ".....", "....."});
  const MotionCost cost(map);
  const Polyline kept =
      withoutCloseVertices(cost, {{0.5, 0.5}, {2.5, 1.5}, {2.5 + 1e-8, 1.5}, {2.505, 1.5}, {4.5, 0.5}});
  EXPECT_EQ(kept.size(), 3U);
  const Polyline ends = withoutCloseVertices(cost, {{0.5, 0.5}, {0.501, 0.5}, {4.499, 0.5}, {4.5, 0.5}});
  EXPECT_EQ(ends, (Polyline{{0.5, 0.5}, {4.5, 0.5}}));
}

// Property: a vertex at the corner of a wall is not moved into the wall.
TEST(CloseVertices, MergedRouteIsValid) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto map =
        testing::randomMap({.width = 6, .height = 6, .seed = seed, .blocked = 0.2, .roughness = 0.3});
    const MotionCost cost(map);
    Polyline way{{0.5, 0.5}, {2.5, 2.5}, {2.504, 2.503}, {4.5, 3.5}, {4.5, 3.505}, {5.5, 5.5}};
    if (!std::isfinite(cost.along(way))) continue;
    const Polyline kept = withoutCloseVertices(cost, way);
    EXPECT_TRUE(std::isfinite(cost.along(kept)));
    EXPECT_EQ(kept.front(), way.front());
    EXPECT_EQ(kept.back(), way.back());
  }
}

}  // namespace close_vertices_test
}  // namespace talus::planner
