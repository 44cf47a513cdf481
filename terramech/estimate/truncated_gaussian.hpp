#pragma once

#include <array>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_mixture.hpp>

namespace talus::terramech {

/// Box; infinite sides are unbounded.
struct SoilBox {
  SoilVector low;
  SoilVector high;
};

/// Gaussian truncated to a box, with the sampler of Geweke, Hajivassiliou and Keane (geweke_1991). Each
/// coordinate is drawn inside its bounds given the coordinates before, so that no draw is rejected and the
/// density of a draw is known. The coordinate with the largest conditional variance is drawn first (pivoted
/// Cholesky factor), because the box truncates it most.
class TruncatedGaussian {
 public:
  /// Requires a positive definite `covariance` and a `box` with low < high.
  TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box);

  /// Draw and the logarithm of its sampling density.
  struct Draw {
    SoilVector at;
    double log_density;
  };

  /// Returns the draw for a point of the unit cube.
  Draw draw(const SoilVector& even) const;

 private:
  SoilVector mean_;
  SoilBox box_;
  std::array<int, kSoilParameters> order_;
  // Rows: coordinates, columns: order of drawing; covariance = root root'.
  SoilMatrix root_ = SoilMatrix::Zero();
};

}  // namespace talus::terramech
