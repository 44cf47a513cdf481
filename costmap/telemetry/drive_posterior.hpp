#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// Slip sensors, and the shear modulus of their ground: what the sensor reads, without its offset, where the curve of
/// the class has a slip. Wheels slip by `modulus`, the shear modulus over that of the class, times this slip.
struct SlipSensor {
  /// Linear: scale * slip of the wheels. Knee: the part of slips beyond `knee` times `scale`. Uphill: times `scale` on
  /// climbs. ByGradient: less `scale` times the gradient of a climb. OfClass: the slip of the class on the gradient.
  /// Unrelated: a constant, whatever the ground does.
  enum class Kind : std::uint8_t { Linear, Knee, Uphill, ByGradient, OfClass, Unrelated };
  Kind kind = Kind::Linear;
  double scale = 1.0, knee = 0.0, modulus = 1.0;
  double second = 1.0;  ///< second slip over that of the wheels; 0: constant, whatever the ground does
  double second_offset_std = 0.015;  ///< standard deviation of the offset of the second slip

  /// Returns the reading at a slip of the curve on a gradient; `of_class` is the slip of the class there.
  double read(double slip, double gradient, double of_class) const noexcept;
  /// Returns the slip at which a gradient gives a reading; meaningless for OfClass and Unrelated.
  double slipOf(double read, double gradient) const noexcept;
  /// Returns the change of the reading for a change of the slip.
  double gain(double slip, double gradient) const noexcept;
  /// Returns true if the reading depends on the ground.
  bool informs() const noexcept { return kind != Kind::OfClass && kind != Kind::Unrelated; }
};

/// Posterior of the sensors of one drive and of the ground of each terrain class.
struct DriveEstimate {
  static constexpr int kParts = 8;  ///< number of parts of equal length into which a drive is divided
  /// Probability of a slip that depends on the ground below which readings are not used (ours) [-].
  static constexpr double kLeastInforming = 0.02;
  static constexpr double kVerified = 0.9;  ///< the same probability, of a verified drive (ours) [-]

  /// Ground of one class. Departures of drawbar pull over load DP/W at the reference slip from the class [-].
  struct OfClass {
    Estimate departure;  ///< mean and standard deviation over all hypotheses
    Estimate if_sound;   ///< for a sound sensor
    /// Departure by the likelihood alone, for sensors whose slip depends on the ground, and its standard
    /// deviation; infinite: not driven.
    double read = 0.0, shared_std = 0.0;
    double at = 0.0;  ///< departure for the sensor `sensor`
  };
  std::vector<OfClass> classes;
  /// The classes with the resistances that were found for `sensor`; null without a moment.
  std::shared_ptr<const GroundModel> ground;
  SlipSensor sensor;            ///< most probable sensor whose slip depends on the ground
  double offset = 0.0;          ///< its reading at zero slip [-]
  int changed_from = kParts;    ///< part of the drive from which the sensor changed; kParts: none
  double changed_offset = 0.0;  ///< offset from there on [-]
  bool changed_informs = true;  ///< true if the slip depends on the ground from there on
  /// Most probable kind of sensor, and most probable kind whose slip does not depend on the ground, as text.
  std::string hypothesis, uninforming;
  double probability = 0.0;   ///< probability of this kind [-]
  double informing = 0.0;     ///< probability that a slip depends on the ground [-]
  bool twice = false;         ///< true if a second, independent slip was measured
  double slope_offset = 0.0;  ///< measured gradient = slope_offset + slope_scale * gradient of the map
  double slope_scale = 1.0;
  int displaced_from = kParts;  ///< part of the drive from which the pose is displaced; kParts: none
  std::size_t moments = 0;      ///< number of moments of the drive

  /// Returns the part, 0 to kParts - 1, of the moment with a number.
  int partOf(std::size_t moment) const noexcept;
  bool displaced(std::size_t moment) const noexcept { return partOf(moment) >= displaced_from; }
  /// Returns the slip of the curve by the readings of both slips (NaN: none) of the moment with a number, and the change
  /// of the reading that was used for a change of this slip; NaN if they tell nothing about the ground at its pose.
  std::pair<double, double> slip(std::size_t moment, std::pair<double, double> read,
                                 double gradient) const noexcept;
  /// Returns the gradient of the ground for a measured gradient.
  double gradient(double measured) const noexcept { return (measured - slope_offset) / slope_scale; }
};

/// Bayes estimate of the sensors of a drive and of the strength of its ground. Soils of a class differ in
/// strength, in resistance and in shear modulus. Let wheels on the soil of a class with the resistance R (in
/// standard deviations, by its sinkage exponent) have the pull P_R(i) at slip i and the thrust H_R(i), both over
/// load, and h_R = H_R(i)/H_R(0.5) on fresh ground. Ground that departs from the class by D at the reference slip
/// 0.5 has, on a slope of gradient g, the slip m i, m the shear modulus over that of the class, with
///   P_R(i) + (D - P_R(0.5) + P_0(0.5)) h_R(i) = g                                                       (B2)
/// P and H are means over the wheels of the rover, of which some run in ruts. A sensor (SlipSensor) with offset b
/// reads b + read(m i) + a u + e1, a second slip b2 + m i + u + e2 unless it is false (SlipSensor::second), where
/// a is the change of the reading for a change of the slip, and
///   var u = ((t^2 p^2 + e^2) h^2 + e^2) (di/dg)^2, var e1 = 0.015^2, var e2 = 0.03^2 + scatter^2          (B3)
/// p is the standard deviation of the class between places, t its share in this drive, e the error of curve and
/// gradient (0.01, or 0.003 where t is 0), u the departure of a place, which both slips have. Each kind of sensor
/// is one hypothesis with a prior probability; for each, D (normal, mean_std), m (log-normal, mean 1, modulus_std),
/// five values of R, t, e and the sensor's parameters are summed over a grid; b and R about these values (normal,
/// linear in the slip) are integrated. Classes share the sensor and m. A square with sides of 2/3 of the
/// correlation length counts as one reading. The pull that soils of a class have in ruts in addition (rut_std) is
/// not seen in the slip; it adds to the standard deviation.
///
/// Measured gradients are compared with those of the map, which gives the offset and scale of the slope sensor,
/// and the part of the drive from which they are unrelated: there the pose is displaced. All numbers ours.
class DrivePosterior {
 public:
  explicit DrivePosterior(const GroundModel& model) : model_(model) {}

  /// Wheels of a rover at one time, on ground of one class. NaN: unknown.
  struct Moment {
    int class_index = 0;
    int rutted = 0, wheels = 0;  ///< number of wheels in a rut, and number of all wheels
    maps::Point place;
    double gradient = 0.0;      ///< gradient along the heading, measured [-]
    double map_gradient = 0.0;  ///< gradient along the heading by the map [-]
    double slip = 0.0;          ///< median slip of the wheels [-]
    double second_slip = 0.0;   ///< median second slip, independent of `slip` [-]
    double second_std = 0.0;    ///< standard deviation of `second_slip` by the scatter of positions [-]
  };
  /// Adds a moment; a moment without a gradient or a slip is ignored.
  void take(const Moment& moment);

  /// Returns the estimate from all moments so far.
  DriveEstimate fitted() const;

  std::size_t moments() const noexcept { return moments_; }

 private:
  // Key of moments that are summed: class, wheels in a rut, wheels, chunk of moments, column and row of the
  // square, step of the gradient.
  using Key = std::tuple<int, int, int, std::size_t, int, int, int>;
  struct Sum {
    double count = 0.0, gradient = 0.0, slip = 0.0, second = 0.0;
    double seconds = 0.0;  // number of moments with a second slip
  };
  // Sums over pairs of gradients of the map and measured, in one square.
  struct Slope {
    double count = 0.0, map = 0.0, measured = 0.0;
  };
  using Place = std::tuple<std::size_t, int, int, int>;

  void fitSlopes(DriveEstimate& out) const;

  const GroundModel& model_;
  std::size_t moments_ = 0;
  std::map<Key, Sum> sums_;
  std::map<Place, Slope> slopes_;
  double seconds_ = 0.0, second_std_ = 0.0;  // number of moments with a second slip, and its greatest error
};

}  // namespace talus::costmap
