#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// Measurements of one wheel at one moment, without corrections. A quantity that was not measured is NaN.
struct TelemetryReading {
  double time_s = 0.0;
  maps::Point place;                                      ///< position of the wheel on the map [m]
  double z_m = std::numeric_limits<double>::quiet_NaN();  ///< elevation of the wheel, for the journal alone
  double load_N = 0.0;                                    ///< load on the wheel, > 0
  double slip = 0.0;                                      ///< slip, -1 to 1 [-]
  double torque_Nm = 0.0;                                 ///< torque of the wheel
  double sinkage_m = 0.0;
  double gradient = 0.0;  ///< gradient of the ground along the heading, rise over run [-]
  /// `across` is the gradient of the ground to the left of the heading, rise over run [-]. `slip_angle_rad`
  /// is the angle from the wheel plane to the direction of travel, left positive.
  double across = std::numeric_limits<double>::quiet_NaN();
  double slip_angle_rad = std::numeric_limits<double>::quiet_NaN();
  double drawbar_pull_N = 0.0;  ///< drawbar pull of the wheel, measured on a test stand
  double pose_std_m = 0.0;      ///< position uncertainty, one standard deviation
  int pass = 1;                 ///< pass number at this place: 1 on undisturbed ground, >= 2 in a rut
  /// Slip computed from rim speed and rover speed [-].
  double speed_slip = std::numeric_limits<double>::quiet_NaN();
};

/// Bounds of the strength of the ground under a measured wheel, independent of all other evidence. NaN: no
/// bound.
struct GroundBound {
  double most_pull = std::numeric_limits<double>::quiet_NaN();      ///< upper bound of drawbar pull over
                                                                    ///< load [-]
  double least_sinkage = std::numeric_limits<double>::quiet_NaN();  ///< lower bound of sinkage over radius
                                                                    ///< [-]

  /// Returns true if the pull or the sinkage has a bound.
  bool any() const noexcept { return !std::isnan(most_pull) || !std::isnan(least_sinkage); }
  /// Lowers the upper bound of DP/W to `pull` [-] if `pull` is lower.
  void lower(double pull) noexcept { most_pull = std::fmin(most_pull, pull); }
  /// Adopts the stricter of its own and another bound of each quantity.
  void join(const GroundBound& other) noexcept {
    lower(other.most_pull);
    least_sinkage = std::fmax(least_sinkage, other.least_sinkage);
  }
};

/// A reading and the terrain class of the ground under the wheel, as an index into
/// GroundModel::Parts::classes.
struct ClassReading {
  int class_index = 0;
  TelemetryReading reading;
};

/// Measurement errors, one standard deviation each [-].
struct ReadingNoise {
  double slip = 0.03;           ///< error of the slip
  double gradient = 0.01;       ///< error of the gradient along the heading, rise over run
  double torque_share = 0.05;   ///< relative error of the torque T/(W r)
  double sinkage_share = 0.05;  ///< relative error of the sinkage z/r, and its effect on DP/W
  double mobilised = 0.15;      ///< error of T/(W r) at the reference slip, per unit of growth factor - 1
  /// Error of the drawbar pull over load DP/W by thesis Eq. 3.12 and by the assumed shares of the wheels.
  double model_pull = 0.02;
};

/// How the sensors of a reading were verified: not; by one slip (DrivePosterior); by two independent slips.
enum class Trust : std::uint8_t { Unverified, Once, Twice };

/// Wheel observation: the result of one reading. It contains an estimate of the ground under the wheel at the
/// reference slip 0.5, a bound of the ground at that place, or both.
struct WheelObservation {
  double time_s = 0.0;
  maps::Point place;
  Estimate pull;  ///< estimated drawbar pull over load DP/W of the ground [-]
  /// Estimated sinkage over wheel radius z/r [-]; infinite standard deviation: not measured.
  Estimate sinkage;
  /// Standard deviation of `pull` due to errors common to all readings, for example of the slip; more readings
  /// do not reduce these errors; >= 0 [-]. NaN: unknown, and `pull` counts as unverified.
  double shared_std = 0.0;
  /// Thrust of the terrain class at the measured slip over its thrust at the reference slip [-].
  double share = 1.0;
  double pose_std_m = 0.0;          ///< position uncertainty, one standard deviation
  Trust trust = Trust::Unverified;  ///< how the sensors of `pull` were verified
  /// Number of the drive (driveTag()), because the sensors of each drive have their own errors.
  std::uint16_t drive = 0;
  GroundBound here{};  ///< bounds of the ground at this place

  /// Returns true if the observation contains an estimate of the pull.
  bool estimates() const noexcept { return std::isfinite(pull.value) && pull.std > 0.0 && pull.std <= 0.5; }
};

/// Converts readings to observations, i.e. to estimates of undisturbed ground at the reference slip 0.5.
///
/// Slope: the wheels of a rover at constant speed together have the pull DP/W = tan(slope). The mobility
/// curve of each wheel, for the class of its ground and for undisturbed ground or a rut, gives the gradient P
/// at which the wheel drives at its slip. With the share f of the thrust at that slip of the thrust at the
/// reference slip, both load-weighted means over all wheels, the ground departs from its class at the
/// reference slip by (slope - P)/f (B4). Below f = 0.15 the slip tells nothing, and only the sinkage is an
/// estimate. Torque and sinkage distribute the departure over the wheels: a wheel that pulls less than the
/// other wheels, as on the edge of a soft patch, is on weaker ground. If the slip of any wheel is at least 0.9,
/// the rover may be stationary and pull less than the slope requires: the result is then an upper bound that
/// does not exceed the class, unless the drawbar pull was measured.
///
/// On ground with the gradients g along and c across the heading, a wheel at the slip angle beta has the pull
/// g cos(beta) - c sin(beta) in its plane and the side force |g sin(beta) + c cos(beta)|, both over load.
/// Pull and side force are compared with those of the class at that slip angle. If the side force over load
/// is at least 0.05 and is lower than that of the class by more than two standard deviations, the ground
/// counts as weaker in proportion (SlopeEquilibrium), unless the pull gives a lower value. If the slip angle or the
/// gradient across the heading is unknown, the slip angle is assumed to be 0, which underestimates the
/// ground.
///
/// Torque and sinkage, without a slope: the drawbar pull of a wheel is a function of torque and sinkage (thesis
/// Eq. 3.12). Both are extrapolated to the reference slip with the ratio of the class's values: the torque
/// grows as shear is mobilised, and the sinkage grows as the wheel digs (ours; from slip 0.3 on within 0.11 of
/// the forward model on dust, trap and drift classified as sand, whose pull is 0.2 to 0.36 lower). If little
/// torque is mobilised, the torque of the class is used with twice the standard deviation of the class; the
/// estimate then follows the sinkage, because a deeper wheel has a higher resistance. The result does not
/// exceed the class.
class WheelObserver {
 public:
  /// Keeps a reference to `model`, which must outlive this object.
  explicit WheelObserver(const GroundModel& model, const ReadingNoise& noise = {});

  /// Returns the observation from the reading of one wheel. Returns nullopt without slip or a positive load,
  /// or if slope, torque with sinkage, and drawbar pull are all missing.
  std::optional<WheelObservation> observe(int class_index, const TelemetryReading& reading) const;

  /// Returns the observations of the wheels of one rover at one moment, in the order of `together`.
  /// `departures` contains for each class the departure of DP/W from the class mean at the reference slip, as
  /// estimated from other data [-]; the readings determine the rest of the departure. Empty: all departures
  /// are 0.
  std::vector<std::optional<WheelObservation>> observe(const std::vector<ClassReading>& together,
                                                       std::span<const double> departures = {}) const;

 private:
  struct Wheel;
  double weakerAcross(const Wheel& wheel) const noexcept;
  // Load-weighted means over all wheels of one moment.
  struct Balance {
    double departure = 0.0;  // slope minus the expected gradient of the wheels [-]; NaN: no slope
    // Departure at the reference slip by the side forces, <= 0 [-]; infinite: not known.
    double across = std::numeric_limits<double>::infinity();
    // thrust of the classes at the slips of the wheels over the thrust at the reference slip [-]
    double share = 1.0;
    double wheels = 1.0;  // number of wheels
    bool standing = false;
  };

  Wheel expected(const ClassReading& read, std::span<const double> departures) const;
  Estimate bySlope(const Wheel& wheel, const Balance& all, double own) const;
  Estimate upperBound(const Wheel& wheel, const Balance& all) const;
  std::optional<WheelObservation> observed(const Wheel& wheel, const Balance& balance, double own) const;

  const GroundModel& model_;
  ReadingNoise noise_;
};

/// Returns the drawbar pull over load DP/W of a wheel from torque T/(W r) and sinkage z/r (kang_2003 Eq.
/// 3.12, corrected): DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(W r),
/// theta_1 = arccos(1 - z/r).
double pullFromTorque(double torque_over_load_radius, double sinkage_over_radius) noexcept;

/// Wheel of the rover from which a telemetry row originates. NaN: unknown.
struct RowWheel {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  double width_m = std::numeric_limits<double>::quiet_NaN();
  /// Weight of the rover per wheel on level ground.
  double weight_N = std::numeric_limits<double>::quiet_NaN();
};

/// One telemetry row as the journal stores it.
struct JournalRow {
  std::string source;     ///< file or vehicle from which the row originates
  std::int64_t line = 0;  ///< line number in the file
  bool accepted = false;  ///< true if the map used the row
  /// Reason of a rejection; for an accepted estimate, what the sensors of the drive were found to be.
  std::string reason;
  TelemetryReading reading;      ///< measurements of the row
  WheelObservation observation;  ///< observation from the row; undefined if rejected
  RowWheel wheel{};              ///< wheel to which the row refers
};

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
  double time_s = 0.0;  ///< telemetry time of the newest reading
  double shared = 0.0;  ///< standard deviation of the error common to all readings of the source [-]

  /// Returns the variance of `pull` without the shared error: 1/weight, and the model error 0.02 squared,
  /// which is common to all readings of a block.
  double variance() const noexcept;
};

/// Readings of one source in one block: sums, and the strictest bounds. The sums are in fixed point, so that they do
/// not depend on the order of the readings, and readings can be removed exactly.
struct SourceReadings {
  static constexpr double kUnit = 1048576.0;  ///< of the sums, per 1
  std::int64_t weight = 0;                    ///< sum of the inverse variances w of the pulls
  std::int64_t pull = 0;                      ///< sum of w DP/W
  std::int64_t shared = 0;      ///< sum of w times the error common to all readings of the source
  std::int64_t sinkages = 0;    ///< number of sinkages
  std::int64_t sinkage = 0;     ///< sum of the sinkages over radius z/r
  std::uint32_t updated_s = 0;  ///< telemetry time of the newest reading, rounded down [s]
  GroundBound bound{};

  /// Adds a pull whose standard deviation counts as at least 0.025, and whose shared error is `shared_std` [-].
  void addPull(const Estimate& pull, double shared_std) noexcept;
  void addSinkage(double sinkage_over_radius) noexcept;
  /// Adds (sign 1) or removes (-1) readings; if bounds are among the removed ones, all bounds.
  void add(const SourceReadings& other, int sign) noexcept;
  bool empty() const noexcept { return weight == 0 && sinkages == 0 && !bound.any(); }
};

/// Evidence of one terrain class in a block. A block is a square of cells whose evidence is stored together.
struct BlockEvidence {
  std::uint8_t reach = 0;  ///< position uncertainty of the readings, in steps of 0.1 m
  std::map<Source, SourceReadings> sources{};

  /// Returns the position uncertainty of the readings [m].
  double reach_m() const noexcept { return 0.1 * reach; }
  /// Returns the telemetry time of the newest reading, rounded down [s].
  std::uint32_t updated_s() const noexcept;
  /// Returns the pulls by source, in ascending order.
  std::vector<SourcePull> pulls() const;
  /// Returns the mean DP/W of all sources [-]; NaN without a reading.
  double pull() const;
  /// Returns the number of pull readings, each weighted by (0.05/std)^2 [-].
  double samples() const noexcept;
  /// Returns the mean z/r of verified sensors or, without any, of the others [-]; NaN if not measured.
  double sinkage() const noexcept;
  bool sinkageVerified() const noexcept;
  /// Returns the strictest bounds of all sources.
  GroundBound bound() const noexcept;
};

/// Key of evidence: one terrain class of one block. Columns and rows of blocks count from the map's south-west corner.
struct BlockOfClass {
  int column = 0, row = 0;
  std::uint8_t terrain_class = 0;  ///< number of the terrain class

  friend auto operator<=>(const BlockOfClass& a, const BlockOfClass& b) noexcept {
    return std::tie(a.row, a.column, a.terrain_class) <=> std::tie(b.row, b.column, b.terrain_class);
  }
};

/// Evidence of one terrain class in one block, with its key.
struct SavedBlock {
  BlockOfClass block;
  BlockEvidence evidence;
};

struct ClassState;
struct EvidenceStore;

/// Evidence of a map: wheel observations by place. Evidence is stored by block and terrain class. A block is
/// a square of cells (BlockGrid). A Gaussian process over the class mean extends the evidence to nearby
/// ground of the same class, and each class has a posterior.
///
/// Blocks have a side of a quarter of the correlation length, so that the work for an observation does not
/// depend on the map's resolution. The same evidence in any order gives bit-identical results. Not
/// thread-safe while changed.
class EvidenceField {
 public:
  /// Makes a field without evidence.
  explicit EvidenceField(std::shared_ptr<const GroundSite> site);
  ~EvidenceField();
  EvidenceField(EvidenceField&&) noexcept;
  EvidenceField& operator=(EvidenceField&&) noexcept;

  /// Adds an observation. Returns the box of cells whose estimate may change while the class states are
  /// constant: all cells of the patches of blocks that the observation can affect. Returns nullopt if the
  /// observation lies outside the map or on ground without a class, or if it contains neither an estimate nor
  /// a bound.
  std::optional<maps::CellBox> add(const WheelObservation& observation);
  /// Returns the block and the readings that add() would store for an observation; nullopt if add() would return
  /// nullopt.
  std::optional<SavedBlock> readingsOf(const WheelObservation& observation) const;
  /// Removes stored readings. Returns the box of cells whose estimate may change; nullopt if the block has no
  /// evidence.
  std::optional<maps::CellBox> forget(const SavedBlock& readings);

  /// Returns the evidence of the block that contains a cell, for the cell's class; null without evidence.
  const BlockEvidence* evidence(maps::Cell cell) const noexcept;

  /// Returns the telemetry time of the newest reading of the classes whose soil changes with time; 0 without one [s].
  double newest_s() const noexcept;
  /// Returns the estimate for ground of a class without nearby evidence.
  GroundBelief classBelief(int class_index) const;
  /// Returns the states of all classes, in the order of GroundModel::Parts::classes.
  std::vector<ClassState> states() const;
  /// Returns disjoint boxes of cells that evidence can affect; ground outside these boxes has the estimate of
  /// its class.
  std::vector<maps::CellBox> reached() const;

  /// Radius within which a bound applies, in standard deviations of the position [-].
  static constexpr double kPoseReach = 2.0;

  /// Returns the side length of a block [cells].
  int blockCells() const noexcept;

  /// visit() calls `visit` with all evidence in a fixed order. restore() adds such evidence to a field of the
  /// same site, and returns the box of cells whose estimate may change; nullopt if the site has no such block
  /// or class.
  void visit(const std::function<void(const SavedBlock&)>& visit) const;
  std::optional<maps::CellBox> restore(const SavedBlock& saved);

  /// Returns the data of the field, for EvidenceBeliefs.
  const EvidenceStore& store() const noexcept { return *store_; }

 private:
  bool standsOnOneClass(const WheelObservation& observation, int class_index) const;
  maps::CellBox count(const SavedBlock& readings, int sign);
  ClassState stateOf(int class_index) const;

  std::shared_ptr<const GroundSite> site_;
  std::unique_ptr<EvidenceStore> store_;
};

}  // namespace talus::costmap
