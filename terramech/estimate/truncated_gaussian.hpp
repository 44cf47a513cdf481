#pragma once

#include <array>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_mixture.hpp>

namespace talus::terramech {

/// Sides of a box; infinite where there is none.
struct SoilBox {
  SoilVector low;
  SoilVector high;
};

/// A Gaussian cut to a box, sampled side by side (Geweke, Hajivassiliou and Keane; geweke_1991): each
/// coordinate is drawn inside its sides given those before it, so no draw is lost, and the density of a draw
/// is known. The widest coordinate goes first (a pivoted Cholesky factor): what the box cuts most is drawn
/// before what hangs on it.
class TruncatedGaussian {
 public:
  /// `covariance` positive definite, `box` with low < high.
  TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box);

  /// A draw and the logarithm of the density it was drawn with.
  struct Draw {
    SoilVector at;
    double log_density;
  };

  /// The draw that belongs to a point of the unit cube.
  Draw draw(const SoilVector& even) const;

 private:
  SoilVector mean_;
  SoilBox box_;
  std::array<int, kSoilParameters> order_;
  SoilMatrix root_ = SoilMatrix::Zero();  // rows by coordinate, columns by turn: covariance = root root'
};

}  // namespace talus::terramech
