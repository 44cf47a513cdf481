#pragma once

#include <vector>

#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

using terramech::Estimate;

/// What a metre along the surface costs, expected over a doubtful demand.
struct ExpectedCost {
  double energy_J_per_m = 0.0;
  double time_s_per_m = 0.0;
};

/// The mobility curve of a soil over the pull that is demanded of it (rise over run, plus what the ground
/// gives less than the soil does), and what a metre costs when that demand is doubtful.
///
/// A demand beyond the limit is charged, not left out: the attempt at the limit, and the same again for the
/// way back (ours, not from the literature); what it is worth to be held there for good is DriveState's risk.
/// The expected cost never falls as the standard deviation or the mean grows, by construction:
/// - the tabulated cost is the greatest up to each demand, so that it never falls with it;
/// - the quadrature (seven-point Gauss-Hermite) has pairs of points mean -+ d of equal, positive weight, and
///   each pair counts with the greatest sum c(mean - d') + c(mean + d') of all d' <= d: where the cost is
///   convex that is the pair itself, elsewhere doubt must not make it cheaper. The greatest is exact: between
///   the points at which the tabulated cost bends downwards the sum of a pair cannot turn.
/// Immutable; safe to share between threads.
class ExpectedDrive {
 public:
  explicit ExpectedDrive(const terramech::MobilityCurve& curve);

  /// Demands that can be driven: from the steepest that locked wheels hold to the limit of slip, torque and
  /// soil. first > last where there are none.
  double first() const noexcept { return first_; }
  double last() const noexcept { return last_; }

  /// Expected cost where the demand is normal about a mean <= last(); demands below `least` count as `least`:
  /// ground that is stronger than its soil does not push the rover.
  ExpectedCost at(const Estimate& demand, double least) const noexcept;

  /// Greatest sinkage of a wheel [m] from level ground up to a demand; at a demand below 0, that there.
  double sinkage_m(double demand) const noexcept;

 private:
  // Values at equal steps of the demand, linear between them, constant outside.
  struct Table {
    std::vector<double> values;
    std::vector<double> bends;  // demands at which the slope falls
  };
  double value(const Table& table, double demand) const noexcept;
  double expected(const Table& table, const Estimate& demand, double least) const noexcept;
  void findBends(Table& table) const;

  double first_ = 0.0, last_ = -1.0, step_ = 0.0;
  Table energy_, time_;
  std::vector<double> sinkage_m_;
};

}  // namespace talus::costmap
