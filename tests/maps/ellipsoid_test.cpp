#include <cmath>

#include <talus/maps/ellipsoid.hpp>

namespace talus::maps {
namespace {

TEST(Ellipsoid, BodiesAreNamedByTheirRadius) {
  EXPECT_EQ(bodyName(kEarth), "Earth");
  EXPECT_EQ(bodyName(kMoon), "Moon");
  EXPECT_EQ(bodyName(kMars), "Mars");
  EXPECT_NE(bodyName({.equatorial_radius_m = 1.0e5}).find("100"), std::string::npos);
}

TEST(Ellipsoid, PlanetocentricLatitudeIsTheAngleAtTheCentre) {
  // Closed form: tan(planetocentric) = (1 - f)^2 tan(geographic). Tolerance: rounding.
  for (const double latitude : {-1.2, -0.3, 0.0, 0.08, 0.9}) {
    const double axes = 1.0 - kMars.flattening;
    EXPECT_NEAR(std::tan(planetocentricLatitude(kMars, latitude)), axes * axes * std::tan(latitude), 1e-14);
    EXPECT_NEAR(geographicLatitude(kMars, planetocentricLatitude(kMars, latitude)), latitude, 1e-15);
  }
}

TEST(Ellipsoid, OnASphereBothLatitudesAreOne) {
  EXPECT_NEAR(planetocentricLatitude(kMoon, 0.7), 0.7, 1e-15);
  EXPECT_NEAR(geographicLatitude(kMoon, -0.7), -0.7, 1e-15);
}

}  // namespace
}  // namespace talus::maps
