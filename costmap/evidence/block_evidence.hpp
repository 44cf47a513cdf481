#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/ground/ground_model.hpp>

/// What a block of ground has heard, as counts of quantised readings, and what follows from it. Counts have no
/// order: the same readings in any order are the same evidence, to the bit.
namespace talus::costmap {

/// How often a block heard one quantised reading of one drive; stops at 65535.
struct ReadingCount {
  std::uint8_t kind = 0;  ///< what it measures and how surely: see kindOf
  std::uint8_t step = 0;  ///< its value, rounded towards danger
  std::uint16_t count = 0;
  std::uint16_t drive = 0;  ///< WheelObservation::drive

  friend bool operator==(const ReadingCount&, const ReadingCount&) = default;
};

/// Kinds of pull are eight grades of certainty, of standard deviation 0.025 to 0.28: of readings that may only lower the
/// belief, and, for each of eight grades of the error that all readings share, of those that may raise it. Bounds are
/// of the block itself: the least of them holds, however many other readings there are.
namespace reading_kind {
inline constexpr std::uint8_t kGrades = 8;
inline constexpr std::uint8_t kSharedGrades = 8;
inline constexpr std::uint8_t kPull = 0;  ///< grade of certainty, and eight times that of the shared error
inline constexpr std::uint8_t kPullLowers = kGrades * kSharedGrades;  ///< and the seven behind it
inline constexpr std::uint8_t kSinkage = kPullLowers + kGrades;
inline constexpr std::uint8_t kSinkageLowers = kSinkage + 1;
inline constexpr std::uint8_t kMostPullHere = kSinkage + 2;
inline constexpr std::uint8_t kLeastSinkageHere = kSinkage + 3;
inline constexpr std::uint8_t kCount = kSinkage + 4;
}  // namespace reading_kind

/// Standard deviation of drawbar pull over load that a grade of the shared error stands for [-]: 0, then 0.02 times 1.5
/// to the power of 0 to 6.
double sharedStd(std::size_t grade) noexcept;

/// The count that a drawbar pull over load goes into: steps of 0.01 from -1.28, of one that may only lower rounded down. `shared_std`: of the
/// error that it shares with all other readings, >= 0 [-], rounded up; a reading beyond the greatest grade, or of an
/// error that is not known (NaN), may only lower.
ReadingCount pullReading(const Estimate& pull, bool may_raise, double shared_std = 0.0) noexcept;
/// The same of sinkage over radius: steps of 0.01 from 0, rounded up.
ReadingCount sinkageReading(double sinkage_over_radius, bool may_raise) noexcept;

/// The counts that bounds of a block go into, likewise; of no pull or sinkage, nothing.
std::vector<ReadingCount> boundReadings(const GroundBound& bound);

/// What a block's counts come to.
struct BlockEvidence {
  static constexpr std::uint16_t kTop = 0xffff;  ///< the level that a map's elevation shows

  std::uint16_t level = kTop;       ///< kTop, or the octree's height key of a floor beneath it
  std::uint8_t terrain_class = 0;   ///< number of the class that it speaks for
  std::uint8_t place_in_brick = 0;  ///< the store's own
  std::uint32_t updated_s = 0;      ///< telemetry time of the newest sample, rounded down [s]
  std::uint8_t reach = 0;           ///< how far off the place may be, in steps of 0.1 m
  bool sinkage_raises = false;      ///< whether the sinkage may be believed where it is less than the class's
  bool lowers = false;              ///< whether some of its readings may only lower
  float pull = 0.0F;                ///< by readings that may raise: drawbar pull over load [-]; NaN: none
  float variance = 0.0F;            ///< of that, without the shared error
  float shared = 0.0F;              ///< of that: standard deviation by the error that all readings share [-]
  float weak_pull = 0.0F;           ///< of the part of all its readings that makes it weakest [-]; NaN: none
  float weak_variance = 0.0F;       ///< of that
  float sinkage = 0.0F;             ///< of its deepest part: sinkage over radius [-]; NaN: none was measured
  float most_pull = 0.0F;           ///< least bound of its drawbar pull over load [-]; NaN: none
  float least_sinkage = 0.0F;       ///< greatest bound of its sinkage over radius [-]; NaN: none

  double reach_m() const noexcept { return 0.1 * reach; }
};
static_assert(sizeof(BlockEvidence) == 44);

/// Works out the numbers from pull to sinkage_raises; `prior`: of its class, place to place.
///
/// Readings of one certainty are as weak as their weakest part: the least of m_k + sigma c(k/n), m_k the mean
/// of the k lowest of n and -sigma c(k/n) what it would be by noise alone (mean of the lower tail of a normal,
/// c(p) = phi(Phi^-1(p))/p; ours). No number of readings makes the pull surer than the model, 0.02 in DP/W:
/// what one place says is wrong in one way. Of several drives none makes the place stronger than another shows it:
/// the sensors of one may be faulty, and which is not known. A drive whose mean is known no better than to within 0.02, by two
/// standard errors of its own scatter, bounds it by so much more, and of n drives each by 0.02 (c(1/n) - c(1/2)) more, so that the
/// least of many sound ones is no lower than all of them. The shared error of the pull is the mean of that of its
/// readings, each weighed by its certainty: no number of readings makes it smaller.
void summarise(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block);

/// The drives that have readings among counts, ascending, and the readings of one.
std::vector<std::uint16_t> drivesOf(std::span<const ReadingCount> counts);
std::vector<ReadingCount> ofDrive(std::span<const ReadingCount> counts, std::uint16_t drive);

/// Readings behind the pull, each weighed by its certainty: one of standard deviation 0.05 counts one.
double samples(std::span<const ReadingCount> counts) noexcept;

}  // namespace talus::costmap
