#pragma once

namespace talus::maps {

/// The map projections that are known.
enum class ProjectionMethod {
  TransverseMercator,
  Mercator,               ///< one standard parallel (standard_parallel_1_rad), scale there
  Equirectangular,        ///< on the sphere of the equatorial radius, as PROJ has it; true along
                          ///< standard_parallel_1_rad
  PolarStereographic,     ///< scale along standard_parallel_1_rad, whose sign picks the pole
  Stereographic,          ///< oblique, on the conformal sphere [snyder1987]
  LambertConformalConic,  ///< standard parallels 1 and 2 (equal for one)
  AlbersEqualArea,        ///< standard parallels 1 and 2
  CylindricalEqualArea,   ///< standard_parallel_1_rad
  LambertAzimuthalEqualArea,
  AzimuthalEquidistant,
  Orthographic,
  Sinusoidal,
};

/// A projection's parameters; those that the method does not use are ignored.
struct Projection {
  ProjectionMethod method = ProjectionMethod::TransverseMercator;
  double latitude_of_origin_rad = 0.0;
  double central_meridian_rad = 0.0;  ///< from the body's prime meridian, east positive
  double standard_parallel_1_rad = 0.0;
  double standard_parallel_2_rad = 0.0;
  double scale = 1.0;  ///< scale factor at the origin [-], > 0
  double false_easting_m = 0.0;
  double false_northing_m = 0.0;
};

}  // namespace talus::maps
