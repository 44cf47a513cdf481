#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// A group of rows whose force readings deviate from the value implied by torque and sinkage.
struct ClosureOffset {
  std::string column, value;  ///< the text column and the group in it
  double offset = 0.0;        ///< offset of drawbar pull over load, DP/W [-]
  double std = 0.0;           ///< from the scatter of the rows and the error of the relation
  double p_value = 1.0;       ///< permutation test over all groups and columns
};

/// Measured DP/W minus the value computed from torque and sinkage by the relation below, for each row; NaN if
/// a value is missing.
std::vector<double> closureErrors(const Trial& trial);

/// Compares measured DP with the value from measured T and z by a relation independent of the soil
/// (kang_2003, Eq. 3.12),
///   DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW)
///   theta_1 = acos(1 - z/r)
/// with an error of 0.03 for soils of 0 to 3 kPa and 20 to 37 deg. Returns the group of a text column that
/// deviates from the others by more than 0.06, twice this error (a freely fitted soil would hide the offset);
/// of several groups, the group with the largest deviation from the relation. Returns nullopt if no row has
/// all three quantities, or if no deviation has p <= 0.01.
std::optional<ClosureOffset> findClosureOffset(const Trial& trial, std::uint64_t seed);

}  // namespace talus::terramech
