#pragma once

#include <optional>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

/// Spatial inference: estimates between places with evidence. Two published methods on the same evidence;
/// docs/measurements/costmap.md compares the two methods. The map uses the Gaussian process.
namespace talus::costmap {

/// Departures within this number of standard deviations are ordinary for a class [-].
inline constexpr double kOrdinary = 2.0;

/// Evidence at one place, as a departure from the mean of its class.
struct PlaceEvidence {
  maps::Point place;
  double pull = 0.0;      ///< drawbar pull over load minus that of the class [-]
  double sinkage = 0.0;   ///< sinkage over radius minus that of the class [-]; NaN: not measured
  double variance = 0.0;  ///< variance of the measured pull, > 0 [-]
  double shared = 0.0;    ///< standard deviation by the error common to all evidence, >= 0 [-]
};

/// Variances of an estimate whose evidence has one common error b, standard normal, in addition to
/// independent errors.
struct SharedError {
  double prior = 0.0;     ///< a^2: variance before any evidence, > 0 [-]
  double variance = 0.0;  ///< e^2: variance after the evidence without the common error, 0 to a^2 [-]
  double shared = 0.0;    ///< c: change of the estimate per standard deviation of b, >= 0 [-]
};

/// Returns the posterior variance of an estimate with a common error: conjugate update by one reading of
/// variance e^2/g + (c/g)^2, g = 1 - e^2/a^2 (ours). The result is exact if all evidence measures the same
/// quantity, lies between e^2 and a^2, and does not decrease as e or c increases.
///   (e^2 g + c^2) / (g + c^2/a^2)
double withSharedError(const SharedError& error) noexcept;

/// Spatial variation of ground of one class.
struct Variation {
  double pull_std = 0.05;             ///< standard deviation between places [-]
  double sinkage_std = 0.1;           ///< standard deviation between places [-]
  double correlation_length_m = 5.0;  ///< distance from which two places are uncorrelated [m]
};

/// Compactly supported positive definite kernel of melkumyan_ramos_2009 [-]: 1 at distance 0, 0 from the
/// correlation length on.
///   k(d) = (2 + cos(2 pi d/l))/3 (1 - d/l) + sin(2 pi d/l)/(2 pi)
double sparseKernel(double distance_m, double correlation_length_m) noexcept;

/// Estimate at a place from the evidence.
struct LearnedPlace {
  GroundBelief departure;  ///< departure from the class mean, without the common error
  bool any = false;        ///< true if any evidence reaches the place
  double weight = 0.0;     ///< sum of the weights of all evidence, 0 to 1; the class mean has the weight 1 -
                           ///< `weight`
  double positive =
      0.0;  ///< sum of the positive weights: if the class mean falls by d, the estimate rises by at most
            ///< (positive - 1) d
  double shared = 0.0;  ///< change of the pull per standard deviation of the common error, >= 0 [-]
};

/// Gaussian-process regression of the departure (rasmussen_williams_2006, Eqs. 2.25, 2.26): factorised once
/// for a set of evidence, then evaluated at any number of places. Two changes ensure that weaker evidence
/// never raises an estimate (ours). First, a departure above the class of more than two standard deviations
/// is limited to two. Second, negative weights are set to 0, and the weights of evidence stronger than its
/// class are multiplied by the sum of all weights, limited to 0 to 1, over the sum of the positive weights.
class GaussianProcess {
 public:
  /// With empty evidence all estimates equal the prior.
  GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation);

  bool empty() const noexcept { return evidence_.empty(); }

  /// Departure from the class mean at a place, without the common error.
  GroundBelief at(const maps::Point& place) const { return learned(place).departure; }

  /// Departure at a place, with its weights and the effect of the common error.
  LearnedPlace learned(const maps::Point& place) const;

 private:
  std::vector<PlaceEvidence> evidence_;
  Variation variation_;
  std::vector<double> factor_;      // upper Cholesky factor of K + noise, in units of the prior variance
  std::vector<double> transposed_;  // transpose of factor_
};

/// A departure from the mean of a class, and its variance.
struct Departure {
  double departure = 0.0;
  double variance = 0.0;
};

/// Returns the departure that a reading y of variance v implies without other evidence: a^2 y/(a^2 + v), with
/// y, v and a in units of the class's standard deviation. The amplitude a >= 1 is the least amplitude for
/// which the reading lies within two standard deviations (ours): small areas of other ground, missing in the
/// class raster, depart further than the class varies.
double estimateAlone(const Departure& reading, double class_std) noexcept;

/// Ground that is weaker than its class, or has a greater sinkage, by the evidence of one place alone. No
/// estimate nearby exceeds the value that this place alone implies.
struct WeakPlace {
  maps::Point place;
  double pull = 0.0;         ///< departure of drawbar pull over load from the prior of its class, <= 0 [-]
  double variance = 0.0;     ///< variance of the measured pull, > 0 [-]
  double sinkage = 0.0;      ///< departure of sinkage over radius, >= 0 [-]
  double reach_m = 0.0;      ///< position uncertainty: all ground within this distance counts as the place
                             ///< itself [m]
  bool beyond_reach = true;  ///< true if the place also limits ground beyond reach_m; false for ground of
                             ///< another class
};

/// Returns the departure from the prior that a weak place implies at `place`, at the distance d: a process of
/// amplitude 1 + (a - 1) k(d), with a as in estimateAlone(); nullopt if the weak place has no effect at
/// `place`.
std::optional<GroundBelief> weakness(const WeakPlace& weak, const Variation& variation,
                                     const maps::Point& place);

/// Returns the departure that a place within the variation of its class implies, if its readings may only
/// lower an estimate: as weakness(), with the amplitude a = 1.
std::optional<GroundBelief> lowered(const WeakPlace& place, const Variation& variation,
                                    const maps::Point& at);

/// Combines two estimates that both bound the same ground: the pull has the lower of both means, and a
/// standard deviation by which mean - 6 std is the lower of both; the sinkage has the greater values. The
/// order of several combinations has no effect.
GroundBelief weaker(const GroundBelief& a, const GroundBelief& b) noexcept;

/// Bayesian generalised kernel inference (doherty_2019): a weighted mean of the evidence around a place,
/// conjugate to the prior.
///   mean = sum k y w / (1 + sum k w),  variance = prior / (1 + sum k w)
///   w = prior variance / measurement variance
GroundBelief kernelInference(const std::vector<PlaceEvidence>& evidence, const Variation& variation,
                             const maps::Point& place);

}  // namespace talus::costmap
