#pragma once

#include <vector>

#include <talus/costmap/cost/slope_rows.hpp>

namespace talus::costmap {

/// Values at equal steps by linear interpolation, `at` counted in steps from the first; constant beyond the ends.
double interpolated(const std::vector<double>& values, double at);

/// Climbs straight up under even loads, and which of them cost as much as a slope in two dimensions.
class LevelClimbs {
 public:
  /// Of the row without a gradient across; climbs beyond `last` count as that.
  LevelClimbs(const SlopeRow& level, double last);

  /// By how much steeper the climb is that takes as much energy and time as each state that a row holds, >= 0, and by how
  /// much that state slips more than it.
  struct Surcharges {
    std::vector<double> climb, slip;
  };
  Surcharges surcharges(const SlopeRow& row) const;

 private:
  double reached(const std::vector<double>& values, double value) const;

  double last_, step_;
  int first_node_;
  std::vector<double> energies_, times_, slips_;
};

/// The steepest climb that holds, and the gross thrust over load there.
struct LevelStrength {
  double last, thrust;
};

/// The strength over load that ground may lose until nothing holds on a slope, <= 0 where nothing does: what is lost of the pull
/// adds to the climb, what is lost of the side force makes the slope across count for more. `losses` are what each row, 1/64 of gradient
/// across apart, takes of the steepest climb.
double strengthToLose(double along, double across, const LevelStrength& level,
                      const std::vector<double>& losses);

}  // namespace talus::costmap
