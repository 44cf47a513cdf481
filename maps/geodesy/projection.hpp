#pragma once

namespace talus::maps {

/// Map projections of the elevation maps that rovers use. Map files store the numbers.
enum class ProjectionMethod {
  TransverseMercator = 0,
  Mercator = 1,  ///< `scale` is the scale factor along the parallel standard_parallel_1_rad
  /// PROJ's eqc on a sphere of the equatorial radius; true to scale along standard_parallel_1_rad.
  Equirectangular = 2,
  /// `scale` is the scale factor along standard_parallel_1_rad; the sign of that parallel selects the pole.
  PolarStereographic = 3,
  LambertConformalConic = 5,  ///< uses standard parallels 1 and 2, which are equal for a single parallel
  /// Projection defined by the WKT only: any other projection, or a datum of Earth other than WGS 84.
  Foreign = 12,
};

/// Parameters of a projection; parameters that the method does not use are ignored.
struct Projection {
  ProjectionMethod method = ProjectionMethod::TransverseMercator;
  double latitude_of_origin_rad = 0.0;
  /// Longitude of the central meridian from the body's prime meridian, east positive.
  double central_meridian_rad = 0.0;
  double standard_parallel_1_rad = 0.0;
  double standard_parallel_2_rad = 0.0;
  double scale = 1.0;  ///< scale factor at the origin or the standard parallel, > 0 [-]
  double false_easting_m = 0.0;
  double false_northing_m = 0.0;
};

}  // namespace talus::maps
