#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Group of rows in which the measured drawbar pull deviates from the value that torque and sinkage imply.
struct ClosureOffset {
  std::string column, value;  ///< text column, and text of the group in this column
  double offset = 0.0;        ///< mean deviation of drawbar pull over load, DP/W [-]
  /// Standard deviation of `offset`, from the scatter of the rows and the error of the relation [-].
  double std = 0.0;
  double p_value = 1.0;  ///< from a permutation test of this group
};

/// Returns for each row the measured DP/W minus the value from torque and sinkage by the relation below; NaN
/// if a value is missing.
std::vector<double> closureErrors(const Trial& trial);

/// Finds a group of a text column in which the measured drawbar pull DP is offset. The measured DP/W is
/// compared with the value from measured torque T and sinkage z by a relation that is independent of the soil
/// (kang_2003, Eq. 3.12),
///   DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW)
///   theta_1 = acos(1 - z/r)
/// with an error of 0.03 for soils of 0 to 3 kPa and 20 to 37 deg. Returns a group with a larger mean
/// deviation than the other rows; the two mean deviations must differ by more than 0.06, twice the error of
/// the relation. Of several groups, returns the one with the largest difference. (A freely fitted soil would
/// hide the offset.) Returns nullopt if no row has all three quantities, or if the permutation test of the
/// group gives p > 0.01.
std::optional<ClosureOffset> findClosureOffset(const Trial& trial, std::uint64_t seed);

}  // namespace talus::terramech
