#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Posterior of a terrain class: departures of the class mean from the prior after all evidence.
struct ClassPosterior {
  Estimate pull;  ///< departure of the mean drawbar pull over load DP/W [-]
  /// Standard deviation of `pull` without the error that is common to all contributions [-].
  double own_std = 0.0;
  double shared = 0.0;  ///< change of `pull` per standard deviation of the common error [-]
  Estimate sinkage;     ///< departure of the mean sinkage over wheel radius z/r [-]
  double places = 0.0;  ///< sum of the weights of all contributions, i.e. number of independent places [-]
};

/// State of a terrain class, from which estimates of its ground are computed. Departures are differences from
/// the prior.
struct ClassState {
  double pull = 0.0, pull_std = 0.0;   ///< departure of the mean drawbar pull over load, and its standard
                                       ///< deviation [-]
  double own_std = 0.0, shared = 0.0;  ///< the quantities of the same names in ClassPosterior [-]
  double sinkage = 0.0;                ///< departure of the mean sinkage over wheel radius [-]
  /// True if estimates of the class may increase, because enough places have readings of verified sensors.
  bool may_raise = false;
  double most_rise = 0.0;     ///< greatest increase of an estimate [-]
  double pull_step = 0.0;     ///< rounding step: the exact value exceeds `pull` by at most this step [-]
  double sinkage_step = 0.0;  ///< rounding step: the exact value is below `sinkage` by at most this step [-]

  friend bool operator==(const ClassState&, const ClassState&) = default;
};

/// Set of independent places. Places are squares with sides of one correlation length, in four sets by even
/// or odd column and row. Squares of one set do not touch and count as independent.
class IndependentPlaces {
 public:
  using Square = std::pair<int, int>;  ///< column and row

  /// Sets the departure of DP/W of a square's weakest ground from its class. -infinity means that no reading
  /// in the square may raise an estimate; nullopt means that the square has no readings.
  void set(const Square& square, std::optional<float> departure);

  /// Returns the number of squares with readings in that of the four sets with the most such squares.
  std::size_t driven() const noexcept;
  /// Returns the greatest departure that at least `places` squares of one set reach or exceed; -infinity if
  /// no set has so many squares.
  double agreed(std::size_t places) const noexcept;

 private:
  // Squares of one of the four sets.
  struct Colour {
    std::map<Square, float> known;
    std::multiset<float> sorted;
  };
  std::array<Colour, 4> colours_;
};

/// Contribution of one block (square of cells whose evidence is stored together) to the evidence of its
/// terrain class.
struct BlockContribution {
  double weight = 0.0;            ///< number of independent places that the block represents [-]
  double pull = 0.0;              ///< departure of DP/W from the prior [-]
  std::optional<double> sinkage;  ///< departure of z/r from the prior [-]; nullopt: not measured
  /// True if the contribution may increase the class mean and reduce its standard deviation.
  bool raises = false;
  /// True if the contribution may lower the mean sinkage of the class below the prior.
  bool sinkage_raises = false;
  double shared = 0.0;  ///< standard deviation of `pull` by the error that is common to all contributions [-]
  /// Number of the drive with the readings that may raise an estimate, or with all readings if `raises` is
  /// false; 0: several drives.
  std::uint16_t drive = 0;
};

/// Evidence of a terrain class: the sum of the contributions of all blocks. Sums are exact (fixed point): a
/// contribution can be removed again, and the order of contributions has no effect.
class ClassEvidence {
 public:
  explicit ClassEvidence(const GroundClass& ground) : ground_(ground) { refresh(); }

  void add(const BlockContribution& contribution) { sum(contribution, 1); }
  void remove(const BlockContribution& contribution) { sum(contribution, -1); }
  IndependentPlaces& places() noexcept { return places_; }
  /// Recomputes the posterior. Must be called after each change of contributions or places.
  void refresh();

  /// Returns the posterior of the class mean m, computed as follows:
  ///   - Conjugate normal update with the prior standard deviation mean_std and places that scatter by
  ///     pull_std (B12).
  ///   - The departure of m from the prior is multiplied by 0 for one independent place, by 0.5 for two, and
  ///     by 1 from three on: a single place cannot be distinguished from local variation.
  ///   - m increases, and its standard deviation decreases, only if kPlaces places have contributions that
  ///     may raise m. The increase is at most mostRise().
  ///   - The error common to all contributions is one factor b, standard normal, of the regression
  ///     y_i = m + c_i b of the contributions y_i. With v the variance of m without b, p the variance of the
  ///     prior and c the mean of c_i, the posterior variance is p (v + c^2) / (p + v + c^2).
  ///   - Contributions that may not raise m are summed for each drive. m is the least mean over all subsets
  ///     of these drives, each combined with the contributions that may raise m (B12). A drive whose
  ///     contributions may not raise m therefore never increases m or changes its standard deviation.
  ///   - If several drives may raise m, m is at most the mean of each of these drives plus one standard
  ///     deviation without b, because the sensors of any drive may be faulty.
  const ClassPosterior& posterior() const noexcept { return posterior_; }
  /// Returns the state of the class, not rounded.
  ClassState state() const noexcept;
  /// Returns the state of the class in steps of 0.005 (sinkage: 0.02), with each number rounded towards
  /// danger and no standard deviation above that of the prior. The rounded state is constant while the exact
  /// state varies within a step, and depends on the class alone. `most_rise` is rounded down to a step of the
  /// cost curves (GroundKind::kPullStep).
  ClassState stateInSteps() const noexcept;
  /// Returns true if kPlaces independent places have readings that may raise an estimate and the drives
  /// agree: estimates of the class may then increase.
  bool mayRaise() const noexcept { return std::isfinite(places_.agreed(kPlaces)) && drivesAgree(); }
  /// Returns true if no two drives with readings that may raise an estimate differ in the class mean by more
  /// than 3 standard deviations of the difference. Otherwise the sensors of one of the drives are faulty, and
  /// no estimate exceeds the prior of its class.
  bool drivesAgree() const noexcept;
  /// Returns the greatest increase of the class mean [-]: the departure, >= 0, that kPlaces places reach; 0
  /// if mayRaise() is false.
  double mostRise() const noexcept;

  /// Number of independent places that are required for an increase.
  static constexpr std::size_t kPlaces = 3;

 private:
  void sum(const BlockContribution& contribution, std::int64_t sign);

  // Sums over contributions, in units of 2^-20: sum of the weights, and sum of weight times departure,
  // positive towards strength.
  struct WeightedSum {
    std::int64_t weight = 0, departure = 0;
    void add(const WeightedSum& other) noexcept;
  };
  using ByDrive = std::map<std::uint16_t, WeightedSum>;
  static void add(std::uint16_t drive, const WeightedSum& sum, ByDrive& drives);
  double meanOf(const WeightedSum& sum) const noexcept;
  double deviationOf(const WeightedSum& sum) const noexcept;
  double leastMean(WeightedSum raising, const ByDrive& lowering) const;
  double mostByDrives() const noexcept;

  GroundClass ground_;
  std::int64_t shared_ = 0;
  WeightedSum pull_, sinkage_;  // sums of contributions that may raise an estimate
  ByDrive pull_by_drive_, lower_pull_, lower_sinkage_;
  IndependentPlaces places_;
  ClassPosterior posterior_;
};

}  // namespace talus::costmap
