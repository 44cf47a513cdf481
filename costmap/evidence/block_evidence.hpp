#pragma once

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
/// deviation 0.025 * 2^(g/2), 0.025 to 0.28 [-], and a grade of the shared error, which is common to all
/// readings. Pulls that may raise an estimate (of verified sensors) have one kind for each pair of both
/// grades. Pulls that may only lower an estimate have one kind for each grade of certainty. If a block has
/// several bounds, the strictest bound applies, independent of the number of other readings.
namespace reading_kind {
inline constexpr std::uint8_t kGrades = 8;        ///< number of grades of certainty
inline constexpr std::uint8_t kSharedGrades = 8;  ///< number of grades of the shared error
/// kPull + g + 8 h is the kind of a pull that may raise an estimate, with the grade of certainty g and the
/// grade h of the shared error.
inline constexpr std::uint8_t kPull = 0;
/// kPullLowers + g is the kind of a pull that may only lower an estimate, with the grade of certainty g.
inline constexpr std::uint8_t kPullLowers = kGrades * kSharedGrades;
/// Kind of sinkages that may raise an estimate of the strength.
inline constexpr std::uint8_t kSinkage = kPullLowers + kGrades;
/// Kind of sinkages that may only lower an estimate of the strength.
inline constexpr std::uint8_t kSinkageLowers = kSinkage + 1;
inline constexpr std::uint8_t kMostPullHere = kSinkage + 2;      ///< upper bound of DP/W
inline constexpr std::uint8_t kLeastSinkageHere = kSinkage + 3;  ///< lower bound of z/r
inline constexpr std::uint8_t kCount = kSinkage + 4;             ///< number of kinds
}  // namespace reading_kind

/// Returns the standard deviation of DP/W for a grade of the shared error [-]: 0 for grade 0, and 0.02 *
/// 1.5^(grade - 1) for the grades 1 to 7.
double sharedStd(std::size_t grade) noexcept;

/// Returns a drawbar pull over load DP/W as a reading in steps of 0.01 from -1.28, rounded to nearest if the
/// reading may raise an estimate, and rounded down otherwise. `shared_std` >= 0 is the standard deviation of
/// the error common to all readings [-]; it is rounded up to a grade. A reading whose shared error exceeds
/// the greatest grade or is unknown (NaN) may only lower an estimate.
ReadingCount pullReading(const Estimate& pull, bool may_raise, double shared_std = 0.0) noexcept;
/// Returns a sinkage over wheel radius z/r as a reading in steps of 0.01 from 0, rounded up. `may_raise` is
/// true if the reading may raise an estimate of the strength.
ReadingCount sinkageReading(double sinkage_over_radius, bool may_raise) noexcept;

/// Returns the bounds of a block as readings; empty if neither pull nor sinkage is bounded.
std::vector<ReadingCount> boundReadings(const GroundBound& bound);

/// Evidence of one terrain class in a block, computed from the counts of its readings.
struct BlockEvidence {
  static constexpr std::uint16_t kTop = 0xffff;  ///< value of `level` for the surface

  std::uint16_t level = kTop;       ///< kTop; another value belongs to a level that no map has
  std::uint8_t terrain_class = 0;   ///< number of the terrain class
  std::uint8_t place_in_brick = 0;  ///< index of the block within its brick, set by EvidenceBricks
  std::uint32_t updated_s = 0;      ///< telemetry time of the newest reading, rounded down [s]
  std::uint8_t reach = 0;           ///< position uncertainty of the readings, in steps of 0.1 m
  bool sinkage_raises = false;      ///< true if readings may lower the sinkage below that of the class
  bool lowers = false;              ///< true if the block has pull readings that may only lower an estimate
  float pull = 0.0F;       ///< DP/W from the readings that may raise an estimate [-]; NaN: no such reading
  float variance = 0.0F;   ///< variance of `pull` without the shared error [-]
  float shared = 0.0F;     ///< standard deviation of `pull` by the shared error [-]
  float weak_pull = 0.0F;  ///< DP/W of the weakest part of all readings, see summarise() [-]; NaN: no reading
  float weak_variance = 0.0F;  ///< variance of `weak_pull` [-]
  float sinkage = 0.0F;  ///< z/r of the deepest part of all readings, see summarise() [-]; NaN: not measured
  float most_pull = 0.0F;      ///< least upper bound of DP/W [-]; NaN: no bound
  float least_sinkage = 0.0F;  ///< greatest lower bound of z/r [-]; NaN: no bound

  /// Returns the position uncertainty of the readings [m].
  double reach_m() const noexcept { return 0.1 * reach; }
};
static_assert(sizeof(BlockEvidence) == 44);

/// Computes the fields `sinkage_raises` to `least_sinkage` of `block` from its counts. `prior` is the DP/W of
/// the terrain class with its standard deviation between places [-].
///
/// The n readings of one grade of certainty give the least value over k of m_k + sigma c(k/n) (ours). m_k is
/// the mean of the k lowest readings, and sigma is the standard deviation of the grade. Noise alone lowers
/// m_k by sigma c(k/n), where c(p) = phi(Phi^-1(p))/p is the mean of the lower tail of the standard normal
/// distribution (density phi, distribution function Phi) with reversed sign. The variance includes the model
/// error, 0.02 in DP/W, which is common to all readings of a block. With several drives, `pull` is at most
/// the bound of each drive, because the sensors of any drive may be faulty. The bound of a drive is its mean,
/// plus two standard errors of its own scatter if these exceed 0.02. With n drives, the least bound is raised
/// by 0.02 (c(1/n) - c(1/2)), the expected difference between the least of n and the least of two sound
/// drives. `shared` is the mean shared error of the readings that may raise an estimate, weighted by inverse
/// variance: more readings do not reduce `shared`.
void summarise(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block);

/// drivesOf() returns the numbers of the drives among the counts, ascending, without duplicates. ofDrive()
/// returns the counts of one drive.
std::vector<std::uint16_t> drivesOf(std::span<const ReadingCount> counts);
std::vector<ReadingCount> ofDrive(std::span<const ReadingCount> counts, std::uint16_t drive);

/// Returns the number of pull readings, each weighted by (0.05/std)^2 [-].
double samples(std::span<const ReadingCount> counts) noexcept;

}  // namespace talus::costmap
