#include <talus/cli/app/number_check.hpp>

namespace talus::cli {
namespace {

TEST(NumberCheck, RefusesNaNInfinityAndWhatLiesOutside) {
  CLI::Validator slip = within(-1.0, 1.0);
  for (std::string good : {"-1", "0", "0.999", "1"}) EXPECT_EQ(slip(good), "");
  for (std::string bad : {"1.001", "nan", "-inf", "abc", ""}) EXPECT_NE(slip(bad), "");
  std::string two = "2";
  EXPECT_EQ(slip(two), "2, must be -1 to 1");
}

TEST(NumberCheck, EndsThatDoNotBind) {
  std::string minus = "-3";
  std::string none = "nan";
  EXPECT_EQ(finite()(minus), "");
  EXPECT_EQ(notNegative()(minus), "-3, must be finite, >= 0");
  for (std::string bad : {"0", "-1", "nan", "inf", "x"})
    EXPECT_EQ(positive()(bad), bad + ", must be finite, > 0");
  std::string little = "1e-300";
  EXPECT_EQ(positive()(little), "");
  EXPECT_EQ(finite()(none), "nan, must be a finite number");
}

}  // namespace
}  // namespace talus::cli
