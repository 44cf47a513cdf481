#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Joint posterior of the slip sensor and of the ground of each terrain class, from the slips of one drive.
struct SlipPosterior {
  double slip_bias = 0.0;   ///< b: offset of the sensor, i.e. its reading at zero slip [-]
  double slip_scale = 1.0;  ///< s: scale of the sensor, 0.1 to 1 [-]
  /// Posterior probability of a sensor that compresses large slips (Eq. 3) [-].
  double compressing = 0.0;
  /// By class index: mean departure d of drawbar pull over load DP/W at the reference slip from the class,
  /// with its standard deviation by the likelihood alone; infinite if the drive gives no information [-].
  std::vector<Estimate> departure;
  /// By class index: `learned` has the mean of `departure` and the posterior standard deviation. `if_sound`
  /// is the departure for a sound sensor, i.e. with the priors b normal, 0.03, and -ln s half normal, 0.05
  /// [-].
  std::vector<Estimate> learned, if_sound;
  /// By class index: amount >= 0 that is subtracted from the departure for decisions. For ground stronger
  /// than its class, it is one posterior standard deviation, at most the departure [-]. If `compressing` is
  /// above 0.05, a decision uses at most the departure for compressing sensors less its standard deviation.
  std::vector<double> caution;
};

/// Bayes estimate of the slip sensor of a drive and of the strength of its ground, from slip over slope. Let
/// wheels on ground of a class have the pull P(i) at slip i, with the thrust H(i), both over load. Ground
/// that departs from the class by d at the reference slip 0.5 has the pull
///   P(i) + d H(i)/H(0.5) = g                                                            (1)
/// on a slope of gradient g, which gives i(g, d). The sensor reads
///   b + s i(g, d) + e,  e normal with variance (t^2 p^2 + m^2) (H/(H0.5 P'))^2 + n^2 + (o/P')^2       (2)
/// with p the standard deviation of the class between places, t the share of p in this ground, and m, n and o
/// the errors of model, slip and slope. Offset b, scale s and departure d have different effects on slip over
/// slope: b adds a constant, s is proportional to slip, and d has the greatest effect where the slope
/// requires most of the thrust. Priors: d normal with the class's mean_std; b normal, 0.1; -ln s half normal,
/// 0.45, or with probability 0.1 uniform up to 2.3; t uniform over five values. The scale is limited to 1, because a scale above 1 and weaker soil with
/// a greater shear modulus have the same effect on slip; the ground of such a drive counts as weak. The
/// estimate of d is its posterior mean. The estimates of b and s are the means at these departures, so that
/// slips corrected by both are consistent with the ground. The standard deviation c of d is computed from the
/// likelihood alone, 1/c^2 = 1/v - 1/mean_std^2 with v the posterior variance, because the class already
/// contains the prior. A square with sides of 2/3 of the correlation length counts as one reading,
/// independent of the number of passes (all numbers ours).
///
/// A sensor that compresses large slips makes the ground of steep slopes appear strong. It reads
///   b + min(i, k) + s max(i - k, 0) + e                                                 (3)
/// with a knee k of 0.1, 0.2 or 0.3 and s of 0.25 or 0.5, each with the same prior probability, together 0.1.
/// The posterior probability of these sensors (B16) compares the mean of the likelihood over their prior with
/// the mean over the prior of Eq. 2.
class SlipFit {
 public:
  explicit SlipFit(const GroundModel& model) : model_(model) {}

  /// Mean slip of all wheels of a rover at one time, on ground of one class.
  struct Moment {
    std::string run;
    int class_index = 0;
    int rutted = 0, wheels = 0;  ///< number of wheels in a rut, and number of all wheels
    maps::Point place;
    double gradient = 0.0;  ///< gradient along the heading, rise over run [-]
    double slip = 0.0;      ///< mean slip of the wheels [-]
  };
  /// Adds a moment; a moment with a number that is not finite is ignored.
  void take(const Moment& moment);

  /// Returns the estimate from all moments so far. The function `excess` returns the mean excess of the
  /// measured gradients of a run over the map's [-].
  std::shared_ptr<const SlipPosterior> fitted(
      const std::function<double(const std::string& run)>& excess) const;

  std::size_t moments() const noexcept { return moments_; }

 private:
  // Key of moments that are summed: class, wheels in a rut, wheels, run, column and row of the square, step
  // of the gradient.
  using Key = std::tuple<int, int, int, std::string, int, int, int>;
  struct Sum {
    double count = 0.0, gradient = 0.0, slip = 0.0;
  };
  struct Curve;
  struct OfClass;
  OfClass ofClass(int class_index, const std::function<double(const std::string&)>& excess) const;

  const GroundModel& model_;
  std::size_t moments_ = 0;
  std::map<Key, Sum> sums_;
};

}  // namespace talus::costmap
