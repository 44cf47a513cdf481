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

/// Posterior of a terrain class: departures of its mean from the prior after all evidence.
struct ClassPosterior {
  Estimate pull;         ///< departure of drawbar pull over load [-]
  double own_std = 0.0;  ///< standard deviation of `pull` without the shared error [-]
  double shared = 0.0;   ///< change of `pull` per standard deviation of the shared error [-]
  Estimate sinkage;      ///< departure of sinkage over radius [-]
  double places = 0.0;   ///< sum of the weights of all contributions, in independent places [-]
};

/// State of a class, from which estimates of its ground are computed.
struct ClassState {
  double pull = 0.0, pull_std = 0.0;   ///< departure of the mean drawbar pull over load, and its standard
                                       ///< deviation [-]
  double own_std = 0.0, shared = 0.0;  ///< as in ClassPosterior [-]
  double sinkage = 0.0;                ///< departure of sinkage over radius [-]
  bool may_raise = false;     ///< true if enough places have verified readings, so that estimates of the
                              ///< class may rise
  double most_rise = 0.0;     ///< greatest rise of an estimate [-]
  double pull_step = 0.0;     ///< rounding step: the exact value of `pull` is higher by at most this [-]
  double sinkage_step = 0.0;  ///< rounding step: the exact value of `sinkage` is lower by at most this [-]

  friend bool operator==(const ClassState&, const ClassState&) = default;
};

/// Squares of ground one correlation length wide, in four sets by even or odd column and row: squares of one
/// set do not touch, and count as independent places.
class IndependentPlaces {
 public:
  using Square = std::pair<int, int>;  ///< column and row

  /// Sets the departure of a square's weakest ground from its class. -infinity: no reading in the square may
  /// raise an estimate. nullopt: the square has no readings.
  void set(const Square& square, std::optional<float> departure);

  /// Greatest number of squares with readings in one set.
  std::size_t driven() const noexcept;
  /// Greatest departure that at least `places` squares of one set reach; -infinity if no set has so many
  /// squares.
  double agreed(std::size_t places) const noexcept;

 private:
  // Squares of one of the four sets.
  struct Colour {
    std::map<Square, float> known;
    std::multiset<float> sorted;
  };
  std::array<Colour, 4> colours_;
};

/// Contribution of one block to its class.
struct BlockContribution {
  double weight = 0.0;            ///< number of independent places that the block represents [-]
  double pull = 0.0;              ///< departure from the prior [-]
  std::optional<double> sinkage;  ///< departure from the prior; nullopt: not measured
  bool raises = false;            ///< true if the contribution may raise the class mean and reduce the
                                  ///< standard deviation
  bool sinkage_raises = false;    ///< true if the sinkage may be below that of the class
  double shared = 0.0;            ///< standard deviation by the error common to all contributions [-]
  std::uint16_t drive =
      0;  ///< drive of the readings that may raise an estimate, or of all readings if `raises` is false; 0:
          ///< several drives
};

/// Evidence of a class: the sum of the contributions of all blocks. Sums are exact (fixed point): a
/// contribution can be removed again, and the order of contributions has no effect.
class ClassEvidence {
 public:
  explicit ClassEvidence(const GroundClass& ground) : ground_(ground) { refresh(); }

  void add(const BlockContribution& contribution) { sum(contribution, 1); }
  void remove(const BlockContribution& contribution) { sum(contribution, -1); }
  IndependentPlaces& places() noexcept { return places_; }
  /// Recomputes the posterior. Required after each change of contributions or places.
  void refresh();

  /// Conjugate normal update of the class mean: prior standard deviation mean_std, places that scatter by
  /// pull_std (B12). The departure is multiplied by 0 for one independent place, by 0.5 for two, by 1 from
  /// three on: a single place cannot be distinguished from local variation. The mean rises, and its standard
  /// deviation decreases, only if kPlaces places may raise, and by at most mostRise(). The error common to
  /// all contributions is one factor b of the regression, y_i = m + c_i b, b standard normal. With v the
  /// variance of the mean without b, p the variance of the prior and c the mean of c_i, the posterior
  /// variance is p (v + c^2) / (p + v + c^2). Contributions that may not raise are summed for each drive. The
  /// mean is the least over all combinations of the contributions that may raise with any of these drives
  /// (B12), so that a drive that may not raise never increases the mean or changes its standard deviation.
  /// With several drives that may raise, the mean is at most the mean of each drive plus one standard
  /// deviation without the shared error, because the sensors of any drive may be faulty.
  const ClassPosterior& posterior() const noexcept { return posterior_; }
  /// State of the class, not rounded.
  ClassState state() const noexcept;
  /// State of the class in steps of 0.005 (sinkage: 0.02), each number rounded towards danger and no standard
  /// deviation above the prior's. The rounded state is constant while the exact state varies within a step,
  /// and depends on the class alone. `most_rise` is rounded down to a step of the cost curves.
  ClassState stateInSteps() const noexcept;
  /// True if kPlaces places may raise and the drives agree, so that estimates of the class may rise.
  bool mayRaise() const noexcept { return std::isfinite(places_.agreed(kPlaces)) && drivesAgree(); }
  /// True if no two drives that may raise differ in the class mean by more than 3 standard deviations of the
  /// difference. Otherwise the sensors of one of the drives are faulty, and no estimate rises above its
  /// class.
  bool drivesAgree() const noexcept;
  /// Greatest rise of the class [-]: the departure that kPlaces places reach, >= 0; 0 if mayRaise() is false.
  double mostRise() const noexcept;

  static constexpr std::size_t kPlaces = 3;

 private:
  void sum(const BlockContribution& contribution, std::int64_t sign);

  // Sums over contributions, in units of 2^-20: the weights, and weight times departure towards strength.
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
  WeightedSum pull_, sinkage_;  // of contributions that may raise
  ByDrive pull_by_drive_, lower_pull_, lower_sinkage_;
  IndependentPlaces places_;
  ClassPosterior posterior_;
};

}  // namespace talus::costmap
