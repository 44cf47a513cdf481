#pragma once

#include <vector>

#include <talus/costmap/ground_model.hpp>
#include <talus/maps/grid.hpp>

/// How what the wheels learned at some places tells about others. Two published methods over the same
/// evidence; costmap/README.md has the measurement by which the map uses the Gaussian process.
namespace talus::costmap {

/// What was learned at one place, as a departure from the mean of its class.
struct PlaceEvidence {
  maps::Point place;
  double pull = 0.0;      ///< drawbar pull over load less the class's [-]
  double sinkage = 0.0;   ///< sinkage over radius less the class's [-]
  double variance = 0.0;  ///< of the pull as measured there, > 0 [-]
};

/// How ground of one class varies over distance.
struct Variation {
  double pull_std = 0.05;             ///< place to place [-]
  double sinkage_std = 0.1;           ///< place to place [-]
  double correlation_length_m = 5.0;  ///< distance at which two places are no longer alike
};

/// Compactly supported positive definite kernel of melkumyan_ramos_2009: 1 at distance 0, 0 from the
/// correlation length on.
///   k(d) = (2 + cos(2 pi d/l))/3 (1 - d/l) + sin(2 pi d/l)/(2 pi)
double sparseKernel(double distance_m, double correlation_length_m) noexcept;

/// Gaussian-process regression of the departure (rasmussen_williams_2006, Eqs. 2.25, 2.26): factorised once
/// for a set of evidence, then asked at any number of places.
///
/// Ground varies by its class's pull_std, but for patches of other ground that no class raster shows: around
/// evidence that departs by more than two standard deviations the process varies by as much as explains it,
///   cov(x, x') = a(x) a(x') k(|x - x'|),  a(x) = 1 + max_i (a_i - 1) k(|x - x_i|) in units of pull_std,
/// a_i the least amplitude under which evidence i lies within two standard deviations (ours).
class GaussianProcess {
 public:
  /// Evidence that is empty leaves the prior.
  GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation);

  bool empty() const noexcept { return evidence_.empty(); }

  /// Departure from the class mean at a place.
  GroundBelief at(const maps::Point& place) const;

 private:
  double amplitude(const maps::Point& place) const noexcept;

  std::vector<PlaceEvidence> evidence_;
  Variation variation_;
  std::vector<double> excess_;          // a_i - 1
  std::vector<double> amplitude_;       // a at each evidence
  std::vector<double> factor_;          // lower Cholesky factor of K + noise, in units of the prior variance
  std::vector<double> pull_, sinkage_;  // (K + noise)^-1 y
};

/// Bayesian generalised kernel inference (doherty_2019): a weighed mean of the evidence around a place,
/// conjugate to the prior.
///   mean = sum k y w / (1 + sum k w),  variance = prior / (1 + sum k w)
///   w = prior variance / measurement variance
GroundBelief kernelInference(const std::vector<PlaceEvidence>& evidence, const Variation& variation,
                             const maps::Point& place);

}  // namespace talus::costmap
