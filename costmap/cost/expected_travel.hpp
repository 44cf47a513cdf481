#pragma once

#include <vector>

#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

using terramech::Estimate;

/// Expected energy and time per metre along the surface for an uncertain demand. The demand is the required
/// drawbar pull over load DP/W.
struct ExpectedCost {
  double energy_J_per_m = 0.0;
  double time_s_per_m = 0.0;
};

/// Mobility curve of a soil over the demand, and the expected cost per metre for an uncertain demand. The
/// demand is the required drawbar pull over load: the gradient plus the pull by which the ground is weaker
/// than the soil.
///
/// A demand beyond the drivable limit has the cost of an attempt at the limit and of the way back (ours, not
/// from the literature). TravelState::risk_per_m covers the risk of permanent immobilisation. The expected
/// cost never decreases with the standard deviation or the mean of the demand, by construction:
///   - The tabulated cost c is the running maximum over the demand.
///   - The quadrature is seven-point Gauss-Hermite: pairs of points mean -+ d of equal positive weight. The
///     value of a pair is the maximum of c(mean - d') + c(mean + d') over all d' <= d. For a convex cost, the
///     maximum is at d' = d; for other costs, the maximum prevents a lower cost for a greater uncertainty.
///     The maximum is exact, because between the demands at which the slope of the tabulated cost decreases,
///     the sum has no interior maximum.
/// Immutable and thread-safe.
class ExpectedTravel {
 public:
  explicit ExpectedTravel(const terramech::MobilityCurve& curve);

  /// Lower and upper end of the interval of drivable demands: from the steepest descent on which locked
  /// wheels stop the rover to the limit of slip, torque and soil. The interval is empty if first() > last().
  double first() const noexcept { return first_; }
  double last() const noexcept { return last_; }

  /// Returns the expected cost for a normally distributed demand with mean <= last(). Demands below `least`
  /// are raised to `least`, because ground that is stronger than the soil does not propel the rover.
  ExpectedCost at(const Estimate& demand, double least) const noexcept;

  /// Returns the greatest sinkage of a wheel [m] over the demands from 0 to `demand`. For a demand below 0,
  /// returns the sinkage at that demand.
  double sinkage_m(double demand) const noexcept;

 private:
  // A quantity tabulated at equal steps of the demand; linear between steps, and constant outside the table.
  struct Table {
    std::vector<double> values;
    std::vector<double> bends;  // demands at which the slope of the table decreases
  };
  double value(const Table& table, double demand) const noexcept;
  double expected(const Table& table, const Estimate& demand, double least) const noexcept;
  void findBends(Table& table) const;

  double first_ = 0.0, last_ = -1.0, step_ = 0.0;
  Table energy_, time_;
  std::vector<double> sinkage_m_;
};

}  // namespace talus::costmap
