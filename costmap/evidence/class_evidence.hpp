#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <talus/costmap/evidence/block_evidence.hpp>

namespace talus::costmap {

/// What one combination of sound and faulty sources makes of a terrain class. A source is the readings of one
/// drive with a common error. Departures are differences from the prior of the class.
struct ClassHypothesis {
  double weight = 1.0;  ///< posterior probability [-]
  double pull = 0.0;    ///< departure of the mean drawbar pull over load DP/W [-]
  /// Standard deviation of `pull` by the places that were not driven [-].
  double own_std = 0.0;
  /// Standard deviation of `pull` by the errors common to all readings of a source [-].
  double shared_std = 0.0;
  /// The sound sources, ascending, and the mean of the common error of each [-].
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
/// standard deviation 2 q and tells nothing about D. Sensors are faulty with the probability 0.001 if the slip
/// was measured twice, 0.07 if once, 0.5 if they were not verified (ours). Each combination of faulty sources is
/// one hypothesis. Its probability is the product of the prior and of the densities of y_s, given those before;
/// its D the mean by conjugate normal updates. The kMost most probable are kept.
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
  // Sums in units of 2^-20: of the weights, and of weight times departure and shared error.
  struct Sums {
    std::int64_t weight = 0, departure = 0, shared = 0;
  };

  GroundClass ground_;
  std::int64_t places_ = 0;
  std::map<Source, Sums> sources_;
  Sums sinkage_;
};

}  // namespace talus::costmap
