#include <cmath>
#include <numbers>

#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>

#include <talus/common/constants.hpp>
#include <talus/maps/geodesy/transform.hpp>

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

}  // namespace talus::maps
