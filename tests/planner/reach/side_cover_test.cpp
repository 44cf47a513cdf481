#include <gtest/gtest.h>

#include <talus/planner/reach/side_cover.hpp>

namespace talus::planner {
namespace side_cover_test {

// Closed form: the remainder of a range after two sections are covered.
TEST(SideCover, EachPartIsReturnedOnce) {
  SideCover cover;
  EXPECT_EQ(cover.added({0.2, 0.4}, 0.0).size(), 1U);
  EXPECT_EQ(cover.added({0.6, 0.7}, 0.0).size(), 1U);
  const auto rest = cover.added({0.1, 0.65}, 0.0);
  ASSERT_EQ(rest.size(), 2U);
  EXPECT_DOUBLE_EQ(rest[0].from, 0.1);
  EXPECT_DOUBLE_EQ(rest[0].to, 0.2);
  EXPECT_DOUBLE_EQ(rest[1].from, 0.4);
  EXPECT_DOUBLE_EQ(rest[1].to, 0.6);
  EXPECT_TRUE(cover.added({0.1, 0.7}, 0.0).empty());
  EXPECT_EQ(cover.added({0.0, 1.0}, 0.0).size(), 2U);
  EXPECT_TRUE(cover.added({0.0, 1.0}, 0.0).empty());
}

// Property: increments below the threshold are returned together once their sum exceeds the threshold.
TEST(SideCover, SmallIncrementsAreReturnedOnceTheyAddUp) {
  SideCover cover;
  EXPECT_EQ(cover.added({0.2, 0.4}, 0.05).size(), 1U);
  EXPECT_TRUE(cover.added({0.2, 0.43}, 0.05).empty());
  const auto rest = cover.added({0.2, 0.46}, 0.05);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_DOUBLE_EQ(rest[0].from, 0.4);
}

}  // namespace side_cover_test
}  // namespace talus::planner
