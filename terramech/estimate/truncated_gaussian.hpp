#pragma once

#include <array>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_mixture.hpp>

namespace talus::terramech {

/// Box in the coordinates of the soil parameters. Infinite bounds are allowed.
struct SoilBox {
  SoilVector low;
  SoilVector high;
};

/// Gaussian distribution truncated to a box, with the sampler of Geweke, Hajivassiliou and Keane
/// (geweke_1991). Each coordinate is drawn inside its bounds given the coordinates drawn before it, so that
/// no draw is rejected and the density of a draw is known. The coordinate with the largest conditional
/// variance is drawn first (pivoted Cholesky factor), because the box truncates this coordinate most.
class TruncatedGaussian {
 public:
  /// Mean and covariance are those of the Gaussian before truncation. Requires a positive definite
  /// `covariance` and a `box` with low < high.
  TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box);

  /// Drawn point, and the logarithm of the density with which the point was drawn.
  struct Draw {
    SoilVector at;
    double log_density;
  };

  /// Returns the draw that corresponds to a point `even` of the unit cube, for example a point of
  /// evenPoints().
  Draw draw(const SoilVector& even) const;

 private:
  SoilVector mean_;
  SoilBox box_;
  std::array<int, kSoilParameters> order_;
  // The rows of the root are coordinates, its columns follow the order of drawing; covariance = root root'.
  SoilMatrix root_ = SoilMatrix::Zero();
};

}  // namespace talus::terramech
