#pragma once

#include <talus/costmap/cost/travel_policy.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

using terramech::Estimate;

/// Estimated strength of ground: quantities of a wheel at the reference slip 0.5, each with standard
/// deviation.
struct GroundBelief {
  Estimate pull;     ///< drawbar pull over load, DP/W [-]
  Estimate sinkage;  ///< sinkage over wheel radius, z/r [-]
};

/// A category and its probability.
struct RankedCategory {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;
};

/// Category of ground by its pull against the slope and by its sinkage (thesis 3.5).
class GroundCategory {
 public:
  GroundCategory(const TravelPolicy& policy, const terramech::Rover& rover);

  /// Returns the category of ground of a known pull over load and sinkage over radius at a gradient.
  terramech::Category at(double pull, double sinkage, double gradient) const;
  /// Returns the category of ground with the mean strength of `belief` at a gradient, and the probability of
  /// that category under the uncertainty of `belief`.
  RankedCategory ranked(const GroundBelief& belief, double gradient) const;

 private:
  // `low` is the DP/W below which a slope is dangerous, and `high` is the DP/W above which it is safe.
  struct Edges {
    double low, high;
  };
  Edges edges(double gradient) const noexcept;

  double tan_margin_, threshold_, critical_;
};

}  // namespace talus::costmap
