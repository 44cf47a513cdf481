#pragma once

#include <optional>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

/// How what the wheels learned at some places tells about others. Two published methods over the same
/// evidence; costmap/README.md has the measurement by which the map uses the Gaussian process.
namespace talus::costmap {

/// Standard deviations within which the ground of a class is ordinary [-].
inline constexpr double kOrdinary = 2.0;

/// What was learned at one place, as a departure from the mean of its class.
struct PlaceEvidence {
  maps::Point place;
  double pull = 0.0;      ///< drawbar pull over load less the class's [-]
  double sinkage = 0.0;   ///< sinkage over radius less the class's [-]; NaN where none was measured
  double variance = 0.0;  ///< of the pull as measured there, > 0 [-]
  double shared = 0.0;    ///< its standard deviation by the error that all evidence shares, >= 0 [-]
};

/// An estimate whose evidence shares one error b, standard normal, beside what each reading has of its own.
struct SharedError {
  double prior = 0.0;     ///< a^2: variance before any evidence, > 0 [-]
  double variance = 0.0;  ///< e^2: after it, if it shared no error, 0 to a^2 [-]
  double shared = 0.0;    ///< c: by how much one standard deviation of b moves the estimate, >= 0 [-]
};

/// Posterior variance of such an estimate: of the conjugate update by one reading of variance e^2/g + (c/g)^2,
/// g = 1 - e^2/a^2 (ours). Exact where all evidence says the same thing; between e^2 and a^2, however much evidence
/// there is; it never falls as e or c grows.
///   (e^2 g + c^2) / (g + c^2/a^2)
double withSharedError(const SharedError& error) noexcept;

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

/// What evidence says of a place.
struct LearnedPlace {
  GroundBelief departure;  ///< from the class mean, as if the evidence shared no error
  bool any = false;        ///< whether any evidence reaches the place
  double weight = 0.0;     ///< sum of the weights of all evidence, 0 to 1: the rest is the class mean's
  double positive =
      0.0;  ///< sum of those above 0: where the class mean falls by d, the estimate rises by no more than
            ///< (positive - 1) d
  double shared = 0.0;  ///< by how much one standard deviation of the shared error moves the pull, >= 0 [-]
};

/// Gaussian-process regression of the departure (rasmussen_williams_2006, Eqs. 2.25, 2.26): factorised once
/// for a set of evidence, then asked at any number of places. Two things differ, so that weaker evidence never
/// makes any place look stronger (ours): ground that is stronger than its class by more than two standard
/// deviations counts as if by two; and weights of evidence that the regression would have below 0 are 0, for which
/// those of ground stronger than its class are scaled down to the sum of all, 1 at most.
class GaussianProcess {
 public:
  /// Evidence that is empty leaves the prior.
  GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation);

  bool empty() const noexcept { return evidence_.empty(); }

  /// Departure from the class mean at a place, as if the evidence shared no error.
  GroundBelief at(const maps::Point& place) const { return learned(place).departure; }

  /// The same with what the shared error does.
  LearnedPlace learned(const maps::Point& place) const;

 private:
  std::vector<PlaceEvidence> evidence_;
  Variation variation_;
  std::vector<double> factor_;      // upper Cholesky factor of K + noise, in units of the prior variance
  std::vector<double> transposed_;  // of it
};

/// A departure from a class's mean and its variance.
struct Departure {
  double departure = 0.0;
  double variance = 0.0;
};

/// What is left of a reading's departure where nothing else is known: a^2 y/(a^2 + v), in units of the class's
/// std. Ground varies by that std, but for patches of other ground that no class raster shows: the amplitude a
/// is the least, from 1 on, under which the reading lies within two standard deviations (ours).
double believedAlone(const Departure& reading, double class_std) noexcept;

/// Ground that is weaker than its class, or sinks deeper, as one place says by itself. Whatever else is known,
/// no place near it is believed to be better than this leaves it.
struct WeakPlace {
  maps::Point place;
  double pull = 0.0;         ///< departure of drawbar pull over load from the prior of its class, <= 0 [-]
  double variance = 0.0;     ///< of the pull as measured there, > 0 [-]
  double sinkage = 0.0;      ///< departure of sinkage over radius, >= 0 [-]
  double reach_m = 0.0;      ///< how far off the place may be: all ground within counts as the place itself
  bool beyond_reach = true;  ///< whether it says anything of ground beyond that; not of other classes
};

/// Departure from the prior that a weak place leaves to another, by a process of amplitude
/// 1 + (a - 1) k(d) there, a as in believedAlone; nothing where it says nothing.
std::optional<GroundBelief> weakness(const WeakPlace& weak, const Variation& variation,
                                     const maps::Point& place);

/// The same of ordinary ground that may only be believed to be less: by the process of the class, without other ground.
std::optional<GroundBelief> lowered(const WeakPlace& place, const Variation& variation,
                                    const maps::Point& at);

/// Two beliefs of the same ground, both of which must hold: the lesser mean and the lesser mean less six
/// standard deviations of the pull; the greater ones of the sinkage. In any order the same.
GroundBelief weaker(const GroundBelief& a, const GroundBelief& b) noexcept;

/// Bayesian generalised kernel inference (doherty_2019): a weighed mean of the evidence around a place,
/// conjugate to the prior.
///   mean = sum k y w / (1 + sum k w),  variance = prior / (1 + sum k w)
///   w = prior variance / measurement variance
GroundBelief kernelInference(const std::vector<PlaceEvidence>& evidence, const Variation& variation,
                             const maps::Point& place);

}  // namespace talus::costmap
