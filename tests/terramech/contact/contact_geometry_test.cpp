#include <cmath>
#include <numbers>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/contact_geometry.hpp>

namespace talus::terramech {
namespace contact_geometry_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

TEST(ContactGeometry, EntryAngleIsArccosOfOneMinusSinkageOverRadius) {
  // Closed form: thesis text before Eq. 3.12 (corrected: arccos, not arctan).
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.05), std::numbers::pi / 3.0, 1e-15);
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.1), std::numbers::pi / 2.0, 1e-15);
  EXPECT_EQ(entryAngle_rad(kWheel, 0.0), 0.0);
}

TEST(ContactGeometry, EntryAngleIsAccurateAtSmallSinkage) {
  // Closed form: theta_1 = sqrt(2 z/r) (1 + z/(12 r) + ...); arccos(1 - z/r) is accurate to half of the
  // digits only.
  const double ratio = 1e-10;
  EXPECT_NEAR(entryAngle_rad(kWheel, ratio * 0.1) / std::sqrt(2.0 * ratio), 1.0 + ratio / 12.0, 1e-15);
}

TEST(ContactGeometry, SinkageInvertsEntryAngle) {
  // Property: sinkage and entry angle are inverse to each other.
  for (const double z : {1e-9, 1e-3, 0.03, 0.15}) {
    EXPECT_NEAR(sinkage_m(kWheel, entryAngle_rad(kWheel, z)), z, 1e-14 * (z + 1e-9));
  }
}

TEST(ContactGeometry, ChordIsTwiceRadiusTimesSineOfEntryAngle) {
  // Closed form: 2 r sin(theta_1).
  EXPECT_NEAR(contactChord_m(kWheel, 0.02), 0.2 * std::sin(entryAngle_rad(kWheel, 0.02)), 1e-16);
}

TEST(ContactGeometry, InvalidSinkageIsRejected) {
  EXPECT_REFUSED(entryAngle_rad(kWheel, -1e-6), std::invalid_argument,
                 "sinkage_m = -1e-06, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, 0.2), std::invalid_argument, "sinkage_m = 0.2, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, std::nan("")), std::invalid_argument,
                 "sinkage_m = nan, must be finite");
}

}  // namespace contact_geometry_test
}  // namespace talus::terramech
