#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include <talus/common/constants.hpp>
#include <talus/maps/geodesy/georeference.hpp>

namespace talus::maps {
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
