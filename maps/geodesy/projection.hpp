#pragma once

namespace talus::maps {

/// The map projections of the maps that rovers are driven by; map files have the numbers.
enum class ProjectionMethod {
  TransverseMercator = 0,
  Mercator = 1,               ///< one standard parallel (standard_parallel_1_rad), scale there
  Equirectangular = 2,        ///< on the sphere of the equatorial radius, as PROJ has it; true along
                              ///< standard_parallel_1_rad
  PolarStereographic = 3,     ///< scale along standard_parallel_1_rad, whose sign picks the pole
  LambertConformalConic = 5,  ///< standard parallels 1 and 2 (equal for one)
  Foreign = 12,               ///< by the WKT alone: another projection, or another datum of Earth than WGS 84
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
