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

/// The soil posterior of a terrain class: how its mean pull departs from the prior's after all evidence.
struct ClassPosterior {
  Estimate pull;         ///< departure of drawbar pull over load [-]
  double own_std = 0.0;  ///< of that, if the readings shared no error [-]
  double shared = 0.0;   ///< what one standard deviation of the shared error moves the pull by [-]
  Estimate sinkage;      ///< departure of sinkage over radius [-]
  double places = 0.0;   ///< sum of the weights of all lessons, in independent places [-]
};

/// What learned ground has of its class.
struct ClassState {
  double pull = 0.0, pull_std = 0.0;   ///< as ClassPosterior::pull [-]
  double own_std = 0.0, shared = 0.0;  ///< as there [-]
  double sinkage = 0.0;                ///< departure of sinkage over radius [-]
  bool may_raise = false;  ///< whether enough places may raise that the belief in its ground may rise at all
  double most_rise = 0.0;  ///< the most by which it may [-]
  double pull_step = 0.0;  ///< how far `pull` may lie below what it was rounded from [-]
  double sinkage_step = 0.0;  ///< how far `sinkage` may lie above [-]

  friend bool operator==(const ClassState&, const ClassState&) = default;
};

/// Squares of ground about a correlation length wide, of which those are counted that lie as far apart.
class IndependentPlaces {
 public:
  using Square = std::pair<int, int>;  ///< column and row

  /// What is known of a square: how far its weakest ground departs from its class, -infinity where nothing may
  /// raise; nothing where nobody drove.
  void set(const Square& square, std::optional<float> departure);

  /// Places where somebody drove.
  std::size_t driven() const noexcept;
  /// The departure that so many of them reach or pass; -infinity where there are fewer.
  double agreed(std::size_t places) const noexcept;

 private:
  // Squares of one colour, of four, do not touch.
  struct Colour {
    std::map<Square, float> known;
    std::multiset<float> sorted;
  };
  std::array<Colour, 4> colours_;
};

/// What one block tells of its class.
struct BlockContribution {
  double weight = 0.0;            ///< independent places that it stands for [-]
  double pull = 0.0;              ///< departure from the prior [-]
  std::optional<double> sinkage;  ///< likewise; nothing where none was measured
  bool raises = false;            ///< whether it may raise, and make surer
  bool sinkage_raises = false;    ///< whether its sinkage may be less than that of the class
  double shared = 0.0;  ///< standard deviation by the error that it shares with all other lessons [-]
  std::uint16_t drive =
      0;  ///< whose readings alone may raise it, 0: of several; of a lesson that may not raise, its drive
};

/// What all blocks together tell of a class. Exact sums: a lesson can be taken out again, and the order in which
/// they come does not matter.
class ClassEvidence {
 public:
  explicit ClassEvidence(const GroundClass& ground) : ground_(ground) { refresh(); }

  void add(const BlockContribution& lesson) { sum(lesson, 1); }
  void remove(const BlockContribution& lesson) { sum(lesson, -1); }
  IndependentPlaces& places() noexcept { return places_; }
  /// After any change.
  void refresh();

  /// Conjugate normal update of the class mean (prior mean_std, places that scatter by pull_std about it). One
  /// place moves it by nothing, two by half, three as sum: what one place says it says of itself. It rises, and
  /// is surer, only where kPlaces places say so, and no higher than each of them. The error that all lessons share
  /// is one factor b of the regression, y_i = m + c_i b, b standard normal: of their mean, with the variance v of
  /// what they do not share, the posterior variance is p (v + c^2) / (p + v + c^2), p of the prior, c the mean of c_i.
  /// Lessons that may not raise count drive by drive: of the means of those that may and of any drives of the others the mean is
  /// the least (B12), so that a drive that may not raise never lifts it, nor changes its deviation. It is at most, too, what each drive by itself makes of
  /// it and one of its standard deviations, without the shared error: the sensors of one may be faulty, and which is not known.
  const ClassPosterior& posterior() const noexcept { return posterior_; }
  /// What learned ground has of the class, as it is.
  ClassState state() const noexcept;
  /// The same in steps of 0.005 (sinkage: 0.02), each number rounded towards danger and no deviation beyond the prior's:
  /// it stays what it is while the class moves within a step, and depends on nothing but the class. The greatest rise
  /// ends on a step of cost curves, which says no less than any rise up to the next.
  ClassState stateInSteps() const noexcept;
  /// Whether enough places may raise that the belief in ground of the class may rise at all.
  bool mayRaise() const noexcept { return std::isfinite(places_.agreed(kPlaces)) && drivesAgree(); }
  /// Whether no two drives that may raise differ in the class mean by more than 3 standard deviations of the difference.
  /// Otherwise the sensors of one are faulty, which one is not known, and nothing rises above the class.
  bool drivesAgree() const noexcept;
  /// The most by which it may: what as many places agree on; >= 0.
  double mostRise() const noexcept;

  static constexpr std::size_t kPlaces = 3;

 private:
  void sum(const BlockContribution& lesson, std::int64_t sign);

  // Sums over lessons: of their weights, and of weight times departure towards strength.
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
  WeightedSum pull_, sinkage_;  // of lessons that may raise
  ByDrive pull_by_drive_, lower_pull_, lower_sinkage_;
  IndependentPlaces places_;
  ClassPosterior posterior_;
};

}  // namespace talus::costmap
