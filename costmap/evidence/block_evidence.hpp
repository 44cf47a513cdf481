#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/ground/ground_model.hpp>

/// Evidence of one block of ground: counts of quantised readings, and the numbers computed from the counts.
/// The order of readings has no effect: equal readings give bitwise equal results.
namespace talus::costmap {

/// Number of times that a block received one quantised reading of one drive, at most 65535 (saturated).
struct ReadingCount {
  std::uint8_t kind = 0;    ///< measured quantity and grade of certainty (reading_kind)
  std::uint8_t step = 0;    ///< value in steps of 0.01: pullReading(), sinkageReading()
  std::uint16_t count = 0;  ///< number of readings
  std::uint16_t drive = 0;  ///< WheelObservation::drive

  friend bool operator==(const ReadingCount&, const ReadingCount&) = default;
};

/// Kinds of readings. A pull has one of eight grades g of certainty, standard deviation 0.025 * 2^(g/2),
/// 0.025 to 0.28 [-]. Pulls that may raise an estimate have one kind for each pair of a grade of certainty
/// and a grade of the shared error. Pulls that may only lower an estimate have one kind for each grade of
/// certainty. Of several bounds of a block the strictest applies, independent of the number of other
/// readings.
namespace reading_kind {
inline constexpr std::uint8_t kGrades = 8;        ///< number of grades of certainty
inline constexpr std::uint8_t kSharedGrades = 8;  ///< number of grades of the shared error
inline constexpr std::uint8_t kPull = 0;          ///< plus grade of certainty + 8 x grade of shared error
inline constexpr std::uint8_t kPullLowers = kGrades * kSharedGrades;  ///< plus grade of certainty
inline constexpr std::uint8_t kSinkage = kPullLowers + kGrades;       ///< sinkage that may raise an estimate
inline constexpr std::uint8_t kSinkageLowers = kSinkage + 1;     ///< sinkage that may only lower an estimate
inline constexpr std::uint8_t kMostPullHere = kSinkage + 2;      ///< upper bound of the pull
inline constexpr std::uint8_t kLeastSinkageHere = kSinkage + 3;  ///< lower bound of the sinkage
inline constexpr std::uint8_t kCount = kSinkage + 4;             ///< number of kinds
}  // namespace reading_kind

/// Standard deviation of drawbar pull over load for a grade of the shared error [-]: 0 for grade 0, 0.02 *
/// 1.5^(grade - 1) for grades 1 to 7.
double sharedStd(std::size_t grade) noexcept;

/// Quantises a drawbar pull over load in steps of 0.01 from -1.28: rounded to nearest if the reading may
/// raise an estimate, else rounded down. `shared_std`: standard deviation of the error common to all
/// readings, >= 0 [-], rounded up to a grade. A reading whose shared error exceeds the greatest grade or is
/// unknown (NaN) may only lower an estimate.
ReadingCount pullReading(const Estimate& pull, bool may_raise, double shared_std = 0.0) noexcept;
/// Quantises a sinkage over radius in steps of 0.01 from 0, rounded up.
ReadingCount sinkageReading(double sinkage_over_radius, bool may_raise) noexcept;

/// Quantises the bounds of a block; empty if neither pull nor sinkage is bounded.
std::vector<ReadingCount> boundReadings(const GroundBound& bound);

/// Numbers computed from the counts of one class on one level of a block.
struct BlockEvidence {
  static constexpr std::uint16_t kTop = 0xffff;  ///< level of the top surface

  std::uint16_t level = kTop;       ///< kTop, or the octree's height key of a floor below the top surface
  std::uint8_t terrain_class = 0;   ///< number of the terrain class
  std::uint8_t place_in_brick = 0;  ///< index of the block within its brick, set by EvidenceBricks
  std::uint32_t updated_s = 0;      ///< telemetry time of the newest sample, rounded down [s]
  std::uint8_t reach = 0;           ///< position uncertainty of the place, in steps of 0.1 m
  bool sinkage_raises = false;      ///< true if a sinkage below that of the class is accepted
  bool lowers = false;              ///< true if some pull readings may only lower an estimate
  float pull = 0.0F;                ///< DP/W from readings that may raise an estimate [-]; NaN: no such
                                    ///< reading
  float variance = 0.0F;            ///< variance of `pull` without the shared error [-]
  float shared = 0.0F;              ///< standard deviation of `pull` by the shared error [-]
  float weak_pull = 0.0F;           ///< DP/W of the weakest subset of all readings [-]; NaN: no reading
  float weak_variance = 0.0F;       ///< variance of `weak_pull` [-]
  float sinkage = 0.0F;             ///< z/r of the deepest subset of all readings [-]; NaN: not measured
  float most_pull = 0.0F;           ///< least upper bound of DP/W [-]; NaN: no bound
  float least_sinkage = 0.0F;       ///< greatest lower bound of z/r [-]; NaN: no bound

  /// Position uncertainty of the place [m].
  double reach_m() const noexcept { return 0.1 * reach; }
};
static_assert(sizeof(BlockEvidence) == 44);

/// Computes the fields `sinkage_raises` to `least_sinkage` of `block`. `prior`: drawbar pull over load of the
/// class and its standard deviation between places [-].
///
/// Readings of one grade of certainty give the least value over k of m_k + sigma c(k/n) (ours): m_k is the
/// mean of the k lowest of n readings. Noise alone lowers m_k by sigma c(k/n), where c(p) = phi(Phi^-1(p))/p
/// is the mean of the lower tail of the standard normal distribution (density phi, distribution function
/// Phi). The variance includes the model error, 0.02 in DP/W, which is common to all readings of a place.
/// With several drives, `pull` is at most the bound of each drive, because the sensors of any drive may be
/// faulty. The bound of a drive is its mean, plus two standard errors of its own scatter if these exceed
/// 0.02. With n drives the least bound is raised by 0.02 (c(1/n) - c(1/2)), the expected difference between
/// the least of n and the least of two sound drives. `shared` is the mean shared error of the readings,
/// weighted by inverse variance: more readings do not reduce `shared`.
void summarise(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block);

/// Numbers of the drives among the counts, ascending, without duplicates; and the counts of one drive.
std::vector<std::uint16_t> drivesOf(std::span<const ReadingCount> counts);
std::vector<ReadingCount> ofDrive(std::span<const ReadingCount> counts, std::uint16_t drive);

/// Number of pull readings, each weighted by (0.05/std)^2 [-].
double samples(std::span<const ReadingCount> counts) noexcept;

}  // namespace talus::costmap
