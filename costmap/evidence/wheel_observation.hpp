#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Measurements of one wheel at one moment, without corrections. NaN: not measured.
struct TelemetryReading {
  double time_s = 0.0;
  maps::Point place;                                      ///< position of the wheel on the map [m]
  double z_m = std::numeric_limits<double>::quiet_NaN();  ///< elevation of the wheel: selects the floor
  double load_N = 0.0;                                    ///< on the wheel, > 0
  double slip = 0.0;                                      ///< slip, [-1, 1]
  double torque_Nm = 0.0;                                 ///< torque of the wheel
  double sinkage_m = 0.0;
  double gradient = 0.0;  ///< slope of the ground along the heading, rise over run [-]
  /// Slope to the left of the heading, rise over run [-], and angle from the wheel's plane to its direction
  /// of travel, left positive.
  double across = std::numeric_limits<double>::quiet_NaN();
  double slip_angle_rad = std::numeric_limits<double>::quiet_NaN();
  double drawbar_pull_N = 0.0;  ///< drawbar pull, measured on a test stand
  double pose_std_m = 0.0;      ///< position uncertainty, one standard deviation
  int pass = 1;                 ///< pass number at this place: 1 on undisturbed ground, >= 2 in a rut
  double speed_slip = std::numeric_limits<double>::quiet_NaN();  ///< slip from rim and rover speed [-]
};

/// Bounds of the ground under a measured wheel, independent of all other evidence. NaN: no bound.
struct GroundBound {
  double most_pull = std::numeric_limits<double>::quiet_NaN();      ///< upper bound of drawbar pull over
                                                                    ///< load [-]
  double least_sinkage = std::numeric_limits<double>::quiet_NaN();  ///< lower bound of sinkage over radius
                                                                    ///< [-]

  /// True if the pull or the sinkage has a bound.
  bool any() const noexcept { return !std::isnan(most_pull) || !std::isnan(least_sinkage); }
  /// Limits the bound of the pull to at most `pull` [-].
  void lower(double pull) noexcept { most_pull = std::fmin(most_pull, pull); }
};

/// A reading and the class of the ground under the wheel, as an index into GroundModel::Parts::classes.
struct ClassReading {
  int class_index = 0;
  TelemetryReading reading;
};

/// Measurement errors, one standard deviation [-].
struct ReadingNoise {
  double slip = 0.03;           ///< of the slip
  double gradient = 0.01;       ///< of the slope, rise over run
  double torque_share = 0.05;   ///< of T/(rW), relative
  double sinkage_share = 0.05;  ///< of z/r, relative, and its effect on DP/W
  double mobilised = 0.15;      ///< of T/(rW) at the reference slip, per unit of growth factor - 1
  /// Of the drawbar pull over load DP/W by thesis Eq. 3.12 and by the assumed shares of the wheels.
  double model_pull = 0.02;
};

/// Result of one reading: an estimate of the ground under the wheel at the reference slip 0.5, a bound of the
/// place itself, or both.
struct WheelObservation {
  double time_s = 0.0;
  maps::Point place;
  double z_m = std::numeric_limits<double>::quiet_NaN();  ///< elevation [m]; NaN: on the top surface
  Estimate pull;                                          ///< drawbar pull over load [-]
  Estimate sinkage;          ///< sinkage over radius [-]; infinite standard deviation: not measured
  double demand = 0.0;       ///< drawbar pull over load that the slope requires [-]
  double from_torque = 0.0;  ///< drawbar pull over load from torque and sinkage [-]; NaN: not measured
  /// Standard deviation of `pull` by errors common to all readings, such as the error of the slip, which more
  /// readings do not reduce; >= 0 [-]. NaN: unknown, `pull` may then only lower an estimate.
  double shared_std = 0.0;
  double share = 1.0;  ///< thrust of the class at the measured slip over that at the reference slip [-]
  Estimate by_slope{std::numeric_limits<double>::quiet_NaN(),
                    0.0};   ///< pull from slip and slope alone [-]; NaN: no slope
  double pose_std_m = 0.0;  ///< position uncertainty, one standard deviation
  bool bound = false;       ///< true if the rover may have been stationary: `pull` is then an upper bound
  bool pull_may_raise =
      false;  ///< true if the sensors of `pull` are verified; otherwise `pull` may only lower an estimate
  bool sinkage_may_raise = false;  ///< true if the sensors of the sinkage are verified
  std::uint16_t drive = 0;  ///< number of the drive (driveTag()): the sensors of each drive have their own
                            ///< errors
  GroundBound here{};       ///< bounds of the place itself

  /// True if the observation contains an estimate of the pull.
  bool estimates() const noexcept { return std::isfinite(pull.value) && pull.std > 0.0; }
};

/// Converts readings to observations of undisturbed ground at the reference slip 0.5, by two methods that are
/// weighted by inverse variance:
///
/// Slope: the wheels of a steady rover together pull DP/N = tan(slope). The curve of each wheel, for its
/// class and for undisturbed ground or a rut, gives the gradient at which the wheel drives at its slip s. The
/// slope minus the load-weighted mean of these gradients is the departure d of the ground under all wheels at
/// slip s. Ground of the share f of its class's thrust H departs by (1 - f) H(s) (GroundModel), and therefore
/// at the reference slip by
///   k d,  k = H(0.5)/H(s) in [1, 3]
/// (ours; for soils drawn around mars_crusty and phi 37 deg the departure is within 0.02 of k d if strength
/// varies, and up to a third less than k d if the shear modulus varies). The share of d that errors of the
/// reading explain is not extrapolated: k multiplies only d - d e^2/(d^2 + e^2), where e is the standard
/// deviation of d. The standard deviation of the result is k e. Other differences between soils of a class
/// add 0.4 (k - 1) standard deviations of the class. If less than a third of the thrust is mobilised, k is 1,
/// the standard deviation of the class is added for the share of the thrust that is not mobilised, and the
/// reading raises no estimate unless the drive mobilised most of the thrust elsewhere (SensorProof). Beyond
/// the reference slip a negative d is not reduced; a positive d is. Torque and sinkage distribute d over the
/// wheels: a wheel that pulls less than the other wheels, as on the edge of a soft patch, stands on weaker
/// ground. If the slip of any wheel is at least 0.9, the rover may be stationary and pull less than the slope
/// requires: the result is then an upper bound that does not exceed the class.
///
/// A wheel at slip angle beta, on ground of slope g along and c across the heading, has the pull g cos(beta)
/// - c sin(beta) in its plane and the side force |g sin(beta) + c cos(beta)|, both over load. Pull and side
///   force are compared with those of the class at that slip angle. If the side force over load is at least
///   0.05 and
/// lies below that of the class by more than two standard deviations, the ground counts as weaker in
/// proportion (CrossSlope), unless the pull gives a lower value. Without the slip angle or the slope across,
/// the slip angle is assumed to be 0, which underestimates the ground.
///
/// Torque and sinkage: the drawbar pull of a wheel is a function of torque and sinkage (thesis Eq. 3.12).
/// Both are extrapolated to the reference slip with the ratio of the class's values: torque as shear is
/// mobilised, sinkage as the wheel digs (ours; from slip 0.3 on within 0.11 of the forward model on dust,
/// trap and drift classified as sand, whose pull is 0.2 to 0.36 lower). If little torque is mobilised, the
/// torque of the class is used, with twice the standard deviation of the class; the estimate then follows the
/// sinkage, because a deeper wheel has a higher resistance.
class WheelObserver {
 public:
  /// Keeps a reference to `model`.
  explicit WheelObserver(const GroundModel& model, const ReadingNoise& noise = {});

  /// Returns the observation of one wheel; nullopt without slip or a positive load, or without any of slope,
  /// torque with sinkage, and drawbar pull.
  std::optional<WheelObservation> observe(int class_index, const TelemetryReading& reading) const;

  /// Observations of the wheels of one rover at one moment, in the order of `together`. `departures`:
  /// for each class the departure of its pull from the class mean at the reference slip, as estimated from
  /// other data [-]; the readings determine the rest of the departure. Empty: all 0.
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
    double share = 1.0;  // thrust of the classes at the wheels' slips over that at the reference slip [-]
    bool standing = false;
  };

  Wheel expected(const ClassReading& read, std::span<const double> departures) const;
  double miss(const Wheel& wheel, const Balance& all, double carried) const;
  Estimate bySlope(const Wheel& wheel, const Balance& all, double own) const;
  Estimate upperBound(const Wheel& wheel, const Balance& all) const;
  std::optional<WheelObservation> observed(const Wheel& wheel, const Balance& balance, double own) const;

  const GroundModel& model_;
  ReadingNoise noise_;
};

/// Drawbar pull over load of a wheel by torque and sinkage: DP/W = -tan(theta_1/2) +
/// [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW), theta_1 = arccos(1 - z/r) (kang_2003 Eq. 3.12,
/// corrected).
double pullFromTorque(double torque_over_load_radius, double sinkage_over_radius) noexcept;

/// The wheel to which a row refers, from the file of its rover. NaN: unknown.
struct RowWheel {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  double width_m = std::numeric_limits<double>::quiet_NaN();
  double weight_N =
      std::numeric_limits<double>::quiet_NaN();  ///< weight of the rover per wheel on level ground
};

/// One telemetry row as the journal stores it.
struct JournalRow {
  std::string source;            ///< file or vehicle
  std::int64_t line = 0;         ///< line number in the file
  bool accepted = false;         ///< true if the map used the row
  std::string reason;            ///< reason of the rejection; empty if accepted
  TelemetryReading reading;      ///< measurements of the row
  WheelObservation observation;  ///< observation from the row; undefined if rejected
  RowWheel wheel{};              ///< wheel to which the row refers
};

}  // namespace talus::costmap
