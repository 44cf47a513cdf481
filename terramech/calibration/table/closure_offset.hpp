#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// A group of rows whose force readings differ from the value implied by torque and sinkage.
struct ClosureOffset {
  std::string column, value;  ///< the text column and the group in it
  double offset = 0.0;        ///< of DP/W [-]
  double std = 0.0;           ///< of the offset: scatter of its rows, and what the relation itself may be off
  double p_value = 1.0;       ///< over all groups and columns, by shuffling rows among groups
};

/// Measured DP/W minus the value from torque and sinkage by the relation below, a row; NaN where one is
/// missing.
std::vector<double> closureErrors(const Trial& trial);

/// Checks DP against measured T and z by the relation that needs no soil (kang_2003, Eq. 3.12),
///   DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW)
///   theta_1 = acos(1 - z/r)
/// good to 0.03 for soils of 0 to 3 kPa and 20 to 37 deg: finds the group of a text column that differs from
/// the others by more than 0.06, twice that, which a freely fitted soil would hide. The group that is further
/// from the relation is the one that is off. Empty where no row has all three, or nothing stands out at p
/// <= 0.01.
std::optional<ClosureOffset> findClosureOffset(const Trial& trial, std::uint64_t seed);

}  // namespace talus::terramech
