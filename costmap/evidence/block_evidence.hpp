#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/ground/ground_model.hpp>

/// Evidence of one block: counts of quantised readings, and the numbers computed from the counts. A block is
/// a square of cells whose evidence is stored together. The order of readings has no effect: equal readings
/// give bit-identical results.
namespace talus::costmap {

/// Number of equal quantised readings of one drive in one block, at most 65535 (saturated).
struct ReadingCount {
  std::uint8_t kind = 0;    ///< measured quantity and certainty of the reading, a number of reading_kind
  std::uint8_t step = 0;    ///< value in steps of 0.01, see pullReading() and sinkageReading()
  std::uint16_t count = 0;  ///< number of readings
  std::uint16_t drive = 0;  ///< number of the drive (WheelObservation::drive)

  friend bool operator==(const ReadingCount&, const ReadingCount&) = default;
};

/// Kinds of readings. A drawbar pull over load DP/W has one of eight grades g of certainty with the standard
/// deviation 0.025 * 2^(g/2), 0.025 to 0.28 [-]. Pulls of verified sensors have, in addition, a grade of the
/// error that is common to all readings of their drive.
namespace reading_kind {
inline constexpr std::uint8_t kGrades = 8;        ///< number of grades of certainty
inline constexpr std::uint8_t kSharedGrades = 8;  ///< number of grades of the shared error
/// kPull + g + 8 h is the kind of a pull of verified sensors, with the grade of certainty g and the grade h of
/// the shared error.
inline constexpr std::uint8_t kPull = 0;
/// kPullUnverified + g is the kind of a pull of other sensors, with the grade of certainty g.
inline constexpr std::uint8_t kPullUnverified = kGrades * kSharedGrades;
/// Kinds of sinkages of verified and of other sensors.
inline constexpr std::uint8_t kSinkage = kPullUnverified + kGrades;
inline constexpr std::uint8_t kSinkageUnverified = kSinkage + 1;
inline constexpr std::uint8_t kMostPullHere = kSinkage + 2;      ///< upper bound of DP/W
inline constexpr std::uint8_t kLeastSinkageHere = kSinkage + 3;  ///< lower bound of z/r
/// kPullTwice + g + 8 h is the kind of a pull whose slip was measured twice.
inline constexpr std::uint8_t kPullTwice = kSinkage + 4;
inline constexpr std::uint8_t kCount = kPullTwice + kGrades * kSharedGrades;  ///< number of kinds
}  // namespace reading_kind

/// Returns the standard deviation of DP/W for a grade of the shared error [-]: 0 for grade 0, and 0.02 *
/// 1.5^(grade - 1) for the grades 1 to 7.
double sharedStd(std::size_t grade) noexcept;

/// Returns a drawbar pull over load DP/W as a reading, in steps of 0.01 from -1.28. `shared_std` >= 0 is the
/// standard deviation of the error common to all readings of the drive [-], rounded up to a grade. A reading
/// whose shared error exceeds the greatest grade or is unknown (NaN) counts as unverified.
ReadingCount pullReading(const Estimate& pull, Trust trust, double shared_std = 0.0) noexcept;
/// Returns a sinkage over wheel radius z/r as a reading in steps of 0.01 from 0.
ReadingCount sinkageReading(double sinkage_over_radius, bool verified) noexcept;

/// Returns the bounds of a block as readings, rounded towards danger; empty if neither pull nor sinkage is
/// bounded.
std::vector<ReadingCount> boundReadings(const GroundBound& bound);

/// Readings with a common error: those of one drive whose sensors were verified in the same way.
struct Source {
  std::uint16_t drive = 0;
  Trust trust = Trust::Unverified;

  auto operator<=>(const Source&) const = default;  // NOLINT(modernize-use-nullptr): of clang 14
};

/// Mean drawbar pull over load DP/W of the readings of one source in one block.
struct SourcePull {
  Source source;
  double weight = 0.0;  ///< sum of inverse variances, > 0 [-]
  double pull = 0.0;    ///< mean DP/W, weighted by inverse variance [-]
  double shared = 0.0;  ///< standard deviation of the error common to all readings of the source [-]

  /// Returns the variance of `pull` without the shared error: 1/weight, and the model error 0.02 squared,
  /// which is common to all readings of a block.
  double variance() const noexcept;
};

/// Returns the pulls of a block by source, in ascending order.
std::vector<SourcePull> pullsOf(std::span<const ReadingCount> counts);

/// Evidence of one terrain class in a block, computed from the counts of its readings.
struct BlockEvidence {
  std::uint8_t terrain_class = 0;   ///< number of the terrain class
  std::uint8_t place_in_brick = 0;  ///< index of the block within its brick, set by EvidenceBricks
  std::uint32_t updated_s = 0;      ///< telemetry time of the newest reading, rounded down [s]
  std::uint8_t reach = 0;           ///< position uncertainty of the readings, in steps of 0.1 m
  float pull = 0.0F;                ///< mean DP/W of all sources [-]; NaN: no reading
  float sinkage = 0.0F;             ///< mean z/r of verified sensors, or of the others [-]; NaN: not measured
  bool sinkage_verified = false;    ///< true if `sinkage` is of verified sensors
  float most_pull = 0.0F;           ///< least upper bound of DP/W [-]; NaN: no bound
  float least_sinkage = 0.0F;       ///< greatest lower bound of z/r [-]; NaN: no bound

  /// Returns the position uncertainty of the readings [m].
  double reach_m() const noexcept { return 0.1 * reach; }
};
static_assert(sizeof(BlockEvidence) == 32);

/// Computes the fields `pull` to `least_sinkage` of `block` from its counts.
void summarise(std::span<const ReadingCount> counts, BlockEvidence& block);

/// Returns the number of pull readings, each weighted by (0.05/std)^2 [-].
double samples(std::span<const ReadingCount> counts) noexcept;

}  // namespace talus::costmap
