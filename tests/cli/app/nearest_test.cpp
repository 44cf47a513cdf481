#include <talus/cli/app/nearest.hpp>

namespace talus::cli {
namespace {

const std::vector<std::string> kKnown{"plan", "plugins", "explain", "estimate"};

TEST(Nearest, FindsTheWordWithFewestEdits) {
  EXPECT_EQ(nearest("plam", kKnown), "plan");
  EXPECT_EQ(nearest("lpan", kKnown), "plan");  // neighbours swapped count once
  EXPECT_EQ(nearest("explan", kKnown), "explain");
}

TEST(Nearest, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest("calibrate", kKnown), "");
  EXPECT_EQ(nearest("", kKnown), "");
  EXPECT_EQ(nearest("plan", {}), "");
}

}  // namespace
}  // namespace talus::cli
