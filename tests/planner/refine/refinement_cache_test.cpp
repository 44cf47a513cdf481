#include <gtest/gtest.h>

#include <talus/planner/refine/refinement_cache.hpp>

namespace talus::planner {
namespace refinement_cache_test {

const Polyline kWindow{{0.0, 0.0}, {10.0, 4.0}}, kResult{{0.0, 0.0}, {5.0, 1.0}, {10.0, 4.0}};

TEST(RefinementCache, WindowIsFoundOnlyForIdenticalPoints) {
  RefinementCache cache;
  EXPECT_FALSE(cache.find(kWindow));
  cache.keep(kWindow, kResult, 1.0);
  EXPECT_EQ(cache.find(kWindow), kResult);
  Polyline other = kWindow;
  other[1].y_m = std::nextafter(4.0, 5.0);
  EXPECT_FALSE(cache.find(other));
  cache.keep(kWindow, kWindow, 1.0);  // a second result replaces the first
  EXPECT_EQ(cache.find(kWindow), kWindow);
  cache.clear();
  EXPECT_FALSE(cache.find(kWindow));
}

// Closed form: the window's box, 0 to 10 by 0 to 4 m, grown by a reach of 2 m; corners in any order.
TEST(RefinementCache, WindowsNearChangedGroundAreDropped) {
  struct Case {
    Segment corners;
    bool forgotten;
  };
  for (const Case& c : {Case{{{12.1, 0.0}, {20.0, 4.0}}, false},
                        {{{20.0, 4.0}, {11.9, 0.0}}, true},
                        {{{-9.0, -9.0}, {20.0, -2.1}}, false},
                        {{{4.0, 6.1}, {5.0, 9.0}}, false},
                        {{{4.0, 9.0}, {5.0, 5.9}}, true},
                        {{{-99.0, -99.0}, {99.0, 99.0}}, true}}) {
    RefinementCache cache;
    cache.keep(kWindow, kResult, 2.0);
    cache.forget(c.corners);
    EXPECT_EQ(!cache.find(kWindow), c.forgotten) << c.corners.from.x_m << "," << c.corners.from.y_m;
  }
}

TEST(RefinementCache, UnusedEntriesAreDropped) {
  RefinementCache cache;
  cache.keep(kWindow, kResult, 1.0);
  for (int round = 0; round < 3; ++round) {
    cache.newRound();
    EXPECT_TRUE(cache.find(kWindow)) << round;
  }
  cache.newRound();
  cache.newRound();
  EXPECT_FALSE(cache.find(kWindow));
}

}  // namespace refinement_cache_test
}  // namespace talus::planner
