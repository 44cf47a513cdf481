#include <cmath>

#include <talus/maps/geodesy/georeference.hpp>

namespace talus::maps {
namespace ellipsoid_test {

TEST(Ellipsoid, BodyNameFollowsFromTheRadius) {
  EXPECT_EQ(bodyName(kEarth), "Earth");
  EXPECT_EQ(bodyName(kMoon), "Moon");
  EXPECT_EQ(bodyName(kMars), "Mars");
  // HiRISE maps use a sphere with the radius of Mars at their latitude.
  EXPECT_EQ(bodyName({3376234.0, 0.0}), "Mars");
  EXPECT_EQ(bodyName({255000.0, 0.0}), "Vesta");
  EXPECT_EQ(bodyName({11267.0, 0.0}), "body of radius 11.3 km");
}

TEST(Ellipsoid, PlanetocentricLatitudeMatchesClosedForm) {
  // Closed form: tan(planetocentric) = (1 - f)^2 tan(geographic). Tolerance: rounding.
  for (const double latitude : {-1.2, -0.3, 0.0, 0.08, 0.9}) {
    const double axes = 1.0 - kMars.flattening;
    EXPECT_NEAR(std::tan(planetocentricLatitude(kMars, latitude)), axes * axes * std::tan(latitude), 1e-14);
    EXPECT_NEAR(geographicLatitude(kMars, planetocentricLatitude(kMars, latitude)), latitude, 1e-15);
  }
}

TEST(Ellipsoid, LatitudesAreEqualOnASphere) {
  EXPECT_NEAR(planetocentricLatitude(kMoon, 0.7), 0.7, 1e-15);
  EXPECT_NEAR(geographicLatitude(kMoon, -0.7), -0.7, 1e-15);
}

}  // namespace ellipsoid_test
}  // namespace talus::maps
