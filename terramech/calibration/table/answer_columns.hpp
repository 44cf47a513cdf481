#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Telemetry columns of the quantities that a wheel model predicts (answers), in the order of Channel.
inline constexpr std::array<const char*, kChannels> kAnswers{"drawbar_pull_N", "sinkage_m", "torque_Nm",
                                                             "side_force_N"};

/// Returns true if a column is one of kAnswers.
inline bool isAnswer(std::string_view column) {
  return std::find(kAnswers.begin(), kAnswers.end(), column) != kAnswers.end();
}

}  // namespace talus::terramech
