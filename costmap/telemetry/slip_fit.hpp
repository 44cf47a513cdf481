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

/// What the slips of one drive say of their sensor and of the ground of each class, together.
struct SlipPosterior {
  double slip_bias = 0.0;   ///< b: what the sensor reads of a wheel that does not slip [-]
  double slip_scale = 1.0;  ///< s: by which it multiplies slip, 0.2 to 1 [-]
  /// By class: departure of drawbar pull over load at the reference slip from the class, on average of the drive, and what is
  /// left open of it by the sensor; an infinite deviation where the drive tells nothing [-].
  std::vector<Estimate> departure;
  /// By class: the same departure with its deviation after the prior, and that of a sound sensor: b normal, 0.03, -ln s half normal,
  /// 0.05 [-].
  std::vector<Estimate> learned, if_sound;
  /// By class: how much less than the departure a decision counts on, >= 0: of ground that is stronger than its class, one standard
  /// deviation of the posterior, down to the class [-].
  std::vector<double> caution;
};

/// Bayes estimate of the slip sensor of a drive and of the strength of its ground from slip over slope. Of a class whose wheels
/// pull P(i) at slip i, with the thrust H(i), ground that departs by d at the reference slip pulls
///   P(i) + d H(i)/H(0.5) = g                                                            (1)
/// on a slope of gradient g, which gives i(g, d). The sensor reads
///   b + s i(g, d) + e,  e normal with variance (t^2 p^2 + m^2) (H/(H0.5 P'))^2 + n^2 + (o/P')^2       (2)
/// p the class's deviation from place to place and t the share of it that this ground has, m the error of the model, n that of
/// the slip, o that of the slope. Strength, bias and scale change slip over slope in different ways: b everywhere alike, s in
/// proportion, d most where the slope takes most of the thrust. Priors: d normal with the class's mean_std; b normal, 0.1; -ln s half
/// normal, 0.45; t of five values, equal. The scale is 1 at most: soil with a greater shear modulus makes more slip, as a sensor of a scale
/// above 1 would, and is weaker; of such a drive the ground counts as weak. The departure is its posterior mean, bias and scale are
/// the means where the departures are these, so that slips corrected by them are those of that ground; the deviation is that of the
/// likelihood alone, 1/c^2 = 1/v - 1/mean_std^2 with v the posterior variance, since the class has its prior already.
/// A square of two thirds of the correlation length counts as one reading, however often it is driven (all numbers ours).
class SlipFit {
 public:
  explicit SlipFit(const GroundModel& model) : model_(model) {}

  /// All wheels of a rover at one moment, on ground of one class.
  struct Moment {
    std::string run;
    int class_index = 0;
    int rutted = 0, wheels = 0;  ///< of which so many are in ruts
    maps::Point place;
    double gradient = 0.0;  ///< along the heading, rise over run
    double slip = 0.0;      ///< mean of the wheels
  };
  /// What is not finite is left out.
  void take(const Moment& moment);

  /// The estimate by all moments so far. `excess`: by how much the slopes of a run are measured too steep.
  std::shared_ptr<const SlipPosterior> fitted(
      const std::function<double(const std::string& run)>& excess) const;

  std::size_t moments() const noexcept { return moments_; }

 private:
  // Class, rutted, wheels, run, square and gradient of moments that are taken together.
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
