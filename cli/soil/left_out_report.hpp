#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/left_out.hpp>

namespace talus::cli {

/// Returns the prediction errors on held-out rows as a table: base model, refined model, sensors alone and
/// plain regression.
std::string leftOutText(const std::vector<terramech::LeftOutErrors>& all);
nlohmann::ordered_json leftOutJson(const std::vector<terramech::LeftOutErrors>& all);

}  // namespace talus::cli
