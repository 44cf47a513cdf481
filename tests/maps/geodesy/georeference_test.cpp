#include <cmath>
#include <numbers>
#include <stdexcept>

#include <refused.hpp>

#include <talus/common/constants.hpp>
#include <talus/maps/geodesy/georeference.hpp>

namespace talus::maps {
namespace georeference_test {

CoordinateSystem lunarPole() {
  return {.name = "lunar south pole",
          .ellipsoid = kMoon,
          .projection = {.method = ProjectionMethod::PolarStereographic,
                         .standard_parallel_1_rad = -std::numbers::pi / 2}};
}

TEST(Georeference, PolarStereographicMatchesClosedForm) {
  // Closed form: rho = 2 R tan(colatitude / 2).
  const Georeference georeference(lunarPole());
  const Point p = georeference.forward({-85 * kDegree, 30 * kDegree});
  const double rho = 2 * kMoon.equatorial_radius_m * std::tan(2.5 * kDegree);
  EXPECT_NEAR(p.x_m, rho * std::sin(30 * kDegree), 1e-6);
  EXPECT_NEAR(p.y_m, rho * std::cos(30 * kDegree), 1e-6);
}

TEST(Georeference, EquirectangularHasUnitScaleOnItsStandardParallel) {
  // Closed form: one map metre is one metre of ground, eastwards on the parallel of 30 degrees, northwards
  // everywhere.
  const Georeference georeference(
      {.name = "mars",
       .ellipsoid = {3396190.0, 0.0},
       .projection = {.method = ProjectionMethod::Equirectangular, .standard_parallel_1_rad = 30 * kDegree}});
  const Point scale = georeference.groundScale(georeference.forward({30 * kDegree, 137 * kDegree}));
  EXPECT_NEAR(scale.x_m, 1.0, 1e-9);
  EXPECT_NEAR(scale.y_m, 1.0, 1e-9);
}

TEST(Georeference, ReverseConvertsPlanetocentricLatitudes) {
  // Closed form: tan(planetocentric) = (b / a)^2 tan(geographic).
  CoordinateSystem system{.name = "Mars / Ocentric",
                          .ellipsoid = kMars,
                          .projection = {.method = ProjectionMethod::TransverseMercator}};
  const Georeference geographic(system);
  system.planetocentric = true;
  const Georeference planetocentric(system);
  const Point p = geographic.forward({40 * kDegree, 0.01});
  const double expected = std::atan(std::pow(3376200.0 / 3396190.0, 2) * std::tan(40 * kDegree));
  EXPECT_NEAR(planetocentric.reverse(p).latitude_rad, expected, 1e-12);
  EXPECT_NEAR(planetocentric.forward({expected, 0.01}).y_m, p.y_m, 1e-6);
}

TEST(Georeference, DistanceIsMeasuredOnTheEllipsoid) {
  // Closed form: a quarter of the Moon's meridian, pole to equator.
  const Georeference georeference(lunarPole());
  const Point equator = georeference.forward({0.0, 0.0});
  EXPECT_NEAR(georeference.distance_m({0, 0}, equator), kMoon.equatorial_radius_m * std::numbers::pi / 2,
              1e-3);
}

TEST(Georeference, PointsOutsideTheProjectionAreNan) {
  const Georeference plate(
      {.name = "plate", .ellipsoid = kMoon, .projection = {.method = ProjectionMethod::Equirectangular}});
  EXPECT_TRUE(std::isnan(plate.reverse({0, 3e6}).latitude_rad));
  EXPECT_TRUE(std::isnan(plate.forward({2.0, 0.0}).x_m));
}

// Property: without PROJ a map in another projection has metric coordinates only.
TEST(Georeference, UnsupportedSystemHasNoGeographicCoordinates) {
  const Georeference swiss(
      {.name = "LV03", .ellipsoid = kEarth, .projection = {.method = ProjectionMethod::Foreign}, .wkt = "A"});
  EXPECT_FALSE(swiss.reachesPlaces());
  EXPECT_EQ(swiss.system().wkt, "A");
  EXPECT_TRUE(std::isnan(swiss.reverse({600000, 200000}).latitude_rad));
  EXPECT_TRUE(std::isnan(swiss.forward({0.8, 0.1}).x_m));
  EXPECT_TRUE(std::isnan(swiss.distance_m({0, 0}, {1, 0})));
}

TEST(Georeference, ParametersOutOfRangeAreRejected) {
  CoordinateSystem system = lunarPole();
  system.projection.scale = 0.0;
  EXPECT_REFUSED(Georeference{system}, std::invalid_argument, "scale must be > 0");
  system = lunarPole();
  system.ellipsoid.flattening = 1.0;
  EXPECT_REFUSED(Georeference{system}, std::invalid_argument, "flattening must be in [0, 1)");
}

}  // namespace georeference_test
}  // namespace talus::maps
