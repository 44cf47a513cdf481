#include <talus/terramech/tables/estimate_soil.hpp>

#include "wheel_table.hpp"

namespace talus::terramech {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(EstimateSoil, ExactRowsGiveTheSoilThatMadeThem) {
  const WheelTable table;
  const SoilEstimate found =
      estimateSoil({.table = table.path(), .method = "wong-reece", .noise = 0.005}, {});
  EXPECT_EQ(found.rows_used, 12U);
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 150.0);
  EXPECT_NEAR(found.friction_angle_rad, kMadeSoil.friction_angle_rad, 0.02);
}

TEST(EstimateSoil, NamesThatAreNotOnOfferAreRefused) {
  const WheelTable table;
  EXPECT_THAT([&] { estimateSoil({.table = table.path(), .method = "wong-rece"}, {}); },
              ThrowsMessage<InputError>(HasSubstr("'wong-rece': is unknown; there are bevameter")));
  EXPECT_THAT(
      [&] { estimateSoil({.table = table.path(), .method = "iagnemma", .shear_modulus = "jointly"}, {}); },
      ThrowsMessage<InputError>(HasSubstr("'jointly': is unknown")));
}

}  // namespace
}  // namespace talus::terramech
