#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <tuple>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

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

namespace transform_test {

using enum ProjectionMethod;

constexpr Ellipsoid kSphere{1000.0, 0.0};
// A body flatter than any planet, so that use of a spherical formula is detected.
constexpr Ellipsoid kFlat{3396190.0, 0.05};

Projection projection(ProjectionMethod method) {
  return {.method = method,
          .latitude_of_origin_rad = method == PolarStereographic ? 0.0 : 35 * kDegree,
          .standard_parallel_1_rad = method == PolarStereographic ? 70 * kDegree : 30 * kDegree,
          .standard_parallel_2_rad = 50 * kDegree,
          .scale = 1.0};
}

// Map metres per metre of ground, east and north, from the radii of curvature of the ellipsoid.
struct Jacobian {
  Point east;
  Point north;
};

Jacobian jacobian(const Transform& t, const Ellipsoid& e, GeoPoint p) {
  const double e2 = e.flattening * (2 - e.flattening);
  const double w = 1 - e2 * std::pow(std::sin(p.latitude_rad), 2);
  const double meridian_m = e.equatorial_radius_m * (1 - e2) / std::pow(w, 1.5);
  const double parallel_m = e.equatorial_radius_m * std::cos(p.latitude_rad) / std::sqrt(w);
  constexpr double h = 1e-6;
  const Point e1 = t.forward({p.latitude_rad, p.longitude_rad + h});
  const Point e0 = t.forward({p.latitude_rad, p.longitude_rad - h});
  const Point n1 = t.forward({p.latitude_rad + h, p.longitude_rad});
  const Point n0 = t.forward({p.latitude_rad - h, p.longitude_rad});
  return {{(e1.x_m - e0.x_m) / (2 * h * parallel_m), (e1.y_m - e0.y_m) / (2 * h * parallel_m)},
          {(n1.x_m - n0.x_m) / (2 * h * meridian_m), (n1.y_m - n0.y_m) / (2 * h * meridian_m)}};
}

// Places within 25 degrees of the origin or of the pole.
std::vector<GeoPoint> places(ProjectionMethod method) {
  const double middle_deg = method == PolarStereographic ? 70 : 35;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> away(-15.0, 15.0);
  std::vector<GeoPoint> out(40);
  for (GeoPoint& p : out) p = {(middle_deg + away(random)) * kDegree, away(random) * kDegree};
  return out;
}

TEST(Transform, EveryProjectionRoundTrips) {
  for (ProjectionMethod method :
       {TransverseMercator, Mercator, Equirectangular, PolarStereographic, LambertConformalConic}) {
    const auto transform = makeTransform(kFlat, projection(method));
    for (const GeoPoint& p : places(method)) {
      const GeoPoint back = transform->reverse(transform->forward(p));
      EXPECT_NEAR(back.latitude_rad, p.latitude_rad, 1e-9) << static_cast<int>(method);
      EXPECT_NEAR(back.longitude_rad, p.longitude_rad, 1e-9) << static_cast<int>(method);
    }
  }
}

// Property: angles are preserved: the images of east and north are perpendicular and of equal length.
// Tolerance: difference quotients, 1e-6.
TEST(Transform, ConformalProjectionsPreserveAngles) {
  for (ProjectionMethod method : {TransverseMercator, Mercator, PolarStereographic, LambertConformalConic}) {
    const auto transform = makeTransform(kFlat, projection(method));
    for (const GeoPoint& p : places(method)) {
      const Jacobian j = jacobian(*transform, kFlat, p);
      EXPECT_NEAR(j.east.x_m, j.north.y_m, 1e-7) << static_cast<int>(method);
      EXPECT_NEAR(j.east.y_m, -j.north.x_m, 1e-7) << static_cast<int>(method);
    }
  }
}

TEST(Transform, ProjectionsMatchClosedFormsOnTheSphere) {
  const GeoPoint p{20 * kDegree, 12 * kDegree};
  const auto at = [&](const Projection& of) { return makeTransform(kSphere, of)->forward(p); };
  // Closed form: y = R ln tan(pi/4 + phi/2) on Mercator's map.
  EXPECT_NEAR(at({.method = Mercator}).y_m,
              1000 * std::log(std::tan(std::numbers::pi / 4 + p.latitude_rad / 2)), 1e-9);
  // Closed form: x = R artanh(cos(phi) sin(lambda)) of the transverse Mercator projection.
  EXPECT_NEAR(at({.method = TransverseMercator}).x_m,
              1000 * std::atanh(std::cos(p.latitude_rad) * std::sin(p.longitude_rad)), 1e-9);
}

// Property: a conic projection has unit scale along its standard parallels, on either hemisphere.
TEST(Transform, ConicHasUnitScaleOnItsStandardParallels) {
  for (const double half : {1.0, -1.0}) {
    const auto transform = makeTransform(kFlat, {.method = LambertConformalConic,
                                                 .latitude_of_origin_rad = half * 35 * kDegree,
                                                 .standard_parallel_1_rad = half * 30 * kDegree,
                                                 .standard_parallel_2_rad = half * 50 * kDegree});
    EXPECT_NEAR(transform->forward({half * 35 * kDegree, 0.0}).y_m, 0.0, 1e-6);
    for (const double parallel : {30.0, 50.0}) {
      const Jacobian j = jacobian(*transform, kFlat, {half * parallel * kDegree, 0.1});
      EXPECT_NEAR(std::hypot(j.east.x_m, j.east.y_m), 1.0, 1e-7) << half;
    }
  }
}

}  // namespace transform_test

}  // namespace talus::maps
