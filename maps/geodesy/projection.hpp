#pragma once

namespace talus::maps {

/// Map projections of DEMs that rovers use. The numbers are stored in map files.
enum class ProjectionMethod {
  TransverseMercator = 0,
  Mercator = 1,  ///< one standard parallel (standard_parallel_1_rad); `scale` is the scale factor there
  Equirectangular = 2,        ///< PROJ's eqc on the equatorial sphere; true along standard_parallel_1_rad
  PolarStereographic = 3,     ///< `scale` along standard_parallel_1_rad, whose sign selects the pole
  LambertConformalConic = 5,  ///< standard parallels 1 and 2 (equal for a single parallel)
  Foreign = 12,  ///< defined by the WKT only: any other projection, or a datum of Earth other than WGS 84
};

/// Parameters of a projection; parameters that the method does not use are ignored.
struct Projection {
  ProjectionMethod method = ProjectionMethod::TransverseMercator;
  double latitude_of_origin_rad = 0.0;
  double central_meridian_rad = 0.0;  ///< from the prime meridian of the body, east positive
  double standard_parallel_1_rad = 0.0;
  double standard_parallel_2_rad = 0.0;
  double scale = 1.0;  ///< scale factor [-] at the origin or the standard parallel, > 0
  double false_easting_m = 0.0;
  double false_northing_m = 0.0;
};

}  // namespace talus::maps
