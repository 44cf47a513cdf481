#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace range_test {

std::string refusal(const std::function<void(const RangeCheck&)>& check) {
  try {
    check(RangeCheck{"rover 'A'"});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Range, ErrorNamesOwnerFieldValueAndBound) {
  EXPECT_EQ(refusal([](auto& c) { c.atLeast("mass_kg", -0.5, 0.0); }),
            "rover 'A': mass_kg = -0.5, must be >= 0");
  EXPECT_EQ(refusal([](auto& c) { c.above("mass_kg", 0.0, 0.0); }), "rover 'A': mass_kg = 0, must be > 0");
  EXPECT_EQ(refusal([](auto& c) {
              c.within("slip", 1.5, {-1.0, 1.0});
            }),
            "rover 'A': slip = 1.5, must be in [-1, 1]");
}

TEST(Range, BoundsAreInclusiveExceptAbove) {
  EXPECT_EQ(refusal([](auto& c) { c.atLeast("x", 2.0, 2.0); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.within("x", -1.0, {-1.0, 1.0}); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.within("x", 1.0, {-1.0, 1.0}); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.above("x", 2.0 + 1e-15, 2.0); }), "accepted");
  EXPECT_NE(refusal([](auto& c) { c.within("x", -1.1, {-1.0, 1.0}); }), "accepted");
}

TEST(Range, NonFiniteValuesAreRejectedByEveryCheck) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal([&](auto& c) { c.finite("x", value); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) { c.atLeast("x", value, 0.0); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) { c.above("x", value, 0.0); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) {
                  c.within("x", value, {0.0, 1.0});
                }),
                testing::EndsWith("must be finite"));
  }
}

}  // namespace range_test
}  // namespace talus::terramech
