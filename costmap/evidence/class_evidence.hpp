#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// Spatial inference: estimates of the ground between places with evidence.

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

/// Returns a number in units of 1/SourceReadings::kUnit, rounded. Sums of such numbers do not depend on their order.
std::int64_t fixedPoint(double value) noexcept;

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
  Eigen::LLT<Eigen::MatrixXd> factor_;  // of K + noise, in units of the prior variance
};

/// What one combination of sound and faulty sources makes of a terrain class. A source is the readings of one
/// drive with a common error. Departures are differences from the prior of the class.
struct ClassHypothesis {
  double weight = 1.0;  ///< posterior probability [-]
  double pull = 0.0;    ///< departure of the mean drawbar pull over load DP/W [-]
  /// Standard deviation of `pull` by the places that were not driven [-].
  double own_std = 0.0;
  /// Standard deviation of `pull` by the errors common to all readings of a source [-].
  double shared_std = 0.0;
  /// The sound sources, ascending, and the mean of the common departure of each from the present ground [-].
  std::vector<std::pair<Source, double>> sound{};

  friend bool operator==(const ClassHypothesis&, const ClassHypothesis&) = default;
};

/// State of a terrain class, from which estimates of its ground are computed.
struct ClassState {
  std::vector<ClassHypothesis> hypotheses;  ///< their weights sum to 1
  double sinkage = 0.0;                     ///< departure of the mean sinkage over wheel radius [-]

  friend bool operator==(const ClassState&, const ClassState&) = default;
};

/// Evidence of a terrain class: sums over the blocks with readings, by source. Sums are exact (fixed point): a
/// block can be removed again, and the order of blocks has no effect.
///
/// Model: the class mean departs from its prior by D, normal with the standard deviation mean_std (q), and a
/// place departs from the class mean by f, normal with the standard deviation pull_std (p). With W independent
/// places driven, D' = D + mean of f has the variance q^2 + p^2/W. The mean reading of source s is
///   y_s = D' + e_s,  var e_s = c_s^2 + p^2/W_s - p^2/W                                                    (B5)
/// with the places W_s and the shared error c_s of the source. The y_s of faulty sensors is normal with the
/// standard deviation 2 q beside its errors and the places, and tells nothing about D. Sensors are faulty with
/// the probability 0.001 if the slip was measured twice, 0.07 if once, 0.5 if they were not verified (ours).
///
/// The state of the soil changes with time: D' at two times has the correlation r = e^(-|t2 - t1|/T), with the
/// correlation time T of the soil (0: r = 1). Sources are taken in order of time, from one to the next
///   D' -> r D',  var D' -> r^2 var D' + (1 - r^2)(q^2 + p^2/W)                                            (B7)
/// A source without times counts as the newest. Each combination of faulty sources is one hypothesis. Its
/// probability is the product of the prior and of the densities of y_s, given those before; its D that of the newest
/// source, by conjugate normal updates. The kMost most probable are kept.
class ClassEvidence {
 public:
  explicit ClassEvidence(const GroundClass& ground) : ground_(ground) {}

  /// Adds (sign 1) or removes (sign -1) the pulls of a block. `prior` is the DP/W of the class. `places` is
  /// the number of independent places that a block counts as, at most 1.
  void count(std::span<const SourcePull> pulls, double prior, double places, int sign);
  /// Adds or removes the departure of a block's sinkage over wheel radius z/r from the prior [-].
  void countSinkage(double departure, double places, int sign);

  /// Returns the posterior. With `step` > 0, its numbers are rounded to multiples of `step` (weights: of 1/64), so
  /// that the state is constant under small changes.
  ClassState state(double step = 0.0) const;
  /// Returns the sum over all blocks of the weights, i.e. the number of independent places [-].
  double places() const noexcept;

  /// Greatest number of hypotheses.
  static constexpr std::size_t kMost = 16;

 private:
  // Sums in units of 2^-20: of the weights, and of weight times departure, shared error and time in days.
  struct Sums {
    std::int64_t weight = 0, departure = 0, shared = 0, days = 0;
  };

  GroundClass ground_;
  std::int64_t places_ = 0;
  std::map<Source, Sums> sources_;
  Sums sinkage_;
};

}  // namespace talus::costmap
