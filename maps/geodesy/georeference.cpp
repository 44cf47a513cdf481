#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

namespace talus::maps {
namespace {

// Adapter for GeographicLib's projections with the interface Forward(lon0, lat, lon, x, y), which uses
// degrees and its own origin of y. Subtracts the y of the latitude of origin.
template <typename Engine>
class FromEngine final : public Transform {
 public:
  FromEngine(Engine engine, double latitude_of_origin_rad) : engine_(std::move(engine)) {
    origin_y_m_ = forward({latitude_of_origin_rad, 0.0}).y_m;
  }

  Point forward(GeoPoint p) const override {
    Point out;
    engine_.Forward(0.0, p.latitude_rad / kDegree, p.longitude_rad / kDegree, out.x_m, out.y_m);
    out.y_m -= origin_y_m_;
    return out;
  }

  GeoPoint reverse(Point p) const override {
    double latitude = 0;
    double longitude = 0;
    engine_.Reverse(0.0, p.x_m, p.y_m + origin_y_m_, latitude, longitude);
    return {latitude * kDegree, longitude * kDegree};
  }

 private:
  Engine engine_;
  double origin_y_m_ = 0.0;
};

class PolarStereographic final : public Transform {
 public:
  PolarStereographic(const Ellipsoid& e, const Projection& p)
      : engine_(e.equatorial_radius_m, e.flattening, p.scale), north_(p.standard_parallel_1_rad > 0) {
    engine_.SetScale(std::abs(p.standard_parallel_1_rad) / kDegree, p.scale);
  }

  Point forward(GeoPoint p) const override {
    Point out;
    engine_.Forward(north_, p.latitude_rad / kDegree, p.longitude_rad / kDegree, out.x_m, out.y_m);
    return out;
  }

  GeoPoint reverse(Point p) const override {
    double latitude = 0;
    double longitude = 0;
    engine_.Reverse(north_, p.x_m, p.y_m, latitude, longitude);
    return {latitude * kDegree, longitude * kDegree};
  }

 private:
  GeographicLib::PolarStereographic engine_;
  bool north_;
};

// PROJ's eqc, spherical also on an ellipsoid: x = a cos(phi_1) lambda, y = a (phi - phi_0).
class Equirectangular final : public Transform {
 public:
  Equirectangular(const Ellipsoid& e, const Projection& p)
      : radius_m_(e.equatorial_radius_m),
        parallel_radius_m_(radius_m_ * std::cos(p.standard_parallel_1_rad)),
        origin_rad_(p.latitude_of_origin_rad) {}

  Point forward(GeoPoint p) const override {
    return {parallel_radius_m_ * p.longitude_rad, radius_m_ * (p.latitude_rad - origin_rad_)};
  }

  GeoPoint reverse(Point p) const override {
    const double latitude = p.y_m / radius_m_ + origin_rad_;
    if (!(std::abs(latitude) <= std::numbers::pi / 2)) return {kNaN, kNaN};
    return {latitude, p.x_m / parallel_radius_m_};
  }

 private:
  double radius_m_;
  double parallel_radius_m_;
  double origin_rad_;
};

template <typename Engine>
std::unique_ptr<const Transform> fromEngine(Engine engine, double latitude_of_origin_rad) {
  return std::make_unique<FromEngine<Engine>>(std::move(engine), latitude_of_origin_rad);
}

// Scale factor at the equator of a cylindrical projection with a standard parallel phi_1 and scale k there: k
// cos(phi_1) / sqrt(1 - e^2 sin^2(phi_1)).
double equatorScale(const Ellipsoid& e, const Projection& p) {
  const double sine = std::sin(p.standard_parallel_1_rad);
  const double e2 = e.flattening * (2 - e.flattening);
  return p.scale * std::cos(p.standard_parallel_1_rad) / std::sqrt(1 - e2 * sine * sine);
}

}  // namespace

std::unique_ptr<const Transform> makeTransform(const Ellipsoid& e, const Projection& p) {
  using enum ProjectionMethod;
  const double a = e.equatorial_radius_m;
  const double f = e.flattening;
  const double parallel_1 = p.standard_parallel_1_rad / kDegree;
  const double parallel_2 = p.standard_parallel_2_rad / kDegree;
  switch (p.method) {
    case TransverseMercator:
      return fromEngine(GeographicLib::TransverseMercator(a, f, p.scale), p.latitude_of_origin_rad);
    case Mercator:
      // The Mercator projection is the Lambert conformal conic with its standard parallel at the equator.
      return fromEngine(GeographicLib::LambertConformalConic(a, f, 0.0, equatorScale(e, p)),
                        p.latitude_of_origin_rad);
    case LambertConformalConic:
      return fromEngine(GeographicLib::LambertConformalConic(a, f, parallel_1, parallel_2, p.scale),
                        p.latitude_of_origin_rad);
    case PolarStereographic:
      return std::make_unique<talus::maps::PolarStereographic>(e, p);
    case Equirectangular:
      return std::make_unique<talus::maps::Equirectangular>(e, p);
    default:
      return nullptr;
  }
}

namespace {

struct Body {
  const char* name;
  double least_radius_m;  ///< slightly below the polar radius, because maps use spheres of the local radius
  double greatest_radius_m;
};

constexpr std::array<Body, 8> kBodies{{{"Earth", 6.35e6, 6.40e6},
                                       {"Venus", 6.045e6, 6.056e6},
                                       {"Mars", 3.37e6, 3.40e6},
                                       {"Titan", 2.570e6, 2.580e6},
                                       {"Mercury", 2.435e6, 2.445e6},
                                       {"Moon", 1.735e6, 1.739e6},
                                       {"Ceres", 4.4e5, 4.9e5},
                                       {"Vesta", 2.2e5, 2.9e5}}};

// Squared ratio of the semi-axes: (b / a)^2 = (1 - f)^2 = 1 - e^2.
double squaredAxisRatio(const Ellipsoid& e) {
  return (1 - e.flattening) * (1 - e.flattening);
}

// atan(factor tan(latitude)); latitudes of +-pi/2 are unchanged.
double withScaledTangent(double latitude_rad, double factor) {
  return std::atan2(std::sin(latitude_rad) * factor, std::cos(latitude_rad));
}

}  // namespace

std::string bodyName(const Ellipsoid& ellipsoid) {
  const double a = ellipsoid.equatorial_radius_m;
  for (const Body& body : kBodies)
    if (a >= body.least_radius_m && a <= body.greatest_radius_m) return body.name;
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "body of radius %.1f km", a / 1000);
  return text.data();
}

double planetocentricLatitude(const Ellipsoid& ellipsoid, double geographic_rad) {
  return withScaledTangent(geographic_rad, squaredAxisRatio(ellipsoid));
}

double geographicLatitude(const Ellipsoid& ellipsoid, double planetocentric_rad) {
  return withScaledTangent(planetocentric_rad, 1 / squaredAxisRatio(ellipsoid));
}

namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;

double wrapped(double longitude_rad) {
  return std::remainder(longitude_rad, 2 * std::numbers::pi);
}

void require(bool holds, const CoordinateSystem& system, const char* bound) {
  if (!holds) throw std::invalid_argument("coordinate system '" + system.name + "': " + bound);
}

void check(const CoordinateSystem& s) {
  const Ellipsoid& e = s.ellipsoid;
  const Projection& p = s.projection;
  require(std::isfinite(e.equatorial_radius_m) && e.equatorial_radius_m > 0, s,
          "equatorial_radius_m must be > 0");
  require(e.flattening >= 0 && e.flattening < 1, s, "flattening must be in [0, 1)");
  require(std::isfinite(p.scale) && p.scale > 0, s, "scale must be > 0");
  for (double latitude : {p.latitude_of_origin_rad, p.standard_parallel_1_rad, p.standard_parallel_2_rad})
    require(std::abs(latitude) <= std::numbers::pi / 2 + 1e-12, s, "latitudes must be within +-pi/2");
  for (double value : {p.central_meridian_rad, p.false_easting_m, p.false_northing_m})
    require(std::isfinite(value), s, "central meridian and false origin must be finite");
}

}  // namespace

Georeference::Georeference(CoordinateSystem system) : system_(std::move(system)) {
  check(system_);
  try {
    transform_ = makeTransform(system_.ellipsoid, system_.projection);
  } catch (const GeographicLib::GeographicErr& error) {
    throw std::invalid_argument("coordinate system '" + system_.name + "': " + error.what());
  }
}

Georeference::Georeference(CoordinateSystem system, std::shared_ptr<const Transform> transform)
    : system_(std::move(system)), transform_(std::move(transform)) {
  check(system_);
}

const CoordinateSystem& Georeference::system() const noexcept {
  return system_;
}

Point Georeference::forward(GeoPoint place) const {
  const Projection& p = system_.projection;
  const double latitude =
      system_.planetocentric ? geographicLatitude(system_.ellipsoid, place.latitude_rad) : place.latitude_rad;
  if (!transform_ || !(std::abs(latitude) <= kQuarterTurn) || !std::isfinite(place.longitude_rad))
    return {kNaN, kNaN};
  const Point raw = transform_->forward({latitude, wrapped(place.longitude_rad - p.central_meridian_rad)});
  return {raw.x_m + p.false_easting_m, raw.y_m + p.false_northing_m};
}

GeoPoint Georeference::geographic(Point point) const {
  if (!transform_) return {kNaN, kNaN};
  const Projection& p = system_.projection;
  const GeoPoint raw = transform_->reverse({point.x_m - p.false_easting_m, point.y_m - p.false_northing_m});
  return {raw.latitude_rad, wrapped(raw.longitude_rad + p.central_meridian_rad)};
}

GeoPoint Georeference::reverse(Point point) const {
  GeoPoint place = geographic(point);
  if (system_.planetocentric)
    place.latitude_rad = planetocentricLatitude(system_.ellipsoid, place.latitude_rad);
  return place;
}

double Georeference::distance_m(Point from, Point to) const {
  const GeoPoint a = geographic(from);
  const GeoPoint b = geographic(to);
  double length_m = 0;
  GeographicLib::Geodesic(system_.ellipsoid.equatorial_radius_m, system_.ellipsoid.flattening)
      .Inverse(a.latitude_rad / kDegree, a.longitude_rad / kDegree, b.latitude_rad / kDegree,
               b.longitude_rad / kDegree, length_m);
  return length_m;
}

Point Georeference::groundScale(Point at) const {
  // Half the base of the central difference: 1e-6 of the radius is small compared with the body and large
  // compared with the rounding error of its coordinates.
  const double h = 1e-6 * system_.ellipsoid.equatorial_radius_m;
  return {distance_m({at.x_m - h, at.y_m}, {at.x_m + h, at.y_m}) / (2 * h),
          distance_m({at.x_m, at.y_m - h}, {at.x_m, at.y_m + h}) / (2 * h)};
}

}  // namespace talus::maps
