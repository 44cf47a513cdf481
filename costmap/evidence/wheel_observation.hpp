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

/// What one wheel read at one moment, corrected for nothing. NaN = not measured.
struct TelemetryReading {
  double time_s = 0.0;
  maps::Point place;                                      ///< of the wheel on the map
  double z_m = std::numeric_limits<double>::quiet_NaN();  ///< its height, which tells floors apart
  double load_N = 0.0;                                    ///< on the wheel, > 0
  double slip = 0.0;                                      ///< [-1, 1]
  double torque_Nm = 0.0;                                 ///< on the wheel
  double sinkage_m = 0.0;
  double gradient = 0.0;  ///< of the ground along the heading, rise over run
  /// The same to the left of it, and the angle from the wheel's plane to its way, left positive.
  double across = std::numeric_limits<double>::quiet_NaN();
  double slip_angle_rad = std::numeric_limits<double>::quiet_NaN();
  double drawbar_pull_N = 0.0;  ///< where a test stand measures it
  double pose_std_m = 0.0;      ///< how well the place is known
  int pass = 1;  ///< how many wheels rolled here, this one included: from the second on it is in a rut
  double speed_slip = std::numeric_limits<double>::quiet_NaN();  ///< by the speeds of rim and rover
};

/// What the ground where a wheel was read is bound by, whatever else is said of it. NaN: not bound.
struct GroundBound {
  double most_pull = std::numeric_limits<double>::quiet_NaN();      ///< drawbar pull over load [-]
  double least_sinkage = std::numeric_limits<double>::quiet_NaN();  ///< sinkage over radius [-]

  bool any() const noexcept { return !std::isnan(most_pull) || !std::isnan(least_sinkage); }
  void lower(double pull) noexcept { most_pull = std::fmin(most_pull, pull); }
};

/// A reading and the class of the ground under the wheel, as its position in GroundModel::Parts::classes.
struct ClassReading {
  int class_index = 0;
  TelemetryReading reading;
};

/// How well the readings are known, one standard deviation.
struct ReadingNoise {
  double slip = 0.03;
  double gradient = 0.01;
  double torque_share = 0.05;   ///< of T/(rW)
  double sinkage_share = 0.05;  ///< of the wheel radius, times z/r's slope
  double mobilised = 0.15;      ///< of torque taken to the reference slip, per share by which it grows [-]
  /// Of thesis Eq. 3.12 as a model of DP/W, and of a wheel pulling its own share [-].
  double model_pull = 0.02;
};

/// What a reading says about the ground under the wheel, at the reference slip: an estimate, a bound of the place
/// itself, or both.
struct WheelObservation {
  double time_s = 0.0;
  maps::Point place;
  double z_m = std::numeric_limits<double>::quiet_NaN();  ///< height; NaN: on the top surface
  Estimate pull;                                          ///< drawbar pull over load [-]
  Estimate sinkage;          ///< sinkage over radius [-]; std is infinite where nothing was measured
  double demand = 0.0;       ///< drawbar pull over load that the slope asked for [-]
  double from_torque = 0.0;  ///< drawbar pull over load by torque and sinkage [-]; NaN without them
  /// Of the pull: standard deviation by the error that readings share, however many there are, as of the slip by which
  /// all of them are read; >= 0 [-]. NaN: not known, so that the pull may only lower.
  double shared_std = 0.0;
  double share = 1.0;  ///< of its class's thrust at the reference slip, at the slip that was read [-]
  Estimate by_slope{std::numeric_limits<double>::quiet_NaN(),
                    0.0};   ///< pull by slip and slope alone; NaN without
  double pose_std_m = 0.0;  ///< how well the place is known, one standard deviation
  bool bound = false;  ///< the rover all but stood: the ground pulls no more than this, and may pull less
  bool pull_may_raise =
      false;  ///< whether the sensors behind the pull are known to be sound; else it can only lower the belief
  bool sinkage_may_raise = false;  ///< the same of the sinkage
  std::uint16_t drive = 0;  ///< tells drives apart, whose sensors may be off in different ways (driveTag())
  GroundBound here{};

  /// Whether it estimates the pull.
  bool estimates() const noexcept { return std::isfinite(pull.value) && pull.std > 0.0; }
};

/// Turns readings into observations of fresh ground at the reference slip, by two ways that are weighed by
/// their doubt:
///
/// Slope: a steady rover's wheels together pull what the slope asks, DP/N = tan(slope). Each wheel's own
/// curve, of its class and of fresh ground or a rut, says at which gradient it would drive at its slip; by
/// how much the slope departs from what the wheels should pull together is the departure d of the ground under
/// all of them at their slip s. Ground of the share f of its class's thrust H departs by (1 - f) H(s) (GroundModel), so
/// that at the reference slip it departs by
///   k d,  k = H(0.5)/H(s) in [1, 3]
/// (ours; of soils drawn about mars_crusty and phi 37 deg by their strength within 0.02 of d k, by their shear modulus up
/// to a third less). As much of d as an error of the reading explains is not grown: of d, k applies to
/// d - d e^2/(d^2 + e^2), e its standard deviation, which itself grows by k. What soils of a class differ in otherwise adds
/// 0.4 of its standard deviation times k - 1. At less than a third of the thrust k is 1, the class's deviation counts for
/// the part of the thrust that is not felt, and nothing is raised unless the drive felt most of the thrust elsewhere
/// (SensorProof). From the reference slip on what is weaker is not taken back to
/// it, what is stronger is. How the wheels share the departure, torque and sinkage say: a wheel that pulls less than its
/// fellows, as on the edge of a soft patch, stands on weaker ground. From slip 0.9 of any wheel on the rover
/// may as well have stood, and pulled less than the slope asks: the balance is then only an upper bound, and
/// says nothing better than the class.
///
/// A wheel that travels at a slip angle on a slope whose gradient across is known pulls in its own plane what the slope
/// asks there, and holds what it asks across: g cos(beta) - c sin(beta) and |g sin(beta) + c cos(beta)|, which the
/// class's wheel at that angle is held against. From a demand of 0.05 across on, ground that holds less than its class
/// beyond two standard deviations counts as weaker by as much as CrossSlope has side force go with pull, if that is more
/// than by the pull. Without either number the wheel counts as straight, which errs towards weaker ground.
///
/// Torque and sinkage: what a wheel pulls is a function of both (thesis Eq. 3.12). On the way to the
/// reference slip both grow as they do on ground of the class: torque as shear is mobilised, sinkage as the
/// wheel digs (ours; from slip 0.3 on within 0.11 of the forward model on dust, trap and drift taken for
/// sand, whose pull is 0.2 to 0.36 less). Where little is mobilised yet, the class's own torque stands in,
/// with twice the class's deviation, and the sinkage alone speaks: who sinks deeper has more to climb out of.
class WheelObserver {
 public:
  explicit WheelObserver(const GroundModel& model, const ReadingNoise& noise = {});

  /// What the reading of one wheel says; nothing where it cannot be used (no slip, no load, or neither slope,
  /// torque nor drawbar pull).
  std::optional<WheelObservation> observe(int class_index, const TelemetryReading& reading) const;

  /// The same for wheels of one rover read at one moment, in their order. `departures`: by which ground of each class is known to
  /// depart from its class at the reference slip, by other means; what the readings say is then the rest. Empty: none is.
  std::vector<std::optional<WheelObservation>> observe(const std::vector<ClassReading>& together,
                                                       std::span<const double> departures = {}) const;

 private:
  struct Wheel;
  double weakerAcross(const Wheel& wheel) const noexcept;
  // Of all wheels of a moment.
  struct Balance {
    double departure = 0.0;  // of the slope from what they should pull together; NaN without a slope
    // By how much less than the class they pull at the reference slip by what they hold across; infinite: not known.
    double across = std::numeric_limits<double>::infinity();
    double share = 1.0;  // of the classes' thrust at the reference slip that they have at the wheels' slips
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

/// The wheel that a row was read by, as its rover's file has it. NaN: not known.
struct RowWheel {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  double width_m = std::numeric_limits<double>::quiet_NaN();
  double weight_N =
      std::numeric_limits<double>::quiet_NaN();  ///< of the rover on each of its wheels, on the level
};

/// One telemetry row as the journal keeps it.
struct JournalRow {
  std::string source;            ///< file or vehicle it came from
  std::int64_t line = 0;         ///< in the file
  bool accepted = false;         ///< whether the map learned from it
  std::string reason;            ///< why not; empty when accepted
  TelemetryReading reading;      ///< as read
  WheelObservation observation;  ///< what it said; of no meaning when refused
  RowWheel wheel{};              ///< by which it was read
};

}  // namespace talus::costmap
