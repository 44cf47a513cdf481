#include <array>
#include <cmath>
#include <cstdio>

#include <talus/maps/geodesy/ellipsoid.hpp>

namespace talus::maps {
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

}  // namespace talus::maps
