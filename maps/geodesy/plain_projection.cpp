// Projections that GeographicLib does not hold, from its auxiliary latitudes [karney2013] and Snyder's
// formulas.
#include <cmath>
#include <numbers>

#include <GeographicLib/Ellipsoid.hpp>

#include <talus/common/constants.hpp>
#include <talus/maps/geodesy/transform.hpp>

namespace talus::maps {
namespace {

using Figure = GeographicLib::Ellipsoid;

Figure figure(const Ellipsoid& e) {
  return {e.equatorial_radius_m, e.flattening};
}

// x = a cos(phi_1) lambda, y = a (phi - phi_0): PROJ's eqc, spherical also on an ellipsoid.
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

// y = length of the meridian, x = lambda times the radius of the parallel.
class Sinusoidal final : public Transform {
 public:
  explicit Sinusoidal(const Ellipsoid& e) : figure_(figure(e)) {}

  Point forward(GeoPoint p) const override {
    const double latitude = p.latitude_rad / kDegree;
    return {p.longitude_rad * figure_.CircleRadius(latitude), figure_.MeridianDistance(latitude)};
  }

  GeoPoint reverse(Point p) const override {
    const double rectifying = 90 * p.y_m / figure_.QuarterMeridian();
    if (!(std::abs(rectifying) <= 90)) return {kNaN, kNaN};
    const double latitude = figure_.InverseRectifyingLatitude(rectifying);
    const double radius_m = figure_.CircleRadius(latitude);
    return {latitude * kDegree, radius_m > 0 ? p.x_m / radius_m : 0.0};
  }

 private:
  Figure figure_;
};

// Snyder's oblique azimuthal frame on a sphere of auxiliary latitude: the two that follow differ in the
// latitude they use and in how the distance from the origin grows with the angle there.
struct ObliqueFrame {
  double sin0;
  double cos0;

  explicit ObliqueFrame(double origin_rad) : sin0(std::sin(origin_rad)), cos0(std::cos(origin_rad)) {}

  double cosAngle(double latitude, double longitude) const {
    return sin0 * std::sin(latitude) + cos0 * std::cos(latitude) * std::cos(longitude);
  }
  double east(double latitude, double longitude) const { return std::cos(latitude) * std::sin(longitude); }
  double north(double latitude, double longitude) const {
    return cos0 * std::sin(latitude) - sin0 * std::cos(latitude) * std::cos(longitude);
  }
  // Auxiliary latitude and longitude at an angle from the origin, in the direction of (x, y).
  GeoPoint at(double angle, Point p) const {
    const double rho = std::hypot(p.x_m, p.y_m);
    if (rho == 0) return {std::atan2(sin0, cos0), 0.0};
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    return {std::asin(std::clamp(cosine * sin0 + p.y_m * sine * cos0 / rho, -1.0, 1.0)),
            std::atan2(p.x_m * sine, rho * cos0 * cosine - p.y_m * sin0 * sine)};
  }
};

// Snyder, Eqs. 21-24 to 21-28 [snyder1987]: stereographic from the conformal sphere.
class Stereographic final : public Transform {
 public:
  Stereographic(const Ellipsoid& e, const Projection& p)
      : figure_(figure(e)),
        origin_rad_(figure_.ConformalLatitude(p.latitude_of_origin_rad / kDegree) * kDegree),
        frame_(origin_rad_),
        radius_m_(p.scale * figure_.CircleRadius(p.latitude_of_origin_rad / kDegree) / frame_.cos0) {}

  Point forward(GeoPoint p) const override {
    const double chi = figure_.ConformalLatitude(p.latitude_rad / kDegree) * kDegree;
    const double k = 2 * radius_m_ / (1 + frame_.cosAngle(chi, p.longitude_rad));
    return {k * frame_.east(chi, p.longitude_rad), k * frame_.north(chi, p.longitude_rad)};
  }

  GeoPoint reverse(Point p) const override {
    const GeoPoint on_sphere = frame_.at(2 * std::atan2(std::hypot(p.x_m, p.y_m), 2 * radius_m_), p);
    return {figure_.InverseConformalLatitude(on_sphere.latitude_rad / kDegree) * kDegree,
            on_sphere.longitude_rad};
  }

 private:
  Figure figure_;
  double origin_rad_;
  ObliqueFrame frame_;
  double radius_m_;
};

// Snyder, Eqs. 24-17 to 24-26 [snyder1987]: Lambert's azimuthal equal area from the authalic sphere.
class LambertAzimuthal final : public Transform {
 public:
  LambertAzimuthal(const Ellipsoid& e, const Projection& p)
      : figure_(figure(e)),
        frame_(figure_.AuthalicLatitude(p.latitude_of_origin_rad / kDegree) * kDegree),
        radius_m_(std::sqrt(figure_.Area() / (4 * std::numbers::pi))) {
    const double parallel_m = figure_.CircleRadius(p.latitude_of_origin_rad / kDegree);
    const bool polar = std::abs(p.latitude_of_origin_rad) > std::numbers::pi / 2 - 1e-10;
    stretch_ = polar ? 1.0 : parallel_m / (radius_m_ * frame_.cos0);
  }

  Point forward(GeoPoint p) const override {
    const double beta = figure_.AuthalicLatitude(p.latitude_rad / kDegree) * kDegree;
    const double k = radius_m_ * std::sqrt(2 / (1 + frame_.cosAngle(beta, p.longitude_rad)));
    return {k * stretch_ * frame_.east(beta, p.longitude_rad),
            k / stretch_ * frame_.north(beta, p.longitude_rad)};
  }

  GeoPoint reverse(Point p) const override {
    const Point on_sphere{p.x_m / stretch_, p.y_m * stretch_};
    const double half_chord = std::hypot(on_sphere.x_m, on_sphere.y_m) / (2 * radius_m_);
    if (!(half_chord <= 1)) return {kNaN, kNaN};
    const GeoPoint place = frame_.at(2 * std::asin(half_chord), on_sphere);
    return {figure_.InverseAuthalicLatitude(place.latitude_rad / kDegree) * kDegree, place.longitude_rad};
  }

 private:
  Figure figure_;
  ObliqueFrame frame_;
  double radius_m_;
  double stretch_ = 1.0;
};

// The ellipsoid seen from far above the origin: east and north of the tangent frame there.
class Orthographic final : public Transform {
 public:
  Orthographic(const Ellipsoid& e, const Projection& p)
      : a_(e.equatorial_radius_m),
        one_minus_e2_((1 - e.flattening) * (1 - e.flattening)),
        sin0_(std::sin(p.latitude_of_origin_rad)),
        cos0_(std::cos(p.latitude_of_origin_rad)),
        nu0_(normalRadius(sin0_)) {}

  Point forward(GeoPoint p) const override {
    const double sine = std::sin(p.latitude_rad);
    const double cosine = std::cos(p.latitude_rad);
    if (!(sin0_ * sine + cos0_ * cosine * std::cos(p.longitude_rad) >= 0)) return {kNaN, kNaN};
    const double nu = normalRadius(sine);
    const double x = nu * cosine * std::cos(p.longitude_rad) - nu0_ * cos0_;
    const double z = one_minus_e2_ * (nu * sine - nu0_ * sin0_);
    return {nu * cosine * std::sin(p.longitude_rad), z * cos0_ - x * sin0_};
  }

  // The nearer of the two places where the line of sight meets the ellipsoid; axes scaled to make it a
  // sphere.
  GeoPoint reverse(Point p) const override {
    const double polar = 1 / std::sqrt(one_minus_e2_);
    const double start[3] = {nu0_ * cos0_ - p.y_m * sin0_, p.x_m,
                             (one_minus_e2_ * nu0_ * sin0_ + p.y_m * cos0_) * polar};
    const double up[3] = {cos0_, 0.0, sin0_ * polar};
    const double uu = up[0] * up[0] + up[2] * up[2];
    const double us = up[0] * start[0] + up[2] * start[2];
    const double ss = start[0] * start[0] + start[1] * start[1] + start[2] * start[2] - a_ * a_;
    const double root = us * us - uu * ss;
    if (!(root >= 0)) return {kNaN, kNaN};
    const double h = (std::sqrt(root) - us) / uu;
    const double x = start[0] + h * up[0];
    const double z = (start[2] + h * up[2]) / polar;
    return {std::atan2(z, one_minus_e2_ * std::hypot(x, p.x_m)), std::atan2(p.x_m, x)};
  }

 private:
  double normalRadius(double sine) const { return a_ / std::sqrt(1 - (1 - one_minus_e2_) * sine * sine); }

  double a_;
  double one_minus_e2_;
  double sin0_;
  double cos0_;
  double nu0_;
};

}  // namespace

std::unique_ptr<const Transform> makePlainTransform(const Ellipsoid& e, const Projection& p) {
  switch (p.method) {
    case ProjectionMethod::Equirectangular:
      return std::make_unique<Equirectangular>(e, p);
    case ProjectionMethod::Sinusoidal:
      return std::make_unique<Sinusoidal>(e);
    case ProjectionMethod::Stereographic:
      return std::make_unique<Stereographic>(e, p);
    case ProjectionMethod::LambertAzimuthalEqualArea:
      return std::make_unique<LambertAzimuthal>(e, p);
    case ProjectionMethod::Orthographic:
      return std::make_unique<Orthographic>(e, p);
    default:
      return nullptr;
  }
}

}  // namespace talus::maps
