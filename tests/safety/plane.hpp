#pragma once

#include "raster.hpp"

namespace safety {

/// The least-squares plane under a rover and its residuals.
struct Plane {
  double east = 0.0;         ///< rise over run eastwards [-]
  double north = 0.0;        ///< rise over run northwards [-]
  double roughness_m = 0.0;  ///< root mean square of the residuals
  double relief_m = 0.0;     ///< highest minus lowest residual
  int cells = 0;             ///< number of cells with data
  bool known = false;        ///< whether the cell itself and a quarter of the disc have data
};

/// Fits the plane over the cells whose centres lie within the radius of a cell's centre, or over 3x3 cells
/// if the disc is smaller. Solves the normal equations of z = a + east x + north y in double precision by
/// elimination.
Plane planeUnder(const Raster& elevation_m, Cell cell, double radius_m);

}  // namespace safety
