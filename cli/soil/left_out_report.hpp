#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/left_out.hpp>

namespace talus::cli {

/// Errors on held-out rows: a table of base, refined model, sensors alone and plain regression.
std::string leftOutText(const std::vector<terramech::LeftOutErrors>& all);
nlohmann::ordered_json leftOutJson(const std::vector<terramech::LeftOutErrors>& all);

/// The errors as a page, with measured and predicted values over the held-out column (`request`:
/// COLUMN[=VALUES]). `source` is the path of the table.
std::string leftOutPage(const std::vector<terramech::LeftOutErrors>& all, const std::string& request,
                        const std::string& source);

}  // namespace talus::cli
