#include <talus/cli/app/number_check.hpp>
#include <talus/talus.hpp>

namespace talus::cli {
namespace {

TEST(NumberCheck, RefusesNaNInfinityAndWhatLiesOutside) {
  CLI::Validator slip = within(-1.0, 1.0);
  for (std::string good : {"-1", "0", "0.999", "1"}) EXPECT_EQ(slip(good), "");
  for (std::string bad : {"1.001", "nan", "-inf", "abc", ""}) EXPECT_NE(slip(bad), "");
  std::string two = "2";
  EXPECT_EQ(slip(two), "2, must be -1 to 1");
}

// Whatever the option, and also where a test of its range lets NaN pass.
TEST(NumberCheck, NoOptionTakesAnImpossibleNumber) {
  const auto said = [](const std::string& word) -> std::string {
    CLI::App app;
    std::string value;
    app.add_option("--risk", value);
    app.parse("--risk=" + word);
    try {
      checkNumbers(app);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  for (const char* bad :
       {"nan", "-nan", "NaN", "inf", "-Infinity", "1e999", "1e-300", "1e300", "5,nan", "nand,3d"})
    EXPECT_THAT(said(bad), testing::HasSubstr("--risk ")) << bad;
  for (const char* other : {"0x10", "-0X1p3", "010", "5,0x10", "-007"})
    EXPECT_THAT(said(other), testing::HasSubstr("must be decimal")) << other;
  for (const char* good : {"0.10", "0xfile", "00.tif", "0", "0.5", "-3", "18446744073709551615", "x.tif",
                           "nano.tif", "./nan", "3d,4d", "1e-9"})
    EXPECT_EQ(said(good), "") << good;
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
