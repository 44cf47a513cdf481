#include <talus/common/nearest_name.hpp>

namespace talus {
namespace nearest_name_test {

const std::vector<std::string> kKnown{"plan", "plugins", "explain", "estimate"};

TEST(EditDistance, CountsInsertedDeletedReplacedAndSwappedLetters) {
  // Closed form: one edit of each kind.
  EXPECT_EQ(editDistance("plan", "plan"), 0U);
  EXPECT_EQ(editDistance("plan", "plain"), 1U);
  EXPECT_EQ(editDistance("plan", "pan"), 1U);
  EXPECT_EQ(editDistance("plan", "plam"), 1U);
  EXPECT_EQ(editDistance("plan", "paln"), 1U);
  EXPECT_EQ(editDistance("", "plan"), 4U);
}

TEST(NearestName, FindsTheNameWithFewestEdits) {
  EXPECT_EQ(nearestName("plam", kKnown), "plan");
  EXPECT_EQ(nearestName("lpan", kKnown), "plan");
  EXPECT_EQ(nearestName("explan", kKnown), "explain");
}

TEST(NearestName, DistantNameYieldsNoSuggestion) {
  EXPECT_EQ(nearestName("calibrate", kKnown), "");
  EXPECT_EQ(nearestName("", kKnown), "");
  EXPECT_EQ(nearestName("plan", {}), "");
}

}  // namespace nearest_name_test
}  // namespace talus
