#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/maps/geodesy/transform.hpp>

namespace talus::maps {
namespace plain_projection_test {

// Clarke 1866 with the e^2 of snyder1987's examples.
const Ellipsoid kClarke{6378206.4, 1 - std::sqrt(1 - 0.00676866)};

Point project(const Ellipsoid& e, const Projection& p, double latitude_deg, double longitude_deg) {
  return makePlainTransform(e, p)->forward({latitude_deg * kDegree, longitude_deg * kDegree});
}

// Printed in: snyder1987, appendix A, numerical examples; to the tenth of a metre that they print. Longitudes
// are from the central meridian.
TEST(PlainProjection, SnydersExamples) {
  const Point stereographic = project(
      kClarke,
      {.method = ProjectionMethod::Stereographic, .latitude_of_origin_rad = 40 * kDegree, .scale = 0.9999},
      30, 10);
  EXPECT_NEAR(stereographic.x_m, 971630.8, 0.1);
  EXPECT_NEAR(stereographic.y_m, -1063049.3, 0.1);
  const Point lambert =
      project(kClarke,
              {.method = ProjectionMethod::LambertAzimuthalEqualArea, .latitude_of_origin_rad = 40 * kDegree},
              30, -10);
  EXPECT_NEAR(lambert.x_m, -965932.1, 0.1);
  EXPECT_NEAR(lambert.y_m, -1056814.9, 0.1);
  const Point sinusoidal = project(kClarke, {.method = ProjectionMethod::Sinusoidal}, -50, 15);
  EXPECT_NEAR(sinusoidal.x_m, 1075471.5, 0.1);
  EXPECT_NEAR(sinusoidal.y_m, -5540628.0, 0.1);
  const Point orthographic =
      project({1.0, 0.0}, {.method = ProjectionMethod::Orthographic, .latitude_of_origin_rad = 40 * kDegree},
              30, -10);
  EXPECT_NEAR(orthographic.x_m, -0.1503837, 1e-7);
  EXPECT_NEAR(orthographic.y_m, -0.1651911, 1e-7);
}

TEST(PlainProjection, EquirectangularIsTrueAlongItsParallel) {
  // Closed form: x = R cos(phi_1) lambda, y = R (phi - phi_0).
  const Point p = project({100.0, 0.01},
                          {.method = ProjectionMethod::Equirectangular,
                           .latitude_of_origin_rad = 0.1,
                           .standard_parallel_1_rad = 60 * kDegree},
                          45, 30);
  EXPECT_NEAR(p.x_m, 50 * 30 * kDegree, 1e-12);
  EXPECT_NEAR(p.y_m, 100 * (45 * kDegree - 0.1), 1e-12);
}

TEST(PlainProjection, TheOriginIsTheOriginAndBack) {
  for (ProjectionMethod method :
       {ProjectionMethod::Stereographic, ProjectionMethod::LambertAzimuthalEqualArea,
        ProjectionMethod::Orthographic})
    for (double latitude : {-1.2, 0.0, 0.7}) {
      const auto transform =
          makePlainTransform(kMars, {.method = method, .latitude_of_origin_rad = latitude});
      const Point p = transform->forward({latitude, 0.0});
      EXPECT_NEAR(std::hypot(p.x_m, p.y_m), 0.0, 1e-6);
      EXPECT_NEAR(transform->reverse({0.0, 0.0}).latitude_rad, latitude, 1e-14);
    }
}

TEST(PlainProjection, NotANumberBeyondTheEdgeOfTheMap) {
  const auto reverse = [](ProjectionMethod method, Point p) {
    return makePlainTransform(kMoon, {.method = method})->reverse(p).latitude_rad;
  };
  const double r = kMoon.equatorial_radius_m;
  EXPECT_TRUE(std::isnan(reverse(ProjectionMethod::Orthographic, {1.01 * r, 0})));
  EXPECT_TRUE(std::isnan(reverse(ProjectionMethod::LambertAzimuthalEqualArea, {0, 2.01 * r})));
  EXPECT_TRUE(std::isnan(reverse(ProjectionMethod::Sinusoidal, {0, 1.58 * r})));
  EXPECT_TRUE(std::isnan(reverse(ProjectionMethod::Equirectangular, {0, -1.58 * r})));
  EXPECT_FALSE(std::isnan(reverse(ProjectionMethod::Orthographic, {0.99 * r, 0})));
}

TEST(PlainProjection, OthersAreNotMadeHere) {
  EXPECT_EQ(makePlainTransform(kMars, {.method = ProjectionMethod::Mercator}), nullptr);
}

}  // namespace plain_projection_test
}  // namespace talus::maps
