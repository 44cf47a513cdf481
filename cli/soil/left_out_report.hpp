#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/trace/left_out.hpp>

namespace talus::cli {

/// Errors on rows that tracing did not see, a table of base, refined model, sensors alone and plain regression.
std::string leftOutText(const std::vector<terramech::LeftOutErrors>& all);
nlohmann::ordered_json leftOutJson(const std::vector<terramech::LeftOutErrors>& all);

}  // namespace talus::cli
