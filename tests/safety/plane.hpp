#pragma once

#include "raster.hpp"

namespace safety {

/// The plane of least squares under a rover and what it leaves.
struct Plane {
  double east = 0.0;         ///< rise over run eastwards [-]
  double north = 0.0;        ///< rise over run northwards [-]
  double roughness_m = 0.0;  ///< root mean square of what it leaves
  double relief_m = 0.0;     ///< highest less lowest of what it leaves
  int cells = 0;             ///< that have data
  bool known = false;        ///< whether the cell itself and a quarter of the disc have data
};

/// Over the cells whose centres lie within the radius of a cell's centre, three by three of them where the
/// disc is smaller: the normal equations of z = a + east x + north y, in double, solved by elimination.
Plane planeUnder(const Raster& elevation_m, Cell cell, double radius_m);

}  // namespace safety
