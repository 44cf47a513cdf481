#include <cmath>

#include <gmock/gmock.h>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace dune_field_test {

TEST(DuneField, SlipFacesHaveTheAngleOfRepose) {
  const DuneField dunes({.seed = 3, .wavelength_m = 60, .height_m = 4, .repose_rad = 0.576, .wind_rad = 0.0});
  int faces = 0;
  for (double y = 0; y < 600; y += 7)
    for (double x = 0; x < 600; x += 0.5) {
      const Sand here = dunes.at(x, y);
      const Sand there = dunes.at(x + 0.05, y);
      if (!here.slip_face || !there.slip_face) continue;
      ++faces;
      // Closed form: along the wind the slope of a slip face is the angle of repose.
      ASSERT_NEAR(std::atan((here.height_m - there.height_m) / 0.05), 0.576, 1e-6);
    }
  EXPECT_GT(faces, 500);
}

TEST(DuneField, SurfaceIsContinuous) {
  const DuneField dunes({.seed = 4});
  for (double y = 0; y < 300; y += 3.1)
    for (double x = 0; x < 300; x += 0.1)
      ASSERT_LT(std::abs(dunes.at(x + 0.1, y).height_m - dunes.at(x, y).height_m), 0.12) << x << "," << y;
}

}  // namespace dune_field_test
}  // namespace talus::maps
