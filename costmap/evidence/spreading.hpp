#pragma once

#include <optional>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

/// Spatial inference: estimates of the ground between places with evidence. A "departure" is the difference
/// of a quantity from the mean (or, where stated, from the prior) of its terrain class.
namespace talus::costmap {

/// Number of standard deviations within which a departure counts as ordinary variation of a class [-].
inline constexpr double kOrdinary = 2.0;

/// Evidence at one place: departures from the mean of its terrain class.
struct PlaceEvidence {
  maps::Point place;
  double pull = 0.0;      ///< drawbar pull over load DP/W minus the class mean [-]
  double sinkage = 0.0;   ///< sinkage over wheel radius z/r minus the class mean [-]; NaN: not measured
  double variance = 0.0;  ///< variance of the measured DP/W, > 0 [-]
  double shared = 0.0;  ///< standard deviation of DP/W by the error that is common to all evidence, >= 0 [-]
};

/// Variances of an estimate whose evidence has one common error b, standard normal, in addition to errors
/// that are independent between readings.
struct SharedError {
  double prior = 0.0;  ///< a^2: variance of the estimate before any evidence, > 0 [-]
  /// e^2: variance of the estimate after the evidence, without the common error, 0 to a^2 [-].
  double variance = 0.0;
  double shared = 0.0;  ///< c: change of the estimate per standard deviation of b, >= 0 [-]
};

/// Returns the posterior variance of an estimate with a common error:
///   (e^2 g + c^2) / (g + c^2/a^2),  g = 1 - e^2/a^2.
/// This is the conjugate update by one reading of the variance e^2/g + (c/g)^2 (ours). The result is exact if
/// all evidence measures the same quantity. It lies between e^2 and a^2 and does not decrease as e or c
/// increases.
double withSharedError(const SharedError& error) noexcept;

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

/// Estimate of the ground at a place by the Gaussian process.
struct LearnedPlace {
  /// Departure from the class mean, with standard deviation but without the common error.
  GroundBelief departure;
  bool any = false;  ///< true if any evidence lies within the correlation length of the place
  /// Sum of the weights of all evidence, 0 to 1 [-]; the class mean has the weight 1 - `weight`.
  double weight = 0.0;
  /// Sum of the positive weights [-]: if the class mean decreases by d, the estimate increases by at most
  /// (positive - 1) d.
  double positive = 0.0;
  double shared = 0.0;  ///< change of the estimated DP/W per standard deviation of the common error, >= 0 [-]
};

/// Gaussian-process regression of the departure from the class mean (rasmussen_williams_2006, Eqs. 2.25,
/// 2.26). The matrix of the evidence is factorised once; the departure is then evaluated at any number of
/// places. Two changes ensure that weaker evidence never raises an estimate (ours). First, evidence stronger
/// than its class by more than two standard deviations is limited to two. Second, negative weights are set to
/// 0, and the weights of evidence stronger than its class are multiplied by the sum of all weights, limited
/// to 0 to 1, over the sum of the positive weights.
class GaussianProcess {
 public:
  /// Makes the process. Without evidence, all departures are 0 with the standard deviations of `variation`.
  GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation);

  bool empty() const noexcept { return evidence_.empty(); }

  /// Returns the departure from the class mean at a place, without the common error.
  GroundBelief at(const maps::Point& place) const { return learned(place).departure; }

  /// Returns the departure from the class mean at a place, with the weights of the evidence and the effect of
  /// the common error.
  LearnedPlace learned(const maps::Point& place) const;

 private:
  std::vector<PlaceEvidence> evidence_;
  Variation variation_;
  std::vector<double> factor_;      // upper Cholesky factor of K + noise, in units of the prior variance
  std::vector<double> transposed_;  // transpose of factor_
};

/// A departure from the mean of a class [-], and its variance.
struct Departure {
  double departure = 0.0;
  double variance = 0.0;
};

/// Returns the departure from the class mean that a reading implies without other evidence: a^2 y/(a^2 + v).
/// y is the departure of the reading and v its variance; y, v and the amplitude a are in units of the class's
/// standard deviation class_std. a >= 1 is the least amplitude for which the reading lies within two standard
/// deviations (ours), because small areas of other ground, missing in the class raster, depart further than
/// the class varies.
double estimateAlone(const Departure& reading, double class_std) noexcept;

/// Weak place: ground that the evidence of one place alone proves to be weaker than its class or to have a
/// greater sinkage. No estimate nearby exceeds the value that this place alone implies.
struct WeakPlace {
  maps::Point place;
  double pull = 0.0;      ///< departure of DP/W from the prior of its class, <= 0 [-]
  double variance = 0.0;  ///< variance of the measured DP/W, > 0 [-]
  double sinkage = 0.0;   ///< departure of z/r from the prior of its class, >= 0 [-]
  /// Position uncertainty [m]: all ground within this distance counts as the place itself.
  double reach_m = 0.0;
  /// True if the place also limits estimates of ground beyond reach_m; false for ground of another class.
  bool beyond_reach = true;
};

/// Returns the departure from the prior that a weak place implies at `place`, at the distance d from it;
/// nullopt if the weak place has no effect there. The departure is that of a Gaussian process with the
/// amplitude 1 + (a - 1) k(d), where a is the amplitude of estimateAlone() and k is sparseKernel().
std::optional<GroundBelief> weakness(const WeakPlace& weak, const Variation& variation,
                                     const maps::Point& place);

/// Returns the departure from the prior at `at` by a place within the variation of its class whose readings
/// may only lower an estimate: weakness() with the amplitude a = 1.
std::optional<GroundBelief> lowered(const WeakPlace& place, const Variation& variation,
                                    const maps::Point& at);

/// Returns an estimate that bounds the ground like `a` and `b` together. The pull has the lower of both
/// means, and the standard deviation by which mean - 6 std is the lower of both. The sinkage has the greater
/// of both means, and the standard deviation by which mean + 6 std is the greater of both. The order of
/// several combinations has no effect.
GroundBelief weaker(const GroundBelief& a, const GroundBelief& b) noexcept;

}  // namespace talus::costmap
