#pragma once

#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

/// Spatial inference: estimates of the ground between places with evidence.
namespace talus::costmap {

/// Evidence at one place: departures from the mean of its terrain class.
struct PlaceEvidence {
  maps::Point place;
  double pull = 0.0;      ///< drawbar pull over load DP/W minus the class mean [-]
  double sinkage = 0.0;   ///< sinkage over wheel radius z/r minus the class mean [-]; NaN: not measured
  double variance = 0.0;  ///< variance of the measured DP/W, > 0 [-]
};

/// Spatial variation of the ground of one terrain class.
struct Variation {
  double pull_std = 0.05;             ///< standard deviation of DP/W between places [-]
  double sinkage_std = 0.1;           ///< standard deviation of z/r between places [-]
  double correlation_length_m = 5.0;  ///< distance from which the ground at two places is uncorrelated
};

/// Returns the compactly supported positive definite kernel of melkumyan_ramos_2009 [-] at the distance d =
/// distance_m, with l = correlation_length_m. It is 1 at distance 0, and 0 from the correlation length on.
///   k(d) = (2 + cos(2 pi d/l))/3 (1 - d/l) + sin(2 pi d/l)/(2 pi)
double sparseKernel(double distance_m, double correlation_length_m) noexcept;

/// Returns the probability that a place is on another soil than its surroundings, which the class raster does not
/// show (ours): 0.02 before the reading. `difference` is that of the reading from the expected value; differences
/// have the variance `variance` on the same soil, and the standard deviation 0.3 on another one.
double otherSoilProbability(double difference, double variance) noexcept;

/// Estimate of the ground at a place by the Gaussian process.
struct LearnedPlace {
  GroundBelief departure;  ///< departure from the class mean, with standard deviation
  bool any = false;        ///< true if any evidence lies within the correlation length of the place
  /// Sum of the weights of all evidence [-]: an error d of the class mean changes the estimate by (1 - weight) d.
  double weight = 0.0;
};

/// Gaussian-process regression of the departure from the class mean (rasmussen_williams_2006, Eqs. 2.25,
/// 2.26). The matrix of the evidence is factorised once; the departure is then evaluated at any number of
/// places. Sinkages have the weights of the pulls.
class GaussianProcess {
 public:
  /// Makes the process. Without evidence, all departures are 0 with the standard deviations of `variation`.
  GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation);

  bool empty() const noexcept { return evidence_.empty(); }

  /// Returns the departure from the class mean at a place.
  LearnedPlace learned(const maps::Point& place) const;

 private:
  std::vector<PlaceEvidence> evidence_;
  Variation variation_;
  std::vector<double> factor_;      // upper Cholesky factor of K + noise, in units of the prior variance
  std::vector<double> transposed_;  // transpose of factor_
};

}  // namespace talus::costmap
