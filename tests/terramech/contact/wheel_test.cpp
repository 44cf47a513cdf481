#include <cmath>
#include <stdexcept>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {
namespace wheel_test {

TEST(Wheel, SizesMustBePositiveAndGrousersAreOptional) {
  EXPECT_NO_THROW(validate(Wheel{}));
  EXPECT_NO_THROW(validate({.radius_m = 0.2, .width_m = 0.1, .grouser_height_m = 0.01, .grouser_count = 24}));
  for (const double bad : {0.0, -0.1, 1e-12, 1e14, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(validate({.radius_m = bad}), std::invalid_argument) << bad;
    EXPECT_THROW(validate({.width_m = bad}), std::invalid_argument) << bad;
  }
  EXPECT_THROW(validate({.grouser_height_m = -0.001}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_height_m = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_count = -1}), std::invalid_argument);
}

}  // namespace wheel_test
}  // namespace talus::terramech
